// Between NumPy arrays and the library's memory.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>
#include <vector>

#include "given.h"
#include "lightband/lightband.hpp"

namespace lightband_python {

namespace py = pybind11;

// The library's memory of one field; the base of the arrays that show it.
struct FieldBuffer {
    std::string name;
    lightband::Buffer handle;
};

// The field as an array without a copy: read-only, its base a FieldBuffer.
py::array to_array(std::string name, lightband::Buffer buffer);

using FloatArray = py::array_t<float, py::array::c_style>;
using IndexArray = py::array_t<uint32_t, py::array::c_style>;

// An extent that any length fits.
constexpr py::ssize_t any_length = -1;

// Anything that NumPy can read as real numbers, as tightly packed float32, copied where it is not. The shape must be
// the given one. Refused are masked elements, and values beyond the largest float32.
FloatArray to_floats(const Given& given, const std::vector<py::ssize_t>& shape);

// The same for whole numbers that fit uint32.
IndexArray to_indices(const Given& given, const std::vector<py::ssize_t>& shape);

// Real numbers of any shape.
FloatArray to_floats(const Given& given);

// Vectors of three along the last axis of an array of any further axes.
FloatArray to_vectors(const Given& given);

// RGB, or one number for all three.
lightband::Vector to_colour(const Given& given);

lightband::Vector to_vector(const Given& given);

// A 3x4 matrix, or a 4x4 one whose last row is (0, 0, 0, 1).
lightband::Transform to_transform(const Given& given);

// The length of one axis of an array, as the C interface wants it.
uint32_t to_length(const Given& given, py::ssize_t length, const char* what);

std::vector<py::ssize_t> shape_of(const py::array& array);

void bind_field_buffer(py::module_& module);

}  // namespace lightband_python
