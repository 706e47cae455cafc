// lightband.Mesh and lightband.Scene: what is looked at, and from where.
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
    return call_python(py::module_::import("lightband._records").attr("MeshStats"),
                       py::make_tuple(stats.vertices, stats.triangles, stats.dropped_triangles, corner(stats.bounds_min), corner(stats.bounds_max)));
}

lightband::Vector to_up(const Given& up) {
    if (up.value.is_none()) {
        return {0, 0, 0};
    }
    const lightband::Vector vector = to_vector(up);
    if (vector == lightband::Vector{0, 0, 0}) {
        up.refuse_value("is (0, 0, 0), which has no direction");
    }
    return vector;
}

void set_camera(Scene& self, const Given& eye, const Given& target, const Given& up, const Given& fov_y,
                const Given& near_plane, const Given& far_plane) {
    const lightband::Camera camera{to_vector(eye),    to_vector(target),      to_up(up),
                                   to_setting(fov_y), to_setting(near_plane), to_setting(far_plane)};
    in_library([&] { self.handle.set_camera(camera); });
    self.has_camera = true;
}

void set_environment(Scene& self, const Given& given) {
    const Environment& environment = From<const Environment&>::take(given);
    in_library([&] { self.handle.set_environment(environment.handle); });
    self.environment = given.value;
}

void add_light(Scene& self, const Sun& light) {
    in_library([&] { self.handle.add_light(light.handle); });
}

void remove_light(Scene& self, const Sun& light) {
    in_library([&] { self.handle.remove_light(light.handle); });
}

uint32_t add(Scene& self, const Mesh& mesh, const Brdf& brdf, const Given& transform, bool double_sided) {
    std::optional<lightband::Transform> matrix;
    if (!transform.value.is_none()) {
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

void set_transform(Scene& self, uint32_t index, const Given& transform) {
    const lightband::Transform matrix = to_transform(transform);
    in_library([&] { self.handle.set_transform(index, matrix); });
}

void set_double_sided(Scene& self, uint32_t index, bool double_sided) {
    in_library([&] { self.handle.set_double_sided(index, double_sided); });
}

py::str describe_scene(const Scene* self) {
    const std::string instances = std::to_string(self->instances) + (self->instances == 1 ? " instance" : " instances");
    return describe("Scene", *self,
                    "of " + instances + (self->environment.is_none() ? ", no" : ", with") + " environment" +
                        (self->has_camera ? ", with" : ", no") + " camera");
}

}  // namespace

void bind_scene(py::module_& module) {
    MeshClass mesh(module, "Mesh", "Triangles. Made by Context.mesh and Context.builtin_mesh.", collectable<Mesh>());
    refuse_construction(mesh, "Context.mesh and Context.builtin_mesh make one");
    bind_closing(mesh);
    define_property(mesh, "stats", &mesh_stats, "Counts and bounds, a MeshStats.");
    define(
        mesh, "__repr__(self)", +[](const Mesh* self) { return describe("Mesh", *self, self->description); },
        "Where the triangles come from.");

    SceneClass scene(module, "Scene", R"(Meshes with their materials, one environment, other lights, one camera.

Made by Context.scene. It needs a camera before it can be rendered; it may have no mesh and no light, where it is black.)",
                     collectable<Scene>());
    refuse_construction(scene, "Context.scene makes one");
    bind_closing(scene);
    define(scene, "add(self, mesh, brdf, transform=None, double_sided=True)", &add,
           R"(Adds a mesh with its material; returns the instance's number, counted from 0.

transform: object to world, a 3x4 or 4x4 affine matrix; None: identity.
double_sided: False: only the front of its triangles is drawn, from which their vertices run counter-clockwise
    in the mesh's own space; a mirroring transform does not change which side that is. Of a closed surface that is
    wound outwards, seen from outside and not cut by the near plane nobody sees the back; about half of its
    triangles are then not drawn.
The array frame.material holds the number plus one. At most 254 instances.)");
    define(scene, "add_light(self, light)", &add_light,
           "Adds a light, a Sun, to those of the scene: at most 1024, each once. The light from all of them and from the environment adds up.");
    define(scene, "remove_light(self, light)", &remove_light, "Takes a light out of the scene again.");
    define(scene, "set_transform(self, index, transform)", &set_transform,
           "Replaces the transform of an instance.");
    define(scene, "set_double_sided(self, index, double_sided)", &set_double_sided,
           "Whether both sides of an instance's triangles are drawn, or only the front: see add.");
    define(scene, "camera(self, eye, target, up=None, fov_y=None, near_plane=None, far_plane=None)", &set_camera,
           R"(Sets the camera.

eye, target: points in metres; the target is in the middle of the picture.
up: a direction, not along the view; None: +Y.
fov_y: vertical field of view, radians, above 0 and below pi - 0.001; None: 0.7.
near_plane, far_plane: metres, 1e-30 to 1e30; None: 1e-3 and 1e3 times the distance from eye to target.)");
    define_property(
        scene, "environment", +[](const Scene* self) { return self->environment; },
        "The distant light; None before it was set.", &set_environment);
    define(
        scene, "__len__(self)", +[](const Scene* self) { return self->instances; }, "The number of instances.");
    define(
        scene, "__bool__(self)", +[](const Scene*) { return true; }, "True, also of a scene without instances.");
    define(scene, "__repr__(self)", &describe_scene, "What the scene has.");
}

}  // namespace lightband_python
