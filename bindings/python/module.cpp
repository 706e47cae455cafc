// lightband._lightband: errors, tables of names, and the classes of the other files.
#include <pybind11/pybind11.h>

#include "arrays.h"
#include "objects.h"

namespace lightband_python {

namespace {

// Raises the class of lightband.errors that has the code of the library's exception.
void raise_error(const lightband::Exception& exception) {
    const py::object type = call_python(
        py::module_::import("lightband.errors").attr("class_of"), py::make_tuple(exception.code()));
    PyErr_SetObject(type.ptr(), to_str(exception.what()).ptr());
}

// lightband.InvalidType is no class of a result code: the library itself never sees a wrong type.
void raise_wrong_type(const WrongType& exception) {
    const py::object type = py::module_::import("lightband.errors").attr("InvalidType");
    PyErr_SetObject(type.ptr(), to_str(exception.what()).ptr());
}

void translate(std::exception_ptr thrown) {
    try {
        if (thrown) {
            std::rethrow_exception(thrown);
        }
    } catch (const lightband::Exception& exception) {
        raise_error(exception);
    } catch (const WrongType& exception) {
        raise_wrong_type(exception);
    }
}

py::tuple names(uint32_t count, const char* (*name_at)(uint32_t)) {
    py::tuple result(count);
    for (uint32_t i = 0; i < count; ++i) {
        result[i] = to_str(name_at(i));
    }
    return result;
}

py::object read_setting(uint32_t index) {
    lb_setting_info info = LB_SETTING_INFO_INIT;
    lightband::check(lb_setting_at(index, &info));
    const py::object setting = py::module_::import("lightband._records").attr("Setting");
    const py::str name = to_str(info.name);
    const py::str documentation = to_str(info.documentation);
    switch (info.type) {
        case LB_SETTING_INTEGER:
            return setting(name, "integer", static_cast<int64_t>(info.minimum), static_cast<int64_t>(info.maximum),
                           static_cast<int64_t>(info.default_number), py::tuple(), documentation);
        case LB_SETTING_REAL:
            return setting(name, "real", info.minimum, info.maximum, info.default_number, py::tuple(), documentation);
        default:
            return setting(name, "choice", py::none(), py::none(), to_str(info.default_choice),
                           py::tuple(to_str(info.choices).attr("split")("|")), documentation);
    }
}

py::tuple settings() {
    const uint32_t count = lb_setting_count();
    py::tuple result(count);
    for (uint32_t i = 0; i < count; ++i) {
        result[i] = read_setting(i);
    }
    return result;
}

std::string version() {
    const uint32_t number = lb_version();  // 10000 * major + 100 * minor + patch
    return std::to_string(number / 10000) + "." + std::to_string(number / 100 % 100) + "." +
           std::to_string(number % 100);
}

}  // namespace

PYBIND11_MODULE(_lightband, module) {
    module.doc() = "The library behind the package lightband.";
    py::options options;
    options.disable_function_signatures();  // each docstring brings its own (function.h)
    module.attr("__version__") = version();
    py::register_local_exception_translator(&translate);
    define(module, "settings()", &settings, "The settings of a frame: a tuple of Setting, in the library's order.");
    define(
        module, "builtin_materials()", +[] { return names(lb_brdf_builtin_count(), &lb_brdf_builtin_name); },
        "Names for Context.builtin_brdf.");
    define(
        module, "buffer_names()", +[] { return names(lb_frame_buffer_count(), &lb_frame_buffer_name); },
        "Names for Frame.buffer and Frame.save.");
    bind_field_buffer(module);
    bind_light_and_material(module);
    bind_scene(module);
    bind_frame(module);
    bind_context(module);
}

}  // namespace lightband_python
