// An array in host memory that a buffer of the C interface points into.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "lightband/lightband.h"

namespace lightband {

struct HostArray {
    uint32_t type = LB_TYPE_FLOAT32;
    std::vector<uint64_t> shape;  // rows first; tightly packed
    const char* unit = "";
    std::vector<uint8_t> bytes;

    static uint32_t element_size(uint32_t type) { return type == LB_TYPE_UINT8 ? 1 : 4; }

    template <typename T>
    static HostArray of(uint32_t type, std::vector<uint64_t> shape, const char* unit, const std::vector<T>& values) {
        HostArray array{type, std::move(shape), unit, std::vector<uint8_t>(values.size() * sizeof(T))};
        if (!values.empty()) std::memcpy(array.bytes.data(), values.data(), array.bytes.size());
        return array;
    }
    const float* floats() const { return reinterpret_cast<const float*>(bytes.data()); }
};

}  // namespace lightband
