// What was decided for a pixel; the original is shaders/decision.glsl.
#pragma once

#include <cstdint>

namespace lightband {

constexpr uint8_t first_bin = 2, witness_bit = 128;
inline bool is_interpolated(uint8_t decision) { return decision == 1; }
inline bool is_shaded(uint8_t decision) { return (decision & ~witness_bit) >= first_bin; }
inline bool is_witness(uint8_t decision) { return (decision & witness_bit) != 0; }

}  // namespace lightband
