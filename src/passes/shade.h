// Sections 3.2 and 3.3: the shading integral of the listed pixels, interpolation of the others, and the background.
#pragma once

#include <functional>

#include "passes/classify.h"

namespace lightband::passes {

// The points of one block of the (0,2)-sequence on a device.
struct SequenceTable {
    gl::Buffer buffer;
    gl::Texture texture;
    explicit SequenceTable(const gl::Functions& gl);
};

// Called after each dispatch with the samples drawn so far; it throws to cancel.
using Drawn = std::function<void(uint64_t samples)>;

void shade(gl::Device& device, const Scene& scene, const Scene::Slots& slots, const Settings& settings, uint32_t seed,
           const SequenceTable& sequence, const ShadingList& list, bool first_round, const GBuffer& gbuffer, const Shading& target,
           const Drawn& drawn);

void upsample(gl::Device& device, const Camera& camera, const Settings& settings, const Covered& covered, const GBuffer& gbuffer,
              const Prediction& prediction, const Shading& target);

void background(gl::Device& device, const Scene& scene, uint32_t width, uint32_t height, const GBuffer& gbuffer,
                const Shading& target);

}  // namespace lightband::passes
