// Section 3.2: the pixels that are not shaded take their values from those that are.
#pragma once

#include "passes/covered.h"
#include "passes/predict.h"
#include "picture/settings.h"

namespace lightband::passes {

// From pixels beside them, lattice by lattice (shaders/upsample.glsl); or from those that mirror the eye towards nearby directions
// (shaders/interpolate.glsl): by what the prediction holds.
void interpolate(gl::Device& device, const Settings& settings, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
                 const Prediction& prediction, const Shading& target);

}  // namespace lightband::passes
