// Uniforms that more than one pass sets: of shaders/lamps.glsl and chosen_pixels.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/text.h"
#include "gl/objects.h"
#include "sampling/lamps.h"
#include "sampling/sequence.h"

namespace lightband::passes {

// What shaders/lamps.glsl is compiled for, and reads.
inline std::string lamp_definitions(const std::vector<Lamp>& lamps) { return text("\nLAMPS ", lamps.size()); }
inline void set_lamps(const gl::Program& program, const std::vector<Lamp>& lamps) {
    for (size_t i = 0; i < lamps.size(); ++i)
        program.set(text("lamps[", i, "]").c_str(), {float(lamps[i].direction.x), float(lamps[i].direction.y),
                                                      float(lamps[i].direction.z), float(std::sin(lamps[i].size))});
}

// Pixels that are shaded although they might be interpolated (shaders/chosen_pixels.glsl): parts of all, 0 .. 1, chosen by chance. Control
// pixels are the same in every round (frame/control_set.h); validation pixels are others in each, since the levels were chosen by the errors
// of those before them.
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
