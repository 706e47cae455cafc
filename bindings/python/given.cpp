#include "given.h"

#include <cmath>
#include <limits>

#include "call.h"
#include "lightband/lightband.hpp"

namespace lightband_python {

namespace {

constexpr size_t longest_repr = 60;  // characters of a value in a message

std::string type_name(const py::object& value) { return Py_TYPE(value.ptr())->tp_name; }

// Whether a repr is quickly made and tells something.
bool has_short_repr(const py::object& value) {
    PyObject* const object = value.ptr();
    return PyBool_Check(object) || PyLong_CheckExact(object) || PyFloat_CheckExact(object) ||
           PyComplex_CheckExact(object) || PyUnicode_CheckExact(object) || PyBytes_CheckExact(object);
}

// Of a str or bytes no more than a message shows.
py::object shortened(const py::object& value) {
    const bool is_sequence = PyUnicode_CheckExact(value.ptr()) || PyBytes_CheckExact(value.ptr());
    return is_sequence && py::len(value) > longest_repr ? value[py::slice(0, longest_repr, 1)] : value;
}

bool is_scalar(const py::object& value) {
    return py::hasattr(value, "ndim") && py::object(value.attr("ndim")).equal(py::int_(0));
}

// "(2,)" and "float64" of anything like an array; nothing of anything else.
std::optional<std::string> describe_array(const py::object& value) {
    if (!py::hasattr(value, "dtype") || !py::hasattr(value, "shape")) {
        return std::nullopt;
    }
    const auto text = [](const py::object& part) { return py::cast<std::string>(py::str(part)); };
    if (is_scalar(value)) {
        return type_name(value) + " " + text(value).substr(0, longest_repr);
    }
    return "an array of shape " + text(value.attr("shape")) + " of " + text(value.attr("dtype"));
}

bool is_numpy_bool(const py::object& value) {
    return type_name(value) == "numpy.bool_" || type_name(value) == "numpy.bool";
}

// Whether float() would read a number and lose nothing: text, truth values, complex numbers and times are no numbers.
bool is_real_number(const py::object& value) {
    PyObject* const object = value.ptr();
    if (PyFloat_Check(object)) {
        return true;
    }
    if (PyBool_Check(object) || PyUnicode_Check(object) || PyBytes_Check(object) || PyComplex_Check(object)) {
        return false;
    }
    if (PyLong_Check(object)) {
        return true;
    }
    if (py::hasattr(value, "dtype")) {
        return is_scalar(value) && !py::hasattr(value, "mask") &&
               std::string("fiu").find(py::cast<std::string>(value.attr("dtype").attr("kind"))) != std::string::npos;
    }
    const PyNumberMethods* const methods = Py_TYPE(object)->tp_as_number;
    return methods != nullptr && (methods->nb_float != nullptr || methods->nb_index != nullptr);
}

}  // namespace

std::string describe_value(const py::object& value) {
    if (value.is_none()) {
        return "None";
    }
    try {
        if (has_short_repr(value)) {
            std::string text = py::cast<std::string>(py::repr(shortened(value)));
            if (text.size() > longest_repr) {
                text = text.substr(0, longest_repr) + "...";
            }
            return type_name(value) + " " + text;
        }
        return describe_array(value).value_or(type_name(value));
    } catch (const py::cast_error&) {  // text with lone surrogates
    } catch (const py::error_already_set& error) {  // an int of too many digits, a property that raises
        if (error.matches(PyExc_MemoryError)) {
            throw;
        }
    }
    return PyLong_CheckExact(value.ptr()) ? "an int of thousands of digits" : type_name(value);
}

void Given::refuse_type(const std::string& expected) const {
    throw WrongType(place() + " must be " + expected + (optional ? " or None" : "") + ", not " + describe_value(value));
}

void Given::refuse_value(const std::string& reason) const {
    throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT, place() + " " + reason);
}

