// Section 3.2: the pixels that are not shaded take their values from those that are.
#pragma once

#include <cstdint>
#include <vector>

#include "passes/covered.h"
#include "picture/settings.h"
#include "picture/targets.h"

namespace lightband::passes {

// Interpolates from the shaded pixels beside them, lattice by lattice. At shaded pixels, what interpolation would give
// is only compared.
void upsample(gl::Device& device, const Settings& settings, const Covered& covered, const Pyramids& pyramids,
              const Shading& target);

// Afterwards, and once: makes shaded pixels of the finest lattice show a mean of their own values and the interpolated
// ones. neighbour_parts: of the interpolated value, in 255ths, for each pixel of the picture (frame/combine.h).
void combine(gl::Device& device, const Covered& covered, const Pyramids& pyramids,
             const std::vector<uint8_t>& neighbour_parts, uint32_t width, const Shading& target);

}  // namespace lightband::passes
