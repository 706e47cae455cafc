// What the Python objects hold, and the functions that define their classes.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "call.h"
#include "function.h"
#include "lightband/lightband.hpp"

namespace lightband_python {

// What Python's garbage collector has to see of an object. The log callback of a context is often a method of the
// object that holds the context, or something that was made from it: the references to it are Python's own, one of
// each such object, and the library has none (context.cpp).
struct Collectable {
    py::object log;  // none: no callback

    template <typename Visit>
    void each_reference(const Visit& visit) {
        visit(log);
    }
};

struct Context : Collectable {
    lightband::Context handle;
    std::string device_name;
    bool is_software;
};

struct Brdf : Collectable {
    lightband::Brdf handle;
    std::string description;  // "builtin 'gold'", for repr
};

struct Environment : Collectable {
    lightband::Environment handle;
    std::string description;
};

struct Sun : Collectable {
    lightband::Light handle;
};

struct Mesh : Collectable {
    lightband::Mesh handle;
    std::string description;
};

struct Scene : Collectable {
    lightband::Scene handle;
    py::object environment = py::none();  // the one set last
    uint32_t instances = 0;
    bool has_camera = false;

    template <typename Visit>
    void each_reference(const Visit& visit) {
        visit(log);
        visit(environment);
    }
};

struct Frame : Collectable {
    lightband::Frame handle;
    uint32_t width;
    uint32_t height;
};

// Sets a setting to a number or, for a choice, its name; messages speak of value.function and of the setting.
void set_setting(Frame& frame, const std::string& name, const Given& value);

// From Python's arguments.
lightband::Sun to_sun(const Given& direction, const Given& irradiance, const Given& angular_radius);

// Lets the garbage collector see what an object refers to, and break cycles at it.
template <typename Object>
py::custom_type_setup collectable() {
    return py::custom_type_setup([](PyHeapTypeObject* heap_type) {
        PyTypeObject& type = heap_type->ht_type;
        type.tp_flags |= Py_TPFLAGS_HAVE_GC;
        type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
            Py_VISIT(Py_TYPE(self));
            int result = 0;
            if (py::detail::is_holder_constructed(self)) {
                py::cast<Object&>(py::handle(self)).each_reference([&](const py::object& reference) {
                    if (result == 0 && reference) {
                        result = visit(reference.ptr(), arg);
                    }
                });
            }
            return result;
        };
        type.tp_clear = [](PyObject* self) {
            if (py::detail::is_holder_constructed(self)) {
                // A reference is replaced before it is dropped: its end may lead here again.
                py::cast<Object&>(py::handle(self)).each_reference([](py::object& reference) {
                    const py::object dropped = std::exchange(reference, py::none());
                });
            }
            return 0;
        };
    });
}

// Objects that the library's calls return have no constructor of their own.
template <typename Object>
void refuse_construction(py::class_<Object, std::shared_ptr<Object>>& type, const char* origin) {
    const std::string message = "lightband." + name_of(type) + " has no constructor: " + origin;
    type.def(py::init([message](const py::args&, const py::kwargs&) -> std::shared_ptr<Object> {
                 throw WrongType(message);
             }),
             ("__init__(self)\n--\n\n" + message + ".").c_str());
}

// A handle has no meaning in another process. Left to itself, the oldest protocols of pickle would abort.
template <typename Object>
void refuse_pickling(const py::class_<Object, std::shared_ptr<Object>>& type) {
    define(
        type, "__reduce_ex__(self, protocol)",
        +[](const Object* self, const Given& /*protocol*/) -> py::object {
            throw WrongType("cannot pickle or copy a lightband." + name_of(py::type::of<Object>()) +
                            (self ? ": it belongs to a device of this process" : ""));
        },
        "Raises InvalidType: the object belongs to a device of this process.");
}

// Adds close() and the with statement to the class of a handle. Closing drops this object's reference; objects made
// from it keep what they need.
template <typename Object>
void bind_closing(const py::class_<Object, std::shared_ptr<Object>>& type) {
    refuse_pickling<Object>(type);
    define(
        type, "close(self)", +[](Object* self) { release_outside(std::move(self->handle)); },
        "Releases the handle now instead of when the object is collected.\n\n"
        "Calls on it then raise InvalidHandle; objects made from it live on.");
    define(
        type, "__enter__(self)", +[](const Given& self) { return self.value; }, "The object itself.");
    define(
        type, "__exit__(self, kind, error, trace)",
        +[](Object* self, const Given&, const Given&, const Given&) { release_outside(std::move(self->handle)); },
        "Closes the object.");
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
