// Arguments from Python, each with the place that a message names: every conversion of this package starts from one.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace lightband_python {

namespace py = pybind11;

// Becomes lightband.InvalidType.
class WrongType : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Given {
    std::string function;  // "Scene.camera"
    std::string name;      // of the parameter, "eye"
    py::object value;
    bool optional = false;  // None is accepted as well; for messages alone

    // "Scene.camera: eye"
    std::string place() const { return function + ": " + name; }

    // Raises lightband.InvalidType, "Scene.camera: eye must be three finite numbers, not int 1".
    [[noreturn]] void refuse_type(const std::string& expected) const;

    // Raises lightband.InvalidArgument, "Scene.camera: eye" + reason.
    [[noreturn]] void refuse_value(const std::string& reason) const;
};

// "int 1", "str 'red'", "an array of shape (2,) of float64": short, whatever the value is.
std::string describe_value(const py::object& value);

// A number that is neither bool nor complex; also one of NumPy's, a Fraction or a Decimal.
double to_double(const Given& given, const std::string& expected = "a number");

// The same as float32.
float to_float(const Given& given);

// None: 0, by which the C interface means the default; so in Python a zero is a mistake.
float to_setting(const Given& given);

uint32_t to_uint32(const Given& given);

std::string to_text(const Given& given);

// A str, bytes or os.PathLike, in the encoding of the file system.
std::filesystem::path to_path(const Given& given);

// True or False, of Python or NumPy; nothing else, so that "no" is not taken for true.
bool to_flag(const Given& given);

// A callable, or None where given.optional is set.
py::object to_callable(const Given& given);

}  // namespace lightband_python
