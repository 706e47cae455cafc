// The (0,2)-sequence of Sobol's first two dimensions: every aligned block of 2^k points puts one point into each
// elementary interval of area 2^-k.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"

namespace lightband {

// Bits of the two coordinates, most significant first: coordinate = bits * 2^-32.
struct SequencePoint {
    uint32_t x, y;
};

inline SequencePoint sequence_point(uint32_t index) {
    SequencePoint point{0, 0};
    uint32_t vx = 1u << 31, vy = 1u << 31;  // direction numbers: van der Corput, and the primitive polynomial x + 1
    for (; index != 0; index >>= 1) {
        if (index & 1) {
            point.x ^= vx;
            point.y ^= vy;
        }
        vx >>= 1;
        vy ^= vy >> 1;
    }
    return point;
}

inline Vec2 to_unit(const SequencePoint& point) { return {point.x * 0x1p-32, point.y * 0x1p-32}; }

}  // namespace lightband
