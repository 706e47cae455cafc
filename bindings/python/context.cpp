// lightband.Context: the device, and the maker of everything else.
#include <filesystem>
#include <string>

#include "arrays.h"
#include "objects.h"

namespace lightband_python {

namespace {

using Path = std::filesystem::path;
using ContextClass = py::class_<Context, std::shared_ptr<Context>>;

uint32_t device_number(const Given& given) {
    const std::string name = to_text(given);
    if (name == "hardware") {
        return LB_DEVICE_HARDWARE;
    }
    if (name == "software") {
        return LB_DEVICE_SOFTWARE;
    }
    if (name == "any") {
        return LB_DEVICE_ANY;
    }
    given.refuse_value("is \"" + name + "\"; it must be \"hardware\", \"software\" or \"any\"");
}

// Hands a message to the callable that the weak reference leads to, if there still is one. What it raises goes to
// sys.unraisablehook: there is no caller to hear it.
void hand_over(const py::object& weak, const char* message) {
    try {
        const py::object callable = call_python(weak, py::make_tuple());
        if (!callable.is_none()) {
            call_python(callable, py::make_tuple(to_str(message)));
        }
    } catch (py::error_already_set& error) {
        surviving_finalization([&] { error.discard_as_unraisable("the log callback of a lightband.Context"); });
    }
}

// What the objects of a context hold of its log callback: a functools.partial of it, since that can be weakly
// referenced whatever the callable is. None without a callback.
py::object to_keeper(const Given& log) {
    const py::object callable = to_callable(log);
    return callable.is_none() ? callable : py::module_::import("functools").attr("partial")(callable);
}

lightband::Log to_log(const py::object& keeper) {
    if (keeper.is_none()) {
        return nullptr;
    }
    return [weak = unlocked_reference(py::weakref(keeper))](const char* message) {
        CallbackScope callback;
        hand_over(*weak, message);
    };
}

std::shared_ptr<Context> create_context(const Given& device, const Given& cache_path, const Given& log) {
    lightband::ContextOptions options;
    options.device = device_number(device);
    if (!cache_path.value.is_none()) {
        options.cache_path = to_path(cache_path).string();
    }
    const py::object keeper = to_keeper(log);
    options.log = to_log(keeper);
    lightband::Context handle = in_library([&] { return lightband::Context(options); });
    const std::string device_name = in_library([&] { return handle.device_name(); });
    const bool is_software = in_library([&] { return handle.is_software(); });
    return held(Context{{keeper}, std::move(handle), device_name, is_software});
}

std::string file_name(const Path& path) {
    return "'" + path.filename().string() + "'";
}

std::shared_ptr<Brdf> make_brdf(const Context& self, lightband::Brdf handle, const std::string& description) {
    return held(Brdf{{self.log}, std::move(handle), description});
}

std::shared_ptr<Brdf> load_brdf(const Context& self, const Path& path, bool fill_unmeasured) {
    const auto load = [&] { return self.handle.load_brdf(path.string(), fill_unmeasured); };
    return make_brdf(self, in_library(load), file_name(path));
}

std::shared_ptr<Brdf> builtin_brdf(const Context& self, const std::string& name) {
    return make_brdf(self, in_library([&] { return self.handle.builtin_brdf(name); }), "built-in '" + name + "'");
}

std::shared_ptr<Brdf> table_brdf(const Context& self, const Given& values) {
    const FloatArray table = to_floats(values, {90, 90, 180, 3});  // the MERL layout
    const auto count = static_cast<size_t>(table.size());
    return make_brdf(self, in_library([&] { return self.handle.table_brdf(table.data(), count); }), "table");
}

std::shared_ptr<Brdf> lambert(const Context& self, const Given& albedo) {
    const lightband::Vector colour = to_colour(albedo);
    return make_brdf(self, in_library([&] { return self.handle.lambert(colour); }), "Lambert");
}

std::shared_ptr<Brdf> ggx(const Context& self, float alpha, const Given& f0) {
    const lightband::Vector colour = to_colour(f0);
    const std::string description = "GGX, alpha " + py::cast<std::string>(py::str("{:.6g}").format(alpha));
    return make_brdf(self, in_library([&] { return self.handle.ggx(alpha, colour); }), description);
}

std::shared_ptr<Environment> load_environment(const Context& self, const Path& path) {
    lightband::Environment handle = in_library([&] { return self.handle.load_environment(path.string()); });
    return held(Environment{{self.log}, std::move(handle), file_name(path)});
}

std::shared_ptr<Environment> environment(const Context& self, const Given& radiance) {
    const FloatArray map = to_floats(radiance, {any_length, any_length, 3});
    const uint32_t height = to_length(radiance, map.shape(0), "rows");
    const uint32_t width = to_length(radiance, map.shape(1), "columns");
    lightband::Environment handle = in_library([&] { return self.handle.environment(width, height, map.data()); });
    return held(Environment{{self.log}, std::move(handle), std::to_string(width) + " x " + std::to_string(height)});
}

std::shared_ptr<Sun> sun(const Context& self, const Given& direction, const Given& irradiance, const Given& angular_radius) {
    const lightband::Sun described = to_sun(direction, irradiance, angular_radius);
    return held(Sun{{self.log}, in_library([&] { return self.handle.sun(described); })});
}

std::shared_ptr<Mesh> mesh(const Context& self, const Given& positions, const Given& indices, const Given& normals,
                           const Given& texcoords) {
    const FloatArray vertices = to_floats(positions, {any_length, 3});
    const IndexArray triangles = to_indices(indices, {any_length, 3});
    const py::ssize_t vertex_count = vertices.shape(0);
    FloatArray vertex_normals;
    FloatArray vertex_texcoords;
    lb_mesh_desc desc = LB_MESH_DESC_INIT;
    desc.vertex_count = to_length(positions, vertex_count, "vertices");
    desc.triangle_count = to_length(indices, triangles.shape(0), "triangles");
    desc.positions = vertices.data();
    desc.indices = triangles.data();
    if (!normals.value.is_none()) {
        vertex_normals = to_floats(normals, {vertex_count, 3});
        desc.normals = vertex_normals.data();
    }
    if (!texcoords.value.is_none()) {
        vertex_texcoords = to_floats(texcoords, {vertex_count, 2});
        desc.texcoords = vertex_texcoords.data();
    }
    return held(Mesh{{self.log}, in_library([&] { return self.handle.mesh(desc); }), "of arrays"});
}

std::shared_ptr<Mesh> builtin_mesh(const Context& self, const std::string& name, uint32_t resolution) {
    return held(Mesh{{self.log},
                     in_library([&] { return self.handle.builtin_mesh(name, resolution); }),
                     "built-in '" + name + "'"});
}

std::shared_ptr<Scene> scene(const Context& self) {
    return held(Scene{{self.log}, in_library([&] { return self.handle.scene(); })});
}

std::shared_ptr<Frame> frame(const Context& self, uint32_t width, uint32_t height, const Given& settings) {
    std::shared_ptr<Frame> frame =
        held(Frame{{self.log}, in_library([&] { return self.handle.frame(width, height); }), width, height});
    for (const auto& [name, value] : py::dict(settings.value)) {
        set_setting(*frame, to_text({settings.function, "a setting's name", py::reinterpret_borrow<py::object>(name)}),
                    {settings.function, "", py::reinterpret_borrow<py::object>(value)});
    }
    return frame;
}

void bind_material_makers(ContextClass& type) {
    define(type, "load_brdf(self, path, fill_unmeasured=True)", &load_brdf,
           R"(A measured reflectance from a MERL .binary file.

fill_unmeasured: cells that were not measured are filled from the measured cells of the same theta_half and
phi_diff, towards grazing with the last of them; the log callback hears how many. False: they reflect nothing.
Raises FileError when the file cannot be read, FormatError when it is no MERL file.)");
    define(type, "builtin_brdf(self, name)", &builtin_brdf, R"(A material that the library computes itself.

lightband.builtin_materials() lists the names. Computed at first use (about a second), then kept in the cache
folder.)");
    define(type, "table_brdf(self, table)", &table_brdf, R"(A measured reflectance from an array.

table: 90 x 90 x 180 x 3 values in 1/steradian, cells (theta_half [quadratic], theta_diff, phi_diff) as in a
MERL file, RGB last. A cell with a negative value was not measured and reflects nothing. Copied.)");
    define(type, "lambert(self, albedo)", &lambert, R"(A diffuse reflectance, albedo / pi.

albedo: RGB or one number for all three, each in [0, 1].)");
    define(type, "ggx(self, alpha, f0)", &ggx, R"(A reflectance of GGX microfacets (Walter et al. 2007).

alpha: roughness squared, in [1e-4, 1].
f0: reflectance at normal incidence, RGB or one number for all three, each in [0, 1].)");
}

void bind_scene_makers(ContextClass& type) {
    define(type, "load_environment(self, path)", &load_environment, R"(Distant light from an OpenEXR or Radiance file.

A latitude-longitude map: +Y is up, the centre looks along +Z, the left edge along -Z.)");
    define(type, "environment(self, radiance)", &environment, R"(Distant light from an array.

radiance: height x width x 3, linear RGB, rows top-down; laid out as in load_environment. Copied.)");
    define(type, "sun(self, direction, irradiance, angular_radius=None)", &sun, R"(A disc of uniform radiance, infinitely far away.

direction: towards the sun, in world space, of any length but zero.
irradiance: RGB, or one number for all three: of a surface that faces the sun, in units of radiance times steradian. It is
    the radiance of the disc times pi sin^2(angular_radius).
angular_radius: radians, 1e-4 to pi / 2; None: 0.004652, that of the sun seen from the earth.
Scene.add_light puts it into a scene.)");
    define(type, "mesh(self, positions, indices, normals=None, texcoords=None)", &mesh, R"(Triangles from arrays, copied.

positions: vertices x 3, metres.
indices: triangles x 3, whole numbers below the number of vertices.
normals: vertices x 3; None: computed, area-weighted.
texcoords: vertices x 2; None: none.)");
    define(type, "builtin_mesh(self, name, resolution=0)", &builtin_mesh,
           R"(A computed shape about one metre across: "sphere", "plane", "torus", "knot" or "blob".

resolution: segments around, 8 to 2048; 0: 256.)");
    define(type, "scene(self)", &scene, "An empty scene.");
    define(type, "frame(self, width, height, **settings)", &frame, R"(A picture of width x height pixels, each 1 to 8192.

Keywords are settings: context.frame(512, 512, samples=64). lightband.settings() lists them.)");
}

}  // namespace

void bind_context(py::module_& module) {
    ContextClass type(module, "Context", R"(One OpenGL device, without a window; everything else is made by it.

device: "hardware" (a GPU; DeviceError where there is none), "software" (the CPU) or "any" (a GPU, else the CPU;
    is_software tells which it became). Software rendering is never a silent fallback.
cache_path: folder for the tables of built-in materials (35 MB each). None: the user's cache folder. "": no cache.
log: called with each message of driver and library. It must not call the library; what it raises is reported to
    sys.unraisablehook. None: silence. The context and all that is made by it keep the callable alive, in a way that
    the garbage collector sees: it may be a method of the object that holds the context.

Calls on objects of one context wait for each other; objects of different contexts are independent.)",
                      collectable<Context>());
    const Signature signature("Context", "__init__(self, device='hardware', cache_path=None, log=None)");
    const auto create = [signature](const py::args& positional, const py::kwargs& named) {
        const py::tuple with_self = py::make_tuple(py::none()) + positional;
        const std::vector<Given> given = signature.assign(py::reinterpret_borrow<py::args>(with_self), named);
        return create_context(given[1], given[2], given[3]);
    };
    type.def(py::init(create), signature.documented("Opens the device; the class says what the arguments mean.").c_str());
    bind_closing(type);
    define_property(
        type, "device_name", +[](const Context* self) { return to_str(self->device_name.c_str()); },
        "Renderer and version, as the driver names them.");
    define_property(
        type, "is_software", +[](const Context* self) { return self->is_software; },
        "Whether the device is a software renderer.");
    define(
        type, "__repr__(self)",
        +[](const Context* self) { return describe("Context", *self, "on '" + self->device_name + "'"); },
        "The device.");
    bind_material_makers(type);
    bind_scene_makers(type);
}

}  // namespace lightband_python
