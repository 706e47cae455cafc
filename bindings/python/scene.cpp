// lightband.Mesh and lightband.Scene: what is looked at, and from where.
#include <pybind11/stl.h>

#include <optional>

#include "arrays.h"
#include "objects.h"

namespace lightband_python {

namespace {

using MeshClass = py::class_<Mesh, std::shared_ptr<Mesh>>;
using SceneClass = py::class_<Scene, std::shared_ptr<Scene>>;

py::object mesh_stats(const Mesh& self) {
    const lb_mesh_stats stats = in_library([&] { return self.handle.stats(); });
    const auto corner = [](const float* bound) { return py::make_tuple(bound[0], bound[1], bound[2]); };
    return py::module_::import("lightband._records")
        .attr("MeshStats")(stats.vertices, stats.triangles, stats.dropped_triangles, corner(stats.bounds_min),
                           corner(stats.bounds_max));
}

// The C interface reads zero as the default; in Python that is None, so a zero is a mistake.
float to_setting(const std::optional<float>& value, const char* argument) {
    if (value && *value == 0) {
        throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT, std::string(argument) + ": 0 is not above 0");
    }
    return value.value_or(0.0f);
}

lightband::Vector to_up(const py::object& up) {
    if (up.is_none()) {
        return {0, 0, 0};
    }
    const lightband::Vector vector = to_vector(up, "up");
    if (vector == lightband::Vector{0, 0, 0}) {
        throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT, "up: (0, 0, 0) has no direction");
    }
    return vector;
}

void set_camera(Scene& self, const py::object& eye, const py::object& target, const py::object& up,
                const std::optional<float>& fov_y, const std::optional<float>& near_plane,
                const std::optional<float>& far_plane) {
    const lightband::Camera camera{
        to_vector(eye, "eye"),      to_vector(target, "target"),          to_up(up),
        to_setting(fov_y, "fov_y"), to_setting(near_plane, "near_plane"), to_setting(far_plane, "far_plane")};
    in_library([&] { self.handle.set_camera(camera); });
    self.has_camera = true;
}

void set_environment(Scene& self, const std::shared_ptr<Environment>& environment) {
    if (!environment) {
        throw py::type_error("environment: a lightband.Environment is expected, not None");
    }
    in_library([&] { self.handle.set_environment(environment->handle); });
    self.environment = environment;
}

uint32_t add(Scene& self, const Mesh& mesh, const Brdf& brdf, const py::object& transform, bool double_sided) {
    std::optional<lightband::Transform> matrix;
    if (!transform.is_none()) {
        matrix = to_transform(transform);
    }
    const uint32_t index = in_library([&] {
        const uint32_t added = self.handle.add(mesh.handle, brdf.handle, matrix);
        self.handle.set_double_sided(added, double_sided);
        return added;
    });
    self.instances = index + 1;
    return index;
}

void set_transform(Scene& self, py::ssize_t index, const py::object& transform) {
    const uint32_t instance = to_uint32(index, "index");
    const lightband::Transform matrix = to_transform(transform);
    in_library([&] { self.handle.set_transform(instance, matrix); });
}

void set_double_sided(Scene& self, py::ssize_t index, bool double_sided) {
    const uint32_t instance = to_uint32(index, "index");
    in_library([&] { self.handle.set_double_sided(instance, double_sided); });
}

py::str describe_scene(const Scene& self) {
    const std::string instances = std::to_string(self.instances) + (self.instances == 1 ? " instance" : " instances");
    return describe("Scene", self,
                    "of " + instances + (self.environment ? ", with" : ", no") + " environment" +
                        (self.has_camera ? ", with" : ", no") + " camera");
}

}  // namespace

void bind_scene(py::module_& module) {
    MeshClass mesh(module, "Mesh", "Triangles. Made by Context.mesh and Context.builtin_mesh.");
    bind_closing(mesh);
    mesh.def_property_readonly("stats", &mesh_stats, "Counts and bounds, a MeshStats.");
    mesh.def("__repr__", [](const Mesh& self) { return describe("Mesh", self, self.description); });

    SceneClass scene(module, "Scene", R"(Meshes with their materials, one environment, one camera.

Made by Context.scene. It needs an environment and a camera before it can be rendered; it may have no mesh.)");
    bind_closing(scene);
    scene.def("add", &add, py::arg("mesh"), py::arg("brdf"), py::arg("transform") = py::none(),
              py::arg("double_sided") = true,
              R"(Adds a mesh with its material; returns the instance's number, counted from 0.

transform: object to world, a 3x4 or 4x4 affine matrix; None: identity.
double_sided: False: only the front of its triangles is drawn, from which their vertices run counter-clockwise in the mesh's own
space; a mirroring transform does not change which side that is. Of a closed surface that is wound outwards, seen from outside
and not cut by the near plane nobody sees the back; about half of its triangles are then not drawn.
The array frame.material holds the number plus one. At most 254 instances.)");
    scene.def("set_transform", &set_transform, py::arg("index"), py::arg("transform"),
              "Replaces the transform of an instance.");
    scene.def("set_double_sided", &set_double_sided, py::arg("index"), py::arg("double_sided"),
              "Whether both sides of an instance's triangles are drawn, or only the front: see add.");
    scene.def("camera", &set_camera, py::arg("eye"), py::arg("target"), py::arg("up") = py::none(),
              py::arg("fov_y") = py::none(), py::arg("near_plane") = py::none(), py::arg("far_plane") = py::none(),
              R"(Sets the camera.

eye, target: points in metres; the target is in the middle of the picture.
up: a direction, not along the view; None: +Y.
fov_y: vertical field of view, radians, above 0 and below pi - 0.001; None: 0.7.
near_plane, far_plane: metres, 1e-30 to 1e30; None: 1e-3 and 1e3 times the distance from eye to target.)");
    scene.def_property(
        "environment", [](const Scene& self) { return self.environment; }, &set_environment,
        "The distant light; None before it was set.");
    scene.def("__len__", [](const Scene& self) { return self.instances; });
    scene.def("__bool__", [](const Scene&) { return true; });
    scene.def("__repr__", &describe_scene);
}

}  // namespace lightband_python
