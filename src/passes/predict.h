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

// Bandwidth and variance of every pixel (shaders/bandwidth.glsl).
void predict(gl::Device& device, const Scene& scene, const Scene::Slots& slots, const SlotTable& slot_of,
             const Settings& settings, uint32_t width, uint32_t height, const GBuffer& gbuffer, const Prediction& target);

// What a frame's prediction amounts to, over its covered pixels.
struct Forecast {
    double mean_radiance = 0;       // luminance
    double relative_deviation = 0;  // mean of one light sample's standard deviation over the pixel's radiance
};
Forecast forecast(gl::Device& device, const GBuffer& gbuffer, const Prediction& prediction, uint32_t width, uint32_t height);

// The factor on bandwidth under which linear interpolation errs about as much as the samples' noise; settings may fix it.
double bandwidth_scale(const Settings& settings, const Forecast& forecast);

// Levels (eq. 11) and relative variances with their min and max pyramids (shaders/pyramid.glsl).
void pyramids(gl::Device& device, const Forecast& forecast, const Settings& settings, const GBuffer& gbuffer, uint32_t width,
              uint32_t height, const Prediction& target);

}  // namespace lightband::passes
