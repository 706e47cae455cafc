#include "arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "objects.h"

namespace lightband_python {

namespace {

std::string describe_shape(const std::vector<py::ssize_t>& shape) {
    std::string text = "(";
    for (size_t i = 0; i < shape.size(); ++i) {
        text += i > 0 ? ", " : "";
        text += shape[i] == any_length ? "any" : std::to_string(shape[i]);
    }
    return text + (shape.size() == 1 ? ",)" : ")");
}

// What an array argument must be, for messages.
std::string expected_array(const char* elements, const std::vector<py::ssize_t>& shape) {
    return std::string("an array of ") + elements + " of shape " + describe_shape(shape);
}

// Elements that a numpy.ma.MaskedArray hides would become numbers unseen.
bool hides_elements(const py::object& value) {
    return py::isinstance<py::array>(value) && py::hasattr(value, "mask") &&
           py::cast<bool>(py::module_::import("numpy").attr("any")(value.attr("mask")));
}

constexpr const char* real_kinds = "fiu";  // NumPy's letters: real, signed, unsigned
constexpr const char* whole_kinds = "iu";

// An ndarray of one of these kinds of elements; expected says in a message what else it must be.
py::array to_ndarray(const Given& given, const std::string& kinds, const std::string& expected) {
    // NumPy would take a bytearray for whole numbers.
    if (given.value.is_none() || PyUnicode_Check(given.value.ptr()) || PyBytes_Check(given.value.ptr()) ||
        PyByteArray_Check(given.value.ptr())) {
        given.refuse_type(expected);
    }
    if (hides_elements(given.value)) {
        given.refuse_value("has masked elements; numpy.ma.filled gives them values");
    }
    py::array array;
    try {
        array = call_python(py::module_::import("numpy").attr("asarray"), py::make_tuple(given.value));
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) {
            throw;
        }
        given.refuse_value("must be " + expected + ": " + py::cast<std::string>(py::str(error.value())));
    }
    const bool empty_list = array.size() == 0 && !py::isinstance<py::array>(given.value);  // float64 whatever was meant
    if (kinds.find(array.dtype().kind()) == std::string::npos && !empty_list) {
        if (array.ndim() == 0) {
            given.refuse_type(expected);
        }
        throw WrongType(given.place() + " must be " + expected + ", not " + describe_value(array));
    }
    return array;
}

void require_shape(const Given& given, const py::array& array, const std::vector<py::ssize_t>& shape,
                   const std::string& expected) {
    bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
    for (size_t i = 0; fits && i < shape.size(); ++i) {
        fits = shape[i] == any_length || shape[i] == array.shape(static_cast<py::ssize_t>(i));
    }
    if (!fits) {
        given.refuse_value("must be " + expected + ", not " +
                           (array.ndim() == 0 ? describe_value(given.value)
                                              : "an array of shape " + describe_shape(shape_of(array))));
    }
}

// Packs as float32. A value that becomes infinite by that is refused here: the library would speak of infinity. Calls no
// Python code, in which Python's end could stop this thread amid objects of Python (call.h).
FloatArray pack_floats(const Given& given, const py::array& array) {
    if (array.dtype().kind() == 'f' && array.itemsize() <= static_cast<py::ssize_t>(sizeof(float))) {
        return py::array_t<float, py::array::c_style | py::array::forcecast>(array);
    }
    const py::array_t<double, py::array::c_style | py::array::forcecast> wide(array);
    FloatArray packed(shape_of(array));
    const double* const from = wide.data();
    float* const to = packed.mutable_data();
    for (py::ssize_t i = 0; i < wide.size(); ++i) {
        to[i] = static_cast<float>(from[i]);
        if (std::isinf(to[i]) && std::isfinite(from[i])) {
            given.refuse_value("holds " + py::cast<std::string>(py::repr(py::float_(from[i]))) + ", which does not fit a 32-bit float, at most 3.4e38");
        }
    }
    return packed;
}

FloatArray to_floats(const Given& given, const std::vector<py::ssize_t>& shape, const std::string& expected) {
    const py::array array = to_ndarray(given, real_kinds, expected);
    require_shape(given, array, shape, expected);
    return pack_floats(given, array);
}

py::dtype element_type(uint32_t type) {
    switch (type) {
        case LB_TYPE_FLOAT32:
            return py::dtype::of<float>();
        case LB_TYPE_UINT32:
            return py::dtype::of<uint32_t>();
        case LB_TYPE_UINT8:
            return py::dtype::of<uint8_t>();
        default:
            throw lightband::Exception(LB_ERROR_INTERNAL, "a buffer of unknown element type " + std::to_string(type));
    }
}

}  // namespace

