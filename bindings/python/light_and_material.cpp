// lightband.Environment and lightband.Brdf: light and material as arrays.
#include <algorithm>

#include "arrays.h"
#include "objects.h"

namespace lightband_python {

namespace {

using EnvironmentClass = py::class_<Environment, std::shared_ptr<Environment>>;
using BrdfClass = py::class_<Brdf, std::shared_ptr<Brdf>>;

// One field of a light or material.
template <typename Object>
py::array field(const Object& self, const char* name) {
    return to_array(name, in_library([&] { return self.handle.map(name); }));
}

// The two arrays of directions, broadcast against each other.
std::pair<FloatArray, FloatArray> broadcast_directions(const Given& wi, const Given& wo) {
    const FloatArray incident = to_vectors(wi);
    const FloatArray outgoing = to_vectors(wo);
    try {
        const py::list both(py::module_::import("numpy").attr("broadcast_arrays")(incident, outgoing));
        return {FloatArray(both[0]), FloatArray(both[1])};
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_ValueError)) {
            throw;
        }
        throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT,
                                   py::cast<std::string>(py::str("Brdf.evaluate: wi and wo do not fit each other: {}")
                                                             .format(error.value())));
    }
}

FloatArray evaluate(const Brdf& self, const Given& wi, const Given& wo) {
    const auto [incident, outgoing] = broadcast_directions(wi, wo);
    FloatArray result(shape_of(incident));
    const float* from = incident.data();
    const float* to = outgoing.data();
    float* rgb = result.mutable_data();
    const py::ssize_t size = result.size();
    in_library([&] {
        for (py::ssize_t i = 0; i < size; i += 3) {
            const lightband::Vector value =
                self.handle.evaluate({from[i], from[i + 1], from[i + 2]}, {to[i], to[i + 1], to[i + 2]});
            std::copy(value.begin(), value.end(), rgb + i);
        }
    });
    return result;
}

FloatArray albedo(const Brdf& self, const Given& theta_o) {
    const FloatArray angles = to_floats(theta_o);
    std::vector<py::ssize_t> shape = shape_of(angles);
    shape.push_back(3);
    FloatArray result(shape);
    const float* theta = angles.data();
    float* rgb = result.mutable_data();
    const py::ssize_t count = angles.size();
    in_library([&] {
        for (py::ssize_t i = 0; i < count; ++i) {
            const lightband::Vector value = self.handle.albedo(theta[i]);
            std::copy(value.begin(), value.end(), rgb + 3 * i);
        }
    });
    return result;
}

void set_sun(const Sun& self, const Given& direction, const Given& irradiance, const Given& angular_radius) {
    const lightband::Sun sun = to_sun(direction, irradiance, angular_radius);
    in_library([&] { self.handle.set(sun); });
}

}  // namespace

lightband::Sun to_sun(const Given& direction, const Given& irradiance, const Given& angular_radius) {
    return {to_vector(direction), to_colour(irradiance), to_setting(angular_radius)};
}

void bind_light_and_material(py::module_& module) {
    EnvironmentClass environment(module, "Environment",
                                 "Distant light. Made by Context.load_environment and Context.environment.",
                                 collectable<Environment>());
    refuse_construction(environment, "Context.load_environment and Context.environment make one");
    bind_closing(environment);
    define_property(
        environment, "radiance", +[](const Environment& self) { return field(self, "radiance"); },
        "float32, height x width x 3: linear RGB as loaded, rows top-down.");
    define_property(
        environment, "bandwidth", +[](const Environment& self) { return field(self, "bandwidth"); },
        R"(float32, size x size: cycles/radian per direction, on the octahedral square (docs/conventions.md).

It ends at what its texels, or the map's, can show.)");
    define(
        environment, "__repr__(self)",
        +[](const Environment* self) { return describe("Environment", *self, self->description); },
        "Where the light comes from.");

    py::class_<Sun, std::shared_ptr<Sun>> sun(
        module, "Sun", "A disc of uniform radiance, infinitely far away. Made by Context.sun.", collectable<Sun>());
    refuse_construction(sun, "Context.sun makes one");
    bind_closing(sun);
    define(sun, "set(self, direction, irradiance, angular_radius=None)", &set_sun, R"(Moves and changes the sun; see Context.sun.

Scenes that it is in show it when they are rendered next.)");
    define(
        sun, "__repr__(self)", +[](const Sun* self) { return describe("Sun", *self, "a distant disc"); }, "That it is a sun.");

    BrdfClass brdf(module, "Brdf", R"(A reflectance, in 1/steradian.

Made by Context.load_brdf, builtin_brdf, table_brdf, lambert and ggx.)",
                   collectable<Brdf>());
    refuse_construction(brdf, "Context.load_brdf, builtin_brdf, table_brdf, lambert and ggx make one");
    bind_closing(brdf);
    define_property(
        brdf, "table", +[](const Brdf& self) { return field(self, "table"); },
        R"(float32, 90 x 90 x 180 x 3: 1/steradian, cells (theta_half, theta_diff, phi_diff).

Raises StateError for a reflectance that has no table.)");
    define_property(
        brdf, "bandwidth", +[](const Brdf& self) { return field(self, "bandwidth"); },
        R"(float32, 32 x 64 x 64: cycles/radian of the lobe, 1e9 where unbounded.

First axis: views in steps of cos(theta_o); then the square of incident directions (docs/conventions.md).)");
    define(brdf, "evaluate(self, wi, wo)", &evaluate, R"(The value for directions to the light and to the eye.

wi, wo: arrays of shape (..., 3) in the local frame, +Z the normal; broadcast against each other.
Returns RGB in 1/steradian, shape (..., 3); zero below the horizon. Nearest cell of a table.)");
    define(brdf, "albedo(self, theta_o)", &albedo, R"(Directional albedo: the part of the light that is reflected.

theta_o: angle of the view to the normal, radians in [0, pi/2), a number or an array.
Returns RGB, shape theta_o.shape + (3,).)");
    define(
        brdf, "__repr__(self)", +[](const Brdf* self) { return describe("Brdf", *self, self->description); },
        "The kind of reflectance.");
}

}  // namespace lightband_python
