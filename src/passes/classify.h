// Decides for every covered pixel whether it is shaded, and with how many samples, or interpolated.
#pragma once

#include "assets/scene.h"
#include "lights/kinds.h"
#include "passes/predict.h"
#include "passes/uniforms.h"
#include "picture/budget.h"
#include "picture/settings.h"
#include "picture/targets.h"

namespace lightband::passes {

struct Counts {
    uint32_t bent = 0, saturated = 0;
    std::vector<uint32_t> histogram;  // (slot * 2 + whether a former round shaded it) * budget_bins + bin

    Histogram bins() const;      // over all slots
    Histogram new_bins() const;  // of what no former round shaded
};

// By what pixels are decided, beside what was predicted. lights: nothing is interpolated across the line where one
// sets. chosen: of those that might be interpolated, which are shaded all the same. tolerance: shaders/contrast.glsl.
// previous_bins: of the pixels that former rounds shaded; empty in the first. new_pixel_steps: how many bins the others
// lie above what prediction says, since those turned out to need more.
struct Criteria {
    const Settings& settings;
    const Lights& lights;
    ChosenPixels chosen;
    double tolerance;
    const std::vector<uint8_t>& previous_bins;
    int new_pixel_steps;
};

// Decides every pixel. prediction: null in a reference frame, where all covered pixels are shaded alike.
Counts classify(gl::Device& device, const SlotTable& slot_of, size_t slots, const Criteria& criteria,
                const Forecast& forecast, uint32_t width, const Covered& covered, const GBuffer& gbuffer,
                const Prediction* prediction, const Shading& target);

}  // namespace lightband::passes
