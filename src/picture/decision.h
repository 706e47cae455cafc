// What was decided for a pixel; the original is shaders/decision.glsl.
#pragma once

#include <cstdint>

namespace lightband {

constexpr uint8_t first_bin = 2, validation_bit = 128;
inline bool is_interpolated(uint8_t decision) { return decision == 1; }
inline bool is_shaded(uint8_t decision) { return (decision & ~validation_bit) >= first_bin; }
inline bool is_validation(uint8_t decision) { return (decision & validation_bit) != 0; }

// The lattice on which a pixel first appears: spacing 2^level (shaders/lattice.glsl).
inline uint32_t lattice_level(uint32_t x, uint32_t y, uint32_t coarsest) {
    uint32_t level = 0;
    while (level < coarsest && ((x | y) >> level & 1) == 0) ++level;
    return level;
}

}  // namespace lightband
