// Points that fill a square evenly: the (0,2)-sequence of Sobol's first two dimensions, of which every aligned block of 2^k points
// puts one into each elementary interval of area 2^-k; and the lattice of the golden ratio, for any number of points, under which
// neighbours lie about equally far apart.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"

namespace lightband {

constexpr uint32_t golden_ratio = 2654435769u;  // its fraction in 32 bits

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

// Point i of n: shaders/shade.glsl's, under the shift that centres it.
inline Vec2 centred_lattice_point(uint32_t i, uint32_t n) {
    return Vec2((i + 0.5) / n, (i * golden_ratio ^ 1u << 31) * 0x1p-32);
}

}  // namespace lightband
