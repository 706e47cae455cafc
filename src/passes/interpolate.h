// Section 3.2: the pixels that are not shaded take their values from those that are.
#pragma once

#include <cstdint>
#include <vector>

#include "passes/covered.h"
#include "passes/predict.h"
#include "picture/settings.h"

namespace lightband::passes {

// From pixels beside them, lattice by lattice (shaders/upsample.glsl); or from those that mirror the eye towards nearby directions
// (shaders/interpolate.glsl): by what the prediction holds. At shaded pixels, what interpolation would give is only compared.
void interpolate(gl::Device& device, const Settings& settings, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
                 const Prediction& prediction, const Shading& target);

// Afterwards, and once: makes shaded pixels show a mean of their own values and the interpolated ones; in the image, pixels of the finest
// lattice alone. neighbour_parts: of the interpolated value, in 255ths, for each pixel of the picture (frame/combine.h).
void combine(gl::Device& device, const Settings& settings, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
             const Prediction& prediction, const std::vector<uint8_t>& neighbour_parts, uint32_t width, const Shading& target);

}  // namespace lightband::passes
