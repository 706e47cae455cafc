// An array in host memory that a buffer of the C interface points into.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "lightband/lightband.h"

namespace lightband {

struct HostArray {
    uint32_t type = LB_TYPE_FLOAT32;
    std::vector<uint64_t> shape;  // rows first; tightly packed
    const char* unit = "";
    std::shared_ptr<const void> elements;  // keeps the memory
    size_t size = 0;                       // elements

    static uint32_t element_size(uint32_t type) { return type == LB_TYPE_UINT8 ? 1 : 4; }

    // Takes the values as they are, without a copy.
    template <typename T>
    static HostArray of(uint32_t type, std::vector<uint64_t> shape, const char* unit, std::vector<T> values) {
        const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
        return {type, std::move(shape), unit, std::shared_ptr<const void>(owner, owner->data()), owner->size()};
    }
    template <typename T>
    const T* as() const {
        return static_cast<const T*>(elements.get());
    }
};

}  // namespace lightband
