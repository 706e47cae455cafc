// What a shaded pixel that might also be interpolated shows: its own value joined with the interpolated one, each
// weighted by its error.
#pragma once

#include "frame/estimate.h"

namespace lightband {

// RoundPixels::neighbour_part of a round as read back. width: pixels of a row; coarsest: level of the coarsest lattice;
// frames: over which the picture will be a mean.
std::vector<uint8_t> neighbour_parts(const RoundPixels& pixels, const ControlSet& control, const Tiles& tiles,
                                     uint32_t width, uint32_t coarsest, uint32_t frames);

}  // namespace lightband
