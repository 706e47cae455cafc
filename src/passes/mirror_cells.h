// Sorts the covered pixels into cells of mirror directions, each as fine as its bandwidth asks for, and chooses one of each cell to be
// shaded: what interpolation over directions needs (docs/decisions/0012).
#pragma once

#include "passes/covered.h"
#include "passes/predict.h"
#include "passes/uniforms.h"

namespace lightband::passes {

// scales: of tiles of directions (picture/tiles.h). witnesses: pixels that do not speak for others.
// shading: what former rounds shaded, which speaks first. stride: of the covered pixels, every so manieth, in cells as much wider.
void mirror_cells(gl::Device& device, const Scales& scales, const Witnesses& witnesses,
                  const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer, const Shading& shading,
                  const Prediction& prediction, uint32_t stride = 1);

}  // namespace lightband::passes
