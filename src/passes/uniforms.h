// Uniforms of shaders/chosen_pixels.glsl.
#pragma once

#include <algorithm>

#include "gl/objects.h"
#include "sampling/sequence.h"

namespace lightband::passes {

// Pixels that are shaded although they might be interpolated (shaders/chosen_pixels.glsl): parts of all, 0 .. 1, chosen
// by chance. Control pixels are the same in every round (frame/control_set.h); validation pixels are others in each,
// since the levels were chosen by the errors of those before them.
struct ChosenPixels {
    double validation = 0, control = 0;
    uint32_t seed = 0, round = 1;

    void set(const gl::Program& program) const {
        const auto of_all = [](double some) { return uint32_t(std::max(some * 0x1p32 - 1, 0.0)); };
        program.set("validation_part", of_all(std::max(validation, control)));
        program.set("validation_seed", seed + golden_ratio * (round - 1));
        program.set("control_part", of_all(control));
        program.set("control_seed", seed);
    }
};

}  // namespace lightband::passes
