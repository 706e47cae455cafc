// Functions, methods and properties of this package.
//
// pybind11 answers a call that fits none of its overloads with a list of C++ signatures. So it sees functions of
// *args and **kwargs alone here: what a call gives is assigned to parameters as Python does it, by a signature that
// inspect and help() show as well, and each argument is converted by the type of the C++ function's parameter.
//
//     define<Scene>(type, "set_transform(self, index, transform)", &set_transform, "Replaces the transform ...");
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "given.h"
#include "lightband/lightband.hpp"

namespace lightband_python {

// "camera(self, eye, target, up=None)", as in a Python program; a last **name collects other keywords as a dict.
class Signature {
public:
    // owner: the class, "" of a function of the module.
    Signature(const std::string& owner, const char* text);

    // The arguments in the order of the parameters. Raises InvalidType where one is missing, unknown or too many.
    std::vector<Given> assign(const py::args& positional, const py::kwargs& named) const;

    const std::string& name() const { return name_; }
    // How CPython stores a docstring together with the signature that it is shown with.
    std::string documented(const char* documentation) const { return text_ + "\n--\n\n" + documentation; }

private:
    struct Parameter {
        std::string name;
        py::object default_value;  // without an object: it must be given
    };
    std::string listed() const;
    size_t position_of(const std::string& name) const;

    std::string text_, name_, called_;  // called_: "Scene.camera"
    std::vector<Parameter> parameters_;
    std::string rest_;  // name of the dict of other keywords; "" where there is none
};

// ---- From an argument to the parameter of a C++ function --------------------------------------------------------

// The C++ object behind a Python object of its class.
template <typename Object>
Object& to_object(const Given& given) {
    const auto name = [] { return py::cast<std::string>(py::type::of<Object>().attr("__name__")); };
    if (!py::isinstance<Object>(given.value)) {
        given.refuse_type("a lightband." + name());
    }
    if (!py::detail::is_holder_constructed(given.value.ptr())) {
        throw WrongType(given.place() + " was never initialised: lightband." + name() + ".__init__ has not run");
    }
    return py::cast<Object&>(given.value);
}

// A parameter Object& needs an object that was not closed; Object* may be closed.
template <typename Parameter>
struct From {
    static Parameter take(const Given& given) {
        auto& object = to_object<std::remove_const_t<std::remove_reference_t<Parameter>>>(given);
        if (!object.handle) {
            throw lightband::Exception(LB_ERROR_INVALID_HANDLE,
                                       given.name == "self" ? given.function + ": the object was closed"
                                                            : given.place() + " was closed");
        }
        return object;
    }
};
template <typename Object>
struct From<Object*> {
    static Object* take(const Given& given) { return &to_object<std::remove_const_t<Object>>(given); }
};
template <>
struct From<const Given&> {
    static const Given& take(const Given& given) { return given; }
};
template <>
struct From<float> {
    static float take(const Given& given) { return to_float(given); }
};
template <>
struct From<uint32_t> {
    static uint32_t take(const Given& given) { return to_uint32(given); }
};
template <>
struct From<bool> {
    static bool take(const Given& given) { return to_flag(given); }
};
template <>
struct From<const std::string&> {
    static std::string take(const Given& given) { return to_text(given); }
};
template <>
struct From<const std::filesystem::path&> {
    static std::filesystem::path take(const Given& given) { return to_path(given); }
};

// ---- Definitions ------------------------------------------------------------------------------------------------

template <typename Result, typename... Parameters, size_t... Indices>
py::object call_with(Result (*function)(Parameters...), const std::vector<Given>& given,
                     std::index_sequence<Indices...> /*indices*/) {
    // Braces convert the arguments from left to right: the first wrong one is the one that is named.
    std::tuple<decltype(From<Parameters>::take(given[0]))...> taken{From<Parameters>::take(given[Indices])...};
    if constexpr (std::is_void_v<Result>) {
        std::apply(function, taken);
        return py::none();
    } else if constexpr (std::is_base_of_v<py::object, Result>) {
        return std::apply(function, taken);
    } else {
        return py::cast(std::apply(function, taken));
    }
}

// documentation: the whole docstring.
template <typename Result, typename... Parameters>
py::cpp_function make_function(const py::handle& scope, Signature signature, Result (*function)(Parameters...),
                               const std::string& documentation) {
    const std::string name = signature.name();
    const auto call = [signature = std::move(signature), function](const py::args& positional,
                                                                   const py::kwargs& named) {
        return call_with(function, signature.assign(positional, named), std::index_sequence_for<Parameters...>());
    };
    if (py::isinstance<py::module_>(scope)) {
        return py::cpp_function(call, py::name(name.c_str()), py::scope(scope), documentation.c_str());
    }
    return py::cpp_function(call, py::name(name.c_str()), py::is_method(scope), documentation.c_str());
}

inline std::string name_of(const py::handle& scope) {
    return py::isinstance<py::module_>(scope) ? "" : py::cast<std::string>(scope.attr("__name__"));
}

// A function of a module or a method of a class.
template <typename Result, typename... Parameters>
void define(const py::handle& scope, const char* text, Result (*function)(Parameters...), const char* documentation) {
    const Signature signature(name_of(scope), text);
    py::setattr(scope, signature.name().c_str(),
                make_function(scope, signature, function, signature.documented(documentation)));
}

// A property; setter: a function of (self, value), or nothing.
template <typename Result, typename Self, typename Setter = std::nullptr_t>
void define_property(const py::handle& type, const char* name, Result (*getter)(Self), const char* documentation,
                     Setter setter = nullptr) {
    const std::string owner = name_of(type);
    const py::object get = make_function(type, Signature(owner, (std::string(name) + "(self)").c_str()), getter, "");
    py::object set = py::none();
    if constexpr (!std::is_null_pointer_v<Setter>) {
        const std::string text = std::string(name) + "(self, " + name + ")";
        set = make_function(type, Signature(owner, text.c_str()), setter, "");
    }
    const py::handle property(reinterpret_cast<PyObject*>(&PyProperty_Type));
    py::setattr(type, name, property(get, set, py::none(), documentation));
}

}  // namespace lightband_python
