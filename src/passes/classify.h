// Which pixels are shaded and with how many samples; the compacted list of them.
#pragma once

#include "assets/scene.h"
#include "passes/predict.h"
#include "passes/uniforms.h"
#include "picture/budget.h"
#include "picture/settings.h"
#include "picture/targets.h"

namespace lightband::passes {

struct Counts {
    uint32_t bent = 0, saturated = 0;
    std::vector<uint32_t> histogram;  // (slot * 2 + whether a former round shaded it) * budget_bins + bin

    Histogram bins() const;        // over all slots
    Histogram new_bins() const;  // of what no former round shaded
};

// By what pixels are decided, beside what was predicted. lamps: across whose horizons nothing is interpolated. chosen: of those that
// might be interpolated, which are shaded all the same. tolerance: shaders/contrast.glsl. previous_bins: of the pixels that former rounds
// shaded; empty in the first. new_pixel_steps: how many bins the others lie above what prediction says, since those turned out to need more.
struct Criteria {
    const Settings& settings;
    const std::vector<Lamp>& lamps;
    ChosenPixels chosen;
    double tolerance;
    const std::vector<uint8_t>& previous_bins;
    int new_pixel_steps;
};

// Decides every pixel. prediction: null in a reference frame, where all covered pixels are shaded alike.
Counts classify(gl::Device& device, const SlotTable& slot_of, size_t slots, const Criteria& criteria, const Forecast& forecast,
                uint32_t width, const Covered& covered, const GBuffer& gbuffer, const Prediction* prediction, const Shading& target);

// The pixels to shade: slot by slot, those of former rounds apart, by falling sample count.
struct ShadingList {
    gl::Buffer entries;                // y << 16 | x
    gl::Texture entries_texture;
    Budget samples;                    // of each bin
    struct Run {
        uint32_t pixels, samples;      // of each
    };
    struct Part {
        uint32_t slot, first;          // entries of one material
        std::vector<Run> runs;         // in their order, by falling samples
        uint32_t rounds() const;       // dispatches that its longest pixels need
        uint32_t pixels(uint32_t round) const;                           // that have samples left in it
        uint64_t samples(uint32_t round, uint32_t first_pixels) const;   // that so many of them draw in it
    };
    std::vector<Part> parts;
    uint64_t pixels = 0;               // all that are shaded, those of former rounds included
    uint64_t total_samples = 0;        // at most; what former rounds drew is not taken off
};

// Samples that one invocation draws in one dispatch. A software renderer may end loops after 65,535 iterations (counting inner
// loops, which the shading loop has not more than eight of; a cut looks at 64 x 511 parts at most).
constexpr uint32_t part_samples = 4096;

// Pixels (y << 16 | x) of each slot, all with the same number of samples; it needs no decisions.
ShadingList even_list(gl::Device& device, const std::vector<std::vector<uint32_t>>& pixels_of_slot, uint32_t samples);

ShadingList shading_list(gl::Device& device, const SlotTable& slot_of, const Counts& counts, const Budget& budget,
                         const Covered& covered, const GBuffer& gbuffer, const Shading& target);

}  // namespace lightband::passes
