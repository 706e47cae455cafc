// lightband.Environment and lightband.Brdf: light and material as arrays.
#include <algorithm>

#include "arrays.h"
#include "objects.h"

namespace lightband_python {

namespace {

using EnvironmentClass = py::class_<Environment, std::shared_ptr<Environment>>;
using BrdfClass = py::class_<Brdf, std::shared_ptr<Brdf>>;

// Adds a property that maps one field of a light or material.
template <typename Object>
void bind_field(py::class_<Object, std::shared_ptr<Object>>& type, const char* name, const char* documentation) {
    type.def_property_readonly(
        name, [name](const Object& self) { return to_array(name, in_library([&] { return self.handle.map(name); })); },
        documentation);
}

// The two arrays of directions, broadcast against each other.
std::pair<FloatArray, FloatArray> broadcast_directions(const FloatArray& wi, const FloatArray& wo) {
    try {
        const py::list both = py::list(py::module_::import("numpy").attr("broadcast_arrays")(wi, wo));
        return {to_vectors(both[0], "wi"), to_vectors(both[1], "wo")};
    } catch (const py::error_already_set& error) {
        throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT,
                                   py::cast<std::string>(py::str("wi, wo: {}").format(error.value())));
    }
}

FloatArray evaluate(const Brdf& self, const py::object& wi, const py::object& wo) {
    const auto [incident, outgoing] = broadcast_directions(to_vectors(wi, "wi"), to_vectors(wo, "wo"));
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

FloatArray albedo(const Brdf& self, const py::object& theta_o) {
    const FloatArray angles = to_floats(theta_o, "theta_o");
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

}  // namespace

void bind_light_and_material(py::module_& module) {
    EnvironmentClass environment(module, "Environment",
                                 "Distant light. Made by Context.load_environment and Context.environment.");
    bind_closing(environment);
    bind_field(environment, "radiance", "float32, height x width x 3: linear RGB as loaded, rows top-down.");
    bind_field(environment, "bandwidth",
               "float32, size x size: cycles/radian per direction, on the octahedral square (docs/conventions.md); it ends "
               "at what its texels, or the map's, can show.");
    environment.def("__repr__",
                    [](const Environment& self) { return describe("Environment", self, self.description); });

    BrdfClass brdf(module, "Brdf", R"(A reflectance, in 1/steradian.

Made by Context.load_brdf, builtin_brdf, table_brdf, lambert and ggx.)");
    bind_closing(brdf);
    bind_field(brdf, "table", R"(float32, 90 x 90 x 180 x 3: 1/steradian, cells (theta_half, theta_diff, phi_diff).

Raises StateError for a reflectance that has no table.)");
    bind_field(brdf, "bandwidth", R"(float32, 32 x 64 x 64: cycles/radian of the lobe, 1e9 where unbounded.

First axis: views in steps of cos(theta_o); then the square of incident directions (docs/conventions.md).)");
    brdf.def("evaluate", &evaluate, py::arg("wi"), py::arg("wo"),
             R"(The value for directions to the light and to the eye.

wi, wo: arrays of shape (..., 3) in the local frame, +Z the normal; broadcast against each other.
Returns RGB in 1/steradian, shape (..., 3); zero below the horizon. Nearest cell of a table.)");
    brdf.def("albedo", &albedo, py::arg("theta_o"), R"(Directional albedo: the part of the light that is reflected.

theta_o: angle of the view to the normal, radians in [0, pi/2), a number or an array.
Returns RGB, shape theta_o.shape + (3,).)");
    brdf.def("__repr__", [](const Brdf& self) { return describe("Brdf", self, self.description); });
}

}  // namespace lightband_python
