// Section 3.3: the shading integral of the listed pixels; and the background.
#pragma once

#include <functional>

#include "passes/shading_list.h"

namespace lightband::passes {

// Called after each dispatch with the samples drawn so far; it throws to cancel.
using Drawn = std::function<void(uint64_t samples)>;

// What chance depends on. Directions of the map are drawn once for each seed.
struct Seeds {
    uint32_t samples, map_points;
};

void shade(gl::Device& device, const Lights& lights, const Scene::Slots& slots, const Settings& settings,
           const Seeds& seeds, const ShadingList& list, const GBuffer& gbuffer, const Shading& target,
           const Drawn& drawn);

// What pixels that see no mesh show of the lights.
void background(gl::Device& device, const Lights& lights, const Settings& settings, uint32_t width, uint32_t height,
                const GBuffer& gbuffer, const Shading& target);

}  // namespace lightband::passes
