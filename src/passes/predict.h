// Section 3.1: fills the bandwidth buffer and builds its pyramids.
#pragma once

#include "assets/scene.h"
#include "lights/kinds.h"
#include "passes/covered.h"
#include "picture/forecast.h"
#include "picture/settings.h"
#include "picture/targets.h"
#include "picture/tiles.h"

namespace lightband::passes {

// Which BRDF slot each instance number + 1 has, for shaders.
struct SlotTable {
    gl::Buffer buffer;
    gl::Texture texture;
};
SlotTable slot_table(const gl::Functions& gl, const Scene::Slots& slots);

// Bandwidth and variance of every pixel (shaders/bandwidth.glsl).
void predict(gl::Device& device, const Scene& scene, const Lights& lights, const Scene::Slots& slots,
             const SlotTable& slot_of, const Settings& settings, uint32_t height, const Covered& covered,
             const GBuffer& gbuffer, const Prediction& target);

Forecast forecast(gl::Device& device, const Covered& covered, const Prediction& prediction, uint32_t height);

// Levels (eq. 11) and, where target holds them, relative variances with their min and max pyramids
// (shaders/levels.glsl, pyramid.glsl). scales: of tiles of the picture (picture/tiles.h).
void pyramids(gl::Device& device, const Forecast& forecast, const Scales& scales, const Settings& settings,
              const Covered& covered, uint32_t width, uint32_t height, const Prediction& prediction,
              const Pyramids& target);

}  // namespace lightband::passes
