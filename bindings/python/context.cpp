// lightband.Context: the device, and the maker of everything else.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>

#include "arrays.h"
#include "objects.h"

namespace lightband_python {

namespace {

using Path = std::filesystem::path;
using ContextClass = py::class_<Context, std::shared_ptr<Context>>;

uint32_t device_number(const std::string& name) {
    if (name == "hardware") {
        return LB_DEVICE_HARDWARE;
    }
    if (name == "software") {
        return LB_DEVICE_SOFTWARE;
    }
    if (name == "any") {
        return LB_DEVICE_ANY;
    }
    throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT,
                               "device: \"" + name + "\" is not one of \"hardware\", \"software\", \"any\"");
}

// The Python callable as the library's log. What it raises goes to sys.unraisablehook: there is no caller to hear it.
lightband::Log to_log(const py::object& callable) {
    if (callable.is_none()) {
        return nullptr;
    }
    if (PyCallable_Check(callable.ptr()) == 0) {
        throw py::type_error("log: a callable or None is expected");
    }
    return [function = unlocked_reference(callable)](const char* message) {
        CallbackScope callback;
        try {
            (*function)(to_str(message));
        } catch (py::error_already_set& error) {
            error.discard_as_unraisable("the log callback of a lightband.Context");
        }
    };
}

std::shared_ptr<Context> create_context(const std::string& device, const std::optional<Path>& cache_path,
                                        const py::object& log) {
    lightband::ContextOptions options;
    options.device = device_number(device);
    options.log = to_log(log);
    if (cache_path) {
        options.cache_path = cache_path->string();
    }
    return held(in_library([&] {
        lightband::Context handle(options);
        const std::string device_name = handle.device_name();
        const bool is_software = handle.is_software();
        return Context{std::move(handle), device_name, is_software};
    }));
}

std::string file_name(const Path& path) {
    return "'" + path.filename().string() + "'";
}

std::shared_ptr<Brdf> load_brdf(const Context& self, const Path& path) {
    return held(Brdf{in_library([&] { return self.handle.load_brdf(path.string()); }), file_name(path)});
}

std::shared_ptr<Brdf> builtin_brdf(const Context& self, const std::string& name) {
    return held(Brdf{in_library([&] { return self.handle.builtin_brdf(name); }), "built-in '" + name + "'"});
}

std::shared_ptr<Brdf> table_brdf(const Context& self, const py::object& values) {
    const FloatArray table = to_floats(values, "table", {90, 90, 180, 3});  // the MERL layout
    const auto count = static_cast<size_t>(table.size());
    return held(Brdf{in_library([&] { return self.handle.table_brdf(table.data(), count); }), "table"});
}

std::shared_ptr<Brdf> lambert(const Context& self, const py::object& albedo) {
    const lightband::Vector colour = to_colour(albedo, "albedo");
    return held(Brdf{in_library([&] { return self.handle.lambert(colour); }), "Lambert"});
}

std::shared_ptr<Brdf> ggx(const Context& self, float alpha, const py::object& f0) {
    const lightband::Vector colour = to_colour(f0, "f0");
    const std::string description = "GGX, alpha " + py::cast<std::string>(py::str(py::float_(alpha)));
    return held(Brdf{in_library([&] { return self.handle.ggx(alpha, colour); }), description});
}

std::shared_ptr<Environment> load_environment(const Context& self, const Path& path) {
    return held(Environment{in_library([&] { return self.handle.load_environment(path.string()); }), file_name(path)});
}

std::shared_ptr<Environment> environment(const Context& self, const py::object& radiance) {
    const FloatArray map = to_floats(radiance, "radiance", {any_length, any_length, 3});
    const uint32_t height = to_uint32(map.shape(0), "radiance: height");
    const uint32_t width = to_uint32(map.shape(1), "radiance: width");
    const std::string description = std::to_string(width) + " x " + std::to_string(height);
    return held(
        Environment{in_library([&] { return self.handle.environment(width, height, map.data()); }), description});
}

std::shared_ptr<Mesh> mesh(const Context& self, const py::object& positions, const py::object& indices,
                           const py::object& normals, const py::object& texcoords) {
    const FloatArray vertices = to_floats(positions, "positions", {any_length, 3});
    const IndexArray triangles = to_indices(indices, "indices", {any_length, 3});
    const py::ssize_t vertex_count = vertices.shape(0);
    FloatArray vertex_normals;
    FloatArray vertex_texcoords;
    lb_mesh_desc desc = LB_MESH_DESC_INIT;
    desc.vertex_count = to_uint32(vertex_count, "positions: number of vertices");
    desc.triangle_count = to_uint32(triangles.shape(0), "indices: number of triangles");
    desc.positions = vertices.data();
    desc.indices = triangles.data();
    if (!normals.is_none()) {
        vertex_normals = to_floats(normals, "normals", {vertex_count, 3});
        desc.normals = vertex_normals.data();
    }
    if (!texcoords.is_none()) {
        vertex_texcoords = to_floats(texcoords, "texcoords", {vertex_count, 2});
        desc.texcoords = vertex_texcoords.data();
    }
    return held(Mesh{in_library([&] { return self.handle.mesh(desc); }), "of arrays"});
}

std::shared_ptr<Mesh> builtin_mesh(const Context& self, const std::string& name, py::ssize_t resolution) {
    const uint32_t segments = to_uint32(resolution, "resolution");
    return held(Mesh{in_library([&] { return self.handle.builtin_mesh(name, segments); }), "built-in '" + name + "'"});
}

std::shared_ptr<Scene> scene(const Context& self) {
    return held(Scene{in_library([&] { return self.handle.scene(); })});
}

py::object frame(const Context& self, py::ssize_t width, py::ssize_t height, const py::kwargs& settings) {
    const uint32_t columns = to_uint32(width, "width");
    const uint32_t rows = to_uint32(height, "height");
    const py::object frame =
        py::cast(held(Frame{in_library([&] { return self.handle.frame(columns, rows); }), columns, rows}));
    for (const auto& setting : settings) {
        frame[setting.first] = setting.second;
    }
    return frame;
}

void bind_material_makers(ContextClass& type) {
    type.def("load_brdf", &load_brdf, py::arg("path"), R"(A measured reflectance from a MERL .binary file.

Raises FileError when the file cannot be read, FormatError when it is no MERL file.)");
    type.def("builtin_brdf", &builtin_brdf, py::arg("name"), R"(A material that the library computes itself.

lightband.builtin_materials() lists the names. Computed at first use (about a second), then kept in the cache folder.)");
    type.def("table_brdf", &table_brdf, py::arg("table"), R"(A measured reflectance from an array.

table: 90 x 90 x 180 x 3 values in 1/steradian, cells (theta_half [quadratic], theta_diff, phi_diff) as in a MERL file,
RGB last. A negative value means "not measured". Copied.)");
    type.def("lambert", &lambert, py::arg("albedo"), R"(A diffuse reflectance, albedo / pi.

albedo: RGB or one number for all three, each in [0, 1].)");
    type.def("ggx", &ggx, py::arg("alpha"), py::arg("f0"), R"(A reflectance of GGX microfacets (Walter et al. 2007).

alpha: roughness squared, in [1e-4, 1].
f0: reflectance at normal incidence, RGB or one number for all three, each in [0, 1].)");
}

void bind_scene_makers(ContextClass& type) {
    type.def("load_environment", &load_environment, py::arg("path"), R"(Distant light from an OpenEXR or Radiance file.

A latitude-longitude map: +Y is up, the centre looks along +Z, the left edge along -Z.)");
    type.def("environment", &environment, py::arg("radiance"), R"(Distant light from an array.

radiance: height x width x 3, linear RGB, rows top-down; laid out as in load_environment. Copied.)");
    type.def("mesh", &mesh, py::arg("positions"), py::arg("indices"), py::arg("normals") = py::none(),
             py::arg("texcoords") = py::none(), R"(Triangles from arrays, copied.

positions: vertices x 3, metres.
indices: triangles x 3, whole numbers below the number of vertices.
normals: vertices x 3; None: computed, area-weighted.
texcoords: vertices x 2; None: none.)");
    type.def("builtin_mesh", &builtin_mesh, py::arg("name"), py::arg("resolution") = 0,
             R"(A computed shape about one metre across: "sphere", "plane", "torus", "knot" or "blob".

resolution: segments around, 8 to 2048; 0: 256.)");
    type.def("scene", &scene, "An empty scene.");
    type.def("frame", &frame, py::arg("width"), py::arg("height"),
             R"(A picture of width x height pixels, each 1 to 8192.

Keywords are settings: context.frame(512, 512, samples=64). lightband.settings() lists them.)");
}

}  // namespace

void bind_context(py::module_& module) {
    ContextClass type(module, "Context", R"(One OpenGL device, without a window; everything else is made by it.

device: "hardware" (a GPU; DeviceError where there is none), "software" (the CPU) or "any" (a GPU, else the CPU;
    is_software tells which it became). Software rendering is never a silent fallback.
cache_path: folder for the tables of built-in materials (35 MB each). None: the user's cache folder. "": no cache.
log: called with each message of driver and library. It must not call the library; what it raises is reported to
    sys.unraisablehook. None: silence.

Calls on objects of one context wait for each other; objects of different contexts are independent.)");
    type.def(py::init(&create_context), py::arg("device") = "hardware", py::arg("cache_path") = py::none(),
             py::arg("log") = py::none());
    bind_closing(type);
    type.def_property_readonly(
        "device_name", [](const Context& self) { return to_str(self.device_name.c_str()); },
        "Renderer and version, as the driver names them.");
    type.def_property_readonly(
        "is_software", [](const Context& self) { return self.is_software; },
        "Whether the device is a software renderer.");
    type.def("__repr__",
             [](const Context& self) { return describe("Context", self, "on '" + self.device_name + "'"); });
    bind_material_makers(type);
    bind_scene_makers(type);
}

}  // namespace lightband_python
