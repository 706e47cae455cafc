// The covered pixels as a list, so that passes cost nothing where no mesh is seen.
#pragma once

#include "picture/targets.h"

namespace lightband::passes {

// Sorted by the lattice on which a pixel first appears (shaders/lattice.glsl), coarsest first.
struct Covered {
    struct Part {
        uint32_t first = 0, count = 0;
    };
    Part all;
    std::vector<Part> levels;  // of each lattice, 0 .. coarsest
    gl::Buffer entries;        // y << 16 | x
    gl::Texture texture;
};

// material: what each pixel sees, for the host.
Covered covered(const gl::Functions& gl, const GBuffer& gbuffer, uint32_t width, uint32_t height,
                uint32_t coarsest_level, std::vector<uint8_t>* material);

// Runs the current program, which includes covered.glsl, over a part of the list.
void dispatch_covered(const gl::Functions& gl, const gl::Program& program, const Covered& covered,
                      const Covered::Part& part);

}  // namespace lightband::passes
