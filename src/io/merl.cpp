#include "io/merl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "io/file.h"

namespace lightband::io {
namespace {

constexpr size_t cell_count = BrdfTable::cell_count;
constexpr size_t header_bytes = 3 * sizeof(int32_t);
constexpr size_t value_bytes = sizeof(double);
constexpr size_t file_bytes = header_bytes + 3 * cell_count * value_bytes;

// From stored values to 1/steradian: the factors of BRDFRead.cpp, which the authors distribute with the data.
constexpr std::array<double, 3> channel_scale = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::array<const char*, 3> channel_name = {"red", "green", "blue"};

constexpr std::array<int32_t, 3> expected_dimensions = {BrdfTable::theta_half_cells, BrdfTable::theta_diff_cells,
                                                        BrdfTable::phi_diff_cells};

// The file is little-endian whatever the machine: numbers are assembled from their bytes.
template <typename Unsigned>
Unsigned load(const uint8_t* bytes) {
    Unsigned value = 0;
    for (size_t i = 0; i < sizeof(Unsigned); ++i) value |= Unsigned(bytes[i]) << (8 * i);
    return value;
}

template <typename Unsigned>
void store(uint8_t* bytes, Unsigned value) {
    for (size_t i = 0; i < sizeof(Unsigned); ++i) bytes[i] = uint8_t(value >> (8 * i));
}

double load_double(const uint8_t* bytes) {
    const uint64_t bits = load<uint64_t>(bytes);
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

void store_double(uint8_t* bytes, double value) {
    uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    store(bytes, bits);
}

std::string describe(const std::array<int32_t, 3>& dimensions) {
    return text("(", dimensions[0], ", ", dimensions[1], ", ", dimensions[2], ")");
}

void check_header(const std::vector<uint8_t>& bytes, const std::string& name) {
    std::array<int32_t, 3> dimensions;
    for (size_t i = 0; i < 3; ++i) dimensions[i] = int32_t(load<uint32_t>(bytes.data() + i * sizeof(int32_t)));
    if (dimensions == expected_dimensions) return;

    const char* trouble = "other dimensions";
    if (std::is_permutation(dimensions.begin(), dimensions.end(), expected_dimensions.begin()))
        trouble = "the right dimensions in the wrong order";
    else if (*std::min_element(dimensions.begin(), dimensions.end()) < 0)
        trouble = "a negative dimension";
    throw Error(LB_ERROR_FORMAT, text(name, ": MERL header ", describe(dimensions), " has ", trouble, "; expected ",
                                      describe(expected_dimensions), " cells of theta_half, theta_diff, phi_diff"));
}

void check_size(const std::vector<uint8_t>& bytes, const std::string& name) {
    if (bytes.size() == file_bytes) return;
    throw Error(LB_ERROR_FORMAT, text(name, ": MERL file is ", bytes.size() < file_bytes ? "truncated" : "too long",
                                      ": expected ", file_bytes, " bytes, found ", bytes.size()));
}

[[noreturn]] void reject_cell(lb_result code, const std::string& name, size_t cell, size_t channel, double value,
                              const char* why) {
    const size_t phi_diff = cell % BrdfTable::phi_diff_cells;
    const size_t theta_diff = cell / BrdfTable::phi_diff_cells % BrdfTable::theta_diff_cells;
    const size_t theta_half = cell / BrdfTable::phi_diff_cells / BrdfTable::theta_diff_cells;
    throw Error(code, text(name, ": cell theta_half ", theta_half, ", theta_diff ", theta_diff, ", phi_diff ", phi_diff,
                           ", channel ", channel_name[channel], " holds ", value, ", which ", why));
}

// One cell in 1/steradian; -1 in all channels where any of them is negative.
std::array<float, 3> parse_cell(const std::vector<uint8_t>& bytes, size_t cell, const std::string& name) {
    std::array<float, 3> rgb;
    bool measured = true;
    for (size_t channel = 0; channel < 3; ++channel) {
        const double stored = load_double(&bytes[header_bytes + (channel * cell_count + cell) * value_bytes]);
        if (!std::isfinite(stored)) reject_cell(LB_ERROR_FORMAT, name, cell, channel, stored, "is not finite");
        const double scaled = stored * channel_scale[channel];
        if (scaled > double(largest_reflectance))
            reject_cell(LB_ERROR_FORMAT, name, cell, channel, stored, "exceeds 1e9 per steradian after scaling");
        rgb[channel] = float(scaled);
        measured = measured && scaled >= 0;
    }
    return measured ? rgb : std::array<float, 3>{-1, -1, -1};
}

}  // namespace

BrdfTable parse_merl(const std::vector<uint8_t>& bytes, const std::string& name) {
    if (bytes.size() >= header_bytes) check_header(bytes, name);
    check_size(bytes, name);
    BrdfTable table;
    table.rgb.resize(cell_count * 3);
    for (size_t cell = 0; cell < cell_count; ++cell) {
        const std::array<float, 3> rgb = parse_cell(bytes, cell, name);
        std::copy(rgb.begin(), rgb.end(), &table.rgb[cell * 3]);
    }
    return table;
}

BrdfTable read_merl(const std::string& path) {
    return parse_merl(read_file(path, file_bytes), path);
}

void write_merl(const std::string& path, const BrdfTable& table) {
    if (table.rgb.size() != cell_count * 3)
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text(path, ": table has ", table.rgb.size(), " values, expected ", cell_count * 3));
    std::vector<uint8_t> bytes(file_bytes);
    for (size_t i = 0; i < 3; ++i) store(&bytes[i * sizeof(int32_t)], uint32_t(expected_dimensions[i]));
    for (size_t cell = 0; cell < cell_count; ++cell) {
        for (size_t channel = 0; channel < 3; ++channel) {
            const double value = table.rgb[cell * 3 + channel];
            if (!std::isfinite(value))
                reject_cell(LB_ERROR_INVALID_ARGUMENT, path, cell, channel, value, "is not finite");
            store_double(&bytes[header_bytes + (channel * cell_count + cell) * value_bytes],
                         value / channel_scale[channel]);
        }
    }
    write_file(path, bytes);
}

}  // namespace lightband::io
