// Uniforms that more than one pass sets: of shaders/lamps.glsl and witnesses.glsl.
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

// Pixels that are shaded whatever is decided for others (shaders/witnesses.glsl): parts of all, 0 .. 1, drawn by chance. Those that are
// audited are the same in every round (frame/audit.h); witnesses are others, as levels follow what those before them saw.
struct Witnesses {
    double part = 0, audited = 0;
    uint32_t seed = 0, round = 1;

    void set(const gl::Program& program) const {
        const auto of_all = [](double some) { return uint32_t(std::max(some * 0x1p32 - 1, 0.0)); };
        program.set("witnesses", of_all(std::max(part, audited)));
        program.set("witness_seed", seed + golden_ratio * (round - 1));
        program.set("audited", of_all(audited));
        program.set("audit_seed", seed);
    }
};

}  // namespace lightband::passes
