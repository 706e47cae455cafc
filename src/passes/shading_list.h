// The compacted list of the pixels to shade.
#pragma once

#include "passes/classify.h"

namespace lightband::passes {

// The pixels to shade: slot by slot, those of former rounds apart, by falling sample count.
struct ShadingList {
    gl::Buffer entries;  // y << 16 | x
    gl::Texture entries_texture;
    Budget samples;  // of each bin
    struct Run {
        uint32_t pixels, samples;  // of each
    };
    struct Part {
        uint32_t slot, first;   // entries of one material
        std::vector<Run> runs;  // in their order, by falling samples
        // each: samples that a pixel takes in one dispatch, a round of them.
        uint32_t rounds(uint32_t each) const;                  // that its longest pixels need
        uint32_t pixels(uint32_t round, uint32_t each) const;  // that have samples left in it
        uint64_t samples(uint32_t round, uint32_t first_pixels,
                         uint32_t each) const;  // that so many of them take in it
    };
    std::vector<Part> parts;
    uint64_t pixels = 0;         // all that are shaded, those of former rounds included
    uint64_t total_samples = 0;  // at most; what former rounds drew is not taken off
};

// Samples that one invocation takes in one dispatch at most. A software renderer may end loops after 65,535 iterations
// (counting inner loops, of which the shading loop has not more than eight, and those of the lights; a cut looks at 64
// x 511 parts at most).
constexpr uint32_t part_samples = 4096, most_iterations = 65535;
inline uint32_t part_samples_beside(uint32_t loops_of_lights) {
    uint32_t samples = part_samples;
    while (samples > 2 && samples * (8 + loops_of_lights) > most_iterations) samples /= 2;
    return samples;
}

// Pixels (y << 16 | x) of each slot, all with the same number of samples; it needs no decisions.
ShadingList even_list(gl::Device& device, const std::vector<std::vector<uint32_t>>& pixels_of_slot, uint32_t samples);

ShadingList shading_list(gl::Device& device, const SlotTable& slot_of, const Counts& counts, const Budget& budget,
                         const Covered& covered, const GBuffer& gbuffer, const Shading& target);

}  // namespace lightband::passes
