// What interpolation over directions will cost, before a sample is drawn (docs/decisions/0012).
#pragma once

#include "passes/covered.h"
#include "passes/predict.h"
#include "picture/settings.h"
#include "picture/tiles.h"

namespace lightband::passes {

// stride: of what passes::mirror_cells sorted. tolerance: by how much, relatively, the pilots may contradict interpolation.
std::vector<ForeseenTile> foresee(gl::Device& device, size_t slots, const std::vector<Lamp>& lamps, const Forecast& forecast,
                                  double tolerance, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
                                  const Prediction& prediction, uint32_t stride);

}  // namespace lightband::passes
