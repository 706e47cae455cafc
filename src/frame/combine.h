// What a shaded pixel that might also be interpolated shows: its own value joined with the interpolated one, by what either errs.
#pragma once

#include "frame/estimate.h"

namespace lightband {

// RoundPixels::neighbour_part of a round as read back. width: pixels of a row; coarsest: level of the coarsest lattice of interpolation in
// the image, 0 over directions; frames: over which the picture will be a mean.
std::vector<uint8_t> neighbour_parts(const RoundPixels& pixels, const Audit& audit, const Tiles& tiles, uint32_t width, uint32_t coarsest,
                                     uint32_t frames);

}  // namespace lightband
