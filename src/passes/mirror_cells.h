// Sorts the covered pixels into cells of mirror directions, each as fine as its bandwidth asks for, and chooses one of each cell to be
// shaded: what interpolation over directions needs (docs/decisions/0012).
#pragma once

#include "frame/settings.h"
#include "passes/covered.h"
#include "passes/predict.h"

namespace lightband::passes {

// scales: factor on the bandwidth in each tile of directions (frame/tiles.h). witnesses: the part of pixels that is drawn by chance.
// shading: what former rounds shaded, which speaks first. stride: of the covered pixels, every so manieth, in cells as much wider.
void mirror_cells(gl::Device& device, const std::vector<float>& scales, double witnesses, const Settings& settings,
                  const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer, const Shading& shading,
                  const Prediction& prediction, uint32_t stride = 1);

}  // namespace lightband::passes
