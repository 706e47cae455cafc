// What a few pixels show, without reading the others back.
#pragma once

#include "passes/shading_list.h"

namespace lightband::passes {

struct Gathered {
    float rgb[3], square;    // radiance; mean of its samples' squared luminances
    float spread, expected;  // half the difference of its replicates' luminances; luminance as predicted, or 0
    float unused[2];         // of the shader's vec4
};

// prediction: null where nothing was predicted. One for each of the list's pixels, in its order.
std::vector<Gathered> gather(gl::Device& device, const ShadingList& list, const Shading& shading,
                             const Prediction* prediction);

}  // namespace lightband::passes
