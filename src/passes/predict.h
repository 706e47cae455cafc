// Section 3.1: fills the bandwidth buffer and builds its pyramids.
#pragma once

#include "frame/settings.h"
#include "frame/targets.h"
#include "scene/scene.h"

namespace lightband::passes {

// Which BRDF slot each instance number + 1 has, for shaders.
struct SlotTable {
    gl::Buffer buffer;
    gl::Texture texture;
};
SlotTable slot_table(const gl::Functions& gl, const Scene::Slots& slots);

// Bandwidth, variance and level of every pixel (shaders/bandwidth.glsl). Returns the sum of predicted mean luminance over the
// frame, from which the caller takes the mean.
double predict(gl::Device& device, const Scene& scene, const Scene::Slots& slots, const SlotTable& slot_of,
               const Settings& settings, uint32_t width, uint32_t height, const GBuffer& gbuffer, const Prediction& target);

// The min pyramid of levels and the max pyramid of relative variances (shaders/pyramid.glsl).
void pyramids(gl::Device& device, double mean_radiance, uint32_t width, uint32_t height, const Prediction& target);

}  // namespace lightband::passes