py::array to_array(std::string name, lightband::Buffer buffer) {
    const lb_buffer_view view = buffer.view();
    const py::object owner = py::cast(held(FieldBuffer{std::move(name), std::move(buffer)}));
    const std::vector<py::ssize_t> shape(view.shape, view.shape + view.dimensions);
    const std::vector<py::ssize_t> strides(view.strides, view.strides + view.dimensions);
    py::array array(element_type(view.type), shape, strides, view.data, owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

FloatArray to_floats(const Given& given, const std::vector<py::ssize_t>& shape) {
    return to_floats(given, shape, expected_array("real numbers", shape));
}

FloatArray to_floats(const Given& given) {
    return pack_floats(given, to_ndarray(given, real_kinds, "a number or an array of real numbers"));
}

FloatArray to_vectors(const Given& given) {
    constexpr const char* expected = "an array of real numbers of shape (..., 3)";
    const py::array array = to_ndarray(given, real_kinds, expected);
    if (array.ndim() == 0 || array.shape(array.ndim() - 1) != 3) {
        require_shape(given, array, {any_length, 3}, expected);
    }
    return pack_floats(given, array);
}

IndexArray to_indices(const Given& given, const std::vector<py::ssize_t>& shape) {
    const std::string expected = expected_array("whole numbers", shape);
    const py::array array = to_ndarray(given, whole_kinds, expected);
    require_shape(given, array, shape, expected);
    if (array.size() > 0) {
        for (const char* extreme : {"min", "max"}) {
            const py::object value = array.attr(extreme)();
            if (value < py::int_(0) || value > py::int_(std::numeric_limits<uint32_t>::max())) {
                given.refuse_value("holds " + py::cast<std::string>(py::str(value)) + "; each must be 0 to 4294967295");
            }
        }
    }
    return py::array_t<uint32_t, py::array::c_style | py::array::forcecast>(array);
}

lightband::Vector to_colour(const Given& given) {
    constexpr const char* expected = "one number or three (RGB)";
    const py::array array = to_ndarray(given, real_kinds, expected);
    if (array.ndim() == 0) {
        const float grey = *pack_floats(given, array).data();
        return {grey, grey, grey};
    }
    const FloatArray components = to_floats(given, {3}, expected);
    return {components.at(0), components.at(1), components.at(2)};
}

lightband::Vector to_vector(const Given& given) {
    const FloatArray components = to_floats(given, {3}, "three finite numbers");
    return {components.at(0), components.at(1), components.at(2)};
}

lightband::Transform to_transform(const Given& given) {
    constexpr const char* expected = "a 3x4 or 4x4 matrix of real numbers";
    const py::array matrix = to_ndarray(given, real_kinds, expected);
    const bool homogeneous = matrix.ndim() == 2 && matrix.shape(0) == 4;
    const FloatArray rows = to_floats(given, {homogeneous ? 4 : 3, 4}, expected);
    if (homogeneous && (rows.at(3, 0) != 0 || rows.at(3, 1) != 0 || rows.at(3, 2) != 0 || rows.at(3, 3) != 1)) {
        given.refuse_value("is a 4x4 matrix whose last row is not (0, 0, 0, 1)");
    }
    lightband::Transform transform;
    std::copy_n(rows.data(), transform.size(), transform.begin());
    return transform;
}

uint32_t to_length(const Given& given, py::ssize_t length, const char* what) {
    if (static_cast<uint64_t>(length) > std::numeric_limits<uint32_t>::max()) {
        given.refuse_value("has " + std::to_string(length) + " " + what + "; at most 4294967295 are possible");
    }
    return static_cast<uint32_t>(length);
}

std::vector<py::ssize_t> shape_of(const py::array& array) {
    return std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim());
}

void bind_field_buffer(py::module_& module) {
    py::class_<FieldBuffer, std::shared_ptr<FieldBuffer>> type(module, "Buffer", R"(The library's memory of one field.

The base of every array that the library returns: it keeps the memory alive as long as any array shows it, whatever
happens to the frame, material or map that it came from, and says what the numbers mean:

    >>> frame.bandwidth_image.base.unit
    '1/pixel')");
    refuse_construction<FieldBuffer>(type, "the base of an array that the library returns is one");
    refuse_pickling<FieldBuffer>(type);
    define_property(
        type, "name", +[](const FieldBuffer& self) { return self.name; }, "Name of the field.");
    define_property(
        type, "unit", +[](const FieldBuffer& self) { return to_str(self.handle.view().unit); },
        "Unit of the elements; \"\" of a pure number.");
    define(
        type, "__repr__(self)",
        +[](const FieldBuffer& self) {
            return "<lightband.Buffer '" + self.name + "' in " + self.handle.view().unit + ">";
        },
        "The field and its unit.");
}

}  // namespace lightband_python
