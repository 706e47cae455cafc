#include "arrays.h"

#include <limits>
#include <sstream>

#include "objects.h"

namespace lightband_python {

namespace {

[[noreturn]] void refuse(const char* argument, const std::string& reason) {
    throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT, std::string(argument) + ": " + reason);
}

std::string describe_shape(const std::vector<py::ssize_t>& shape) {
    std::ostringstream text;
    text << "(";
    for (size_t i = 0; i < shape.size(); ++i) {
        text << (i > 0 ? ", " : "");
        if (shape[i] == any_length) {
            text << "any";
        } else {
            text << shape[i];
        }
    }
    text << (shape.size() == 1 ? ",)" : ")");
    return text.str();
}

// An ndarray of any element type; kinds are NumPy's letters ("f" real, "i" signed, "u" unsigned).
py::array to_ndarray(const py::object& values, const char* argument, const std::string& kinds) {
    py::array array;
    try {
        array = py::module_::import("numpy").attr("asarray")(values);
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) {
            throw;
        }
        refuse(argument, "not an array: " + py::cast<std::string>(py::str(error.value())));
    }
    const bool empty_list = array.size() == 0 && !py::isinstance<py::array>(values);  // float64 whatever was meant
    if (kinds.find(array.dtype().kind()) == std::string::npos && !empty_list) {
        refuse(argument, "elements of type " + py::cast<std::string>(py::str(array.dtype())) + " cannot be taken as " +
                             (kinds == "iu" ? "whole numbers" : "real numbers"));
    }
    return array;
}

void require_shape(const py::array& array, const char* argument, const std::vector<py::ssize_t>& shape) {
    bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
    for (size_t i = 0; fits && i < shape.size(); ++i) {
        fits = shape[i] == any_length || shape[i] == array.shape(static_cast<py::ssize_t>(i));
    }
    if (!fits) {
        refuse(argument, "shape " + describe_shape(shape_of(array)) + " instead of " + describe_shape(shape));
    }
}

// A value beyond float32 becomes infinite here; the library refuses it by name.
FloatArray pack_floats(const py::array& array) {
    return py::array_t<float, py::array::c_style | py::array::forcecast>(array);
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

FloatArray to_floats(const py::object& values, const char* argument, const std::vector<py::ssize_t>& shape) {
    const py::array array = to_ndarray(values, argument, "fiu");
    require_shape(array, argument, shape);
    return pack_floats(array);
}

FloatArray to_floats(const py::object& values, const char* argument) {
    return pack_floats(to_ndarray(values, argument, "fiu"));
}

FloatArray to_vectors(const py::object& values, const char* argument) {
    const py::array array = to_ndarray(values, argument, "fiu");
    if (array.ndim() == 0 || array.shape(array.ndim() - 1) != 3) {
        refuse(argument, "shape " + describe_shape(shape_of(array)) + " instead of (..., 3)");
    }
    return pack_floats(array);
}

IndexArray to_indices(const py::object& values, const char* argument, const std::vector<py::ssize_t>& shape) {
    const py::array array = to_ndarray(values, argument, "iu");
    require_shape(array, argument, shape);
    if (array.size() > 0) {
        const py::object smallest = array.attr("min")();
        const py::object largest = array.attr("max")();
        if (smallest < py::int_(0)) {
            refuse(argument, py::cast<std::string>(py::str(smallest)) + " is negative");
        }
        if (largest > py::int_(std::numeric_limits<uint32_t>::max())) {
            refuse(argument, py::cast<std::string>(py::str(largest)) + " exceeds 32 bits");
        }
    }
    return py::array_t<uint32_t, py::array::c_style | py::array::forcecast>(array);
}

lightband::Vector to_colour(const py::object& value, const char* argument) {
    const py::array array = to_ndarray(value, argument, "fiu");
    if (array.ndim() == 0) {
        const float grey = py::cast<float>(py::float_(array));
        return {grey, grey, grey};
    }
    return to_vector(array, argument);
}

lightband::Vector to_vector(const py::object& value, const char* argument) {
    const FloatArray components = to_floats(value, argument, {3});
    return {components.at(0), components.at(1), components.at(2)};
}

lightband::Transform to_transform(const py::object& value) {
    const py::array matrix = to_ndarray(value, "transform", "fiu");
    const bool homogeneous = matrix.ndim() == 2 && matrix.shape(0) == 4;
    const FloatArray rows = to_floats(matrix, "transform", {homogeneous ? 4 : 3, 4});
    if (homogeneous && (rows.at(3, 0) != 0 || rows.at(3, 1) != 0 || rows.at(3, 2) != 0 || rows.at(3, 3) != 1)) {
        refuse("transform", "the last row of a 4x4 matrix must be (0, 0, 0, 1)");
    }
    lightband::Transform transform;
    std::copy_n(rows.data(), transform.size(), transform.begin());
    return transform;
}

uint32_t to_uint32(py::ssize_t value, const char* argument) {
    if (value < 0 || static_cast<uint64_t>(value) > std::numeric_limits<uint32_t>::max()) {
        refuse(argument, std::to_string(value) + " is not in [0, 4294967295]");
    }
    return static_cast<uint32_t>(value);
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
    refuse_pickling(type);
    type.def_readonly("name", &FieldBuffer::name, "Name of the field.")
        .def_property_readonly(
            "unit", [](const FieldBuffer& self) { return to_str(self.buffer.view().unit); }, "Unit of the elements.")
        .def("__repr__", [](const FieldBuffer& self) {
            return "<lightband.Buffer '" + self.name + "' in " + self.buffer.view().unit + ">";
        });
}

}  // namespace lightband_python