double to_double(const Given& given, const std::string& expected) {
    if (!is_real_number(given.value)) {
        given.refuse_type(expected);
    }
    const double number = PyFloat_AsDouble(given.value.ptr());
    if (number == -1.0 && PyErr_Occurred() != nullptr) {
        const py::error_already_set error;
        if (error.matches(PyExc_OverflowError)) {
            given.refuse_value("is beyond the largest double, 1.8e308");
        }
        throw error;
    }
    return number;
}

float to_float(const Given& given) {
    const double number = to_double(given);
    if (std::isfinite(number) && std::fabs(number) > double(std::numeric_limits<float>::max())) {
        given.refuse_value("is " + py::cast<std::string>(py::repr(py::float_(number))) + "; it must fit a 32-bit float, at most 3.4e38");
    }
    return float(number);
}

float to_setting(const Given& given) {
    if (given.value.is_none()) {
        return 0;
    }
    const float value = to_float(given);
    if (value == 0) {
        given.refuse_value("is 0; it must be above 0, or None for the default");
    }
    return value;
}

uint32_t to_uint32(const Given& given) {
    constexpr const char* expected = "a whole number";
    PyObject* const object = given.value.ptr();
    if (PyBool_Check(object) || is_numpy_bool(given.value) || PyIndex_Check(object) == 0) {
        given.refuse_type(expected);
    }
    PyObject* const index = PyNumber_Index(object);
    if (index == nullptr) {
        const py::error_already_set error;
        if (error.matches(PyExc_TypeError)) {
            given.refuse_type(expected);
        }
        throw error;
    }
    const py::int_ number = py::reinterpret_steal<py::int_>(index);
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
    if (overflow != 0 || value < 0 || value > std::numeric_limits<uint32_t>::max()) {
        given.refuse_value("is " + describe_value(number) + "; it must be 0 to 4294967295");
    }
    return static_cast<uint32_t>(value);
}

std::string to_text(const Given& given) {
    if (!py::isinstance<py::str>(given.value)) {
        given.refuse_type("a str");
    }
    Py_ssize_t size = 0;
    const char* const text = PyUnicode_AsUTF8AndSize(given.value.ptr(), &size);
    if (text == nullptr) {
        PyErr_Clear();
        given.refuse_value("holds characters that have no UTF-8 (lone surrogates)");
    }
    std::string result(text, static_cast<size_t>(size));
    if (result.find('\0') != std::string::npos) {
        given.refuse_value("contains a zero byte");
    }
    return result;
}

std::filesystem::path to_path(const Given& given) {
    PyObject* const fspath = PyOS_FSPath(given.value.ptr());
    if (fspath == nullptr) {
        const py::error_already_set error;
        if (error.matches(PyExc_TypeError)) {
            given.refuse_type("a path (str, bytes or os.PathLike)");
        }
        throw error;
    }
    const py::object text = py::reinterpret_steal<py::object>(fspath);
    PyObject* encoded = nullptr;
    if (PyUnicode_FSConverter(text.ptr(), &encoded) == 0) {
        const py::error_already_set error;
        if (!error.matches(PyExc_ValueError)) {  // UnicodeEncodeError is one
            throw error;
        }
        given.refuse_value("is no path: " + py::cast<std::string>(py::str(error.value())));
    }
    return std::filesystem::path(py::cast<std::string>(py::reinterpret_steal<py::bytes>(encoded)));
}

bool to_flag(const Given& given) {
    if (!PyBool_Check(given.value.ptr()) && !is_numpy_bool(given.value)) {
        given.refuse_type("True or False");
    }
    return PyObject_IsTrue(given.value.ptr()) == 1;
}

py::object to_callable(const Given& given) {
    if (!(given.optional && given.value.is_none()) && PyCallable_Check(given.value.ptr()) == 0) {
        given.refuse_type("a callable");
    }
    return given.value;
}

}  // namespace lightband_python
