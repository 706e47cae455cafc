// What the Python objects hold, and the functions that define their classes.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "call.h"
#include "lightband/lightband.hpp"

namespace lightband_python {

struct Context {
    lightband::Context handle;
    std::string device_name;
    bool is_software;
};

struct Brdf {
    lightband::Brdf handle;
    std::string description;  // "builtin 'gold'", for repr
};

struct Environment {
    lightband::Environment handle;
    std::string description;
};

struct Mesh {
    lightband::Mesh handle;
    std::string description;
};

struct Scene {
    lightband::Scene handle;
    std::shared_ptr<Environment> environment = nullptr;  // the one set last
    uint32_t instances = 0;
    bool has_camera = false;
};

struct Frame {
    lightband::Frame handle;
    uint32_t width;
    uint32_t height;
};

// A handle has no meaning in another process. Left to itself, the oldest protocols of pickle would abort.
template <typename Object>
void refuse_pickling(py::class_<Object, std::shared_ptr<Object>>& type) {
    type.def("__reduce_ex__", [](const py::object& self, int) -> py::object {
        const auto name = py::cast<std::string>(py::type::of(self).attr("__name__"));
        throw py::type_error("cannot pickle a lightband." + name);
    });
}

// Adds close() and the with statement to the class of a handle. Closing drops this object's reference; objects made
// from it keep what they need.
template <typename Object>
void bind_closing(py::class_<Object, std::shared_ptr<Object>>& type) {
    const auto close = [](Object& self) {
        auto last = std::make_shared<decltype(self.handle)>(std::move(self.handle));
        destroy_outside([last = std::move(last)]() mutable { last.reset(); });
    };
    refuse_pickling(type);
    type.def("close", close,
             "Releases the handle now instead of when the object is collected. Calls on it then raise InvalidHandle; "
             "objects made from it live on.");
    type.def("__enter__", [](py::object self) { return self; });
    type.def("__exit__", [close](Object& self, const py::args&) { close(self); });
}

// "<lightband.Kind description>", with a mark when the object was closed.
template <typename Object>
py::str describe(const char* kind, const Object& object, const std::string& description) {
    const std::string text =
        std::string("<lightband.") + kind + " " + description + (object.handle ? ">" : ", closed>");
    return to_str(text.c_str());
}

void bind_context(py::module_& module);
void bind_light_and_material(py::module_& module);
void bind_scene(py::module_& module);
void bind_frame(py::module_& module);

}  // namespace lightband_python
