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

Covered covered(const gl::Functions& gl, const GBuffer& gbuffer, uint32_t width, uint32_t height, uint32_t coarsest_level);

// Runs the current program, which includes covered.glsl, over a part of the list; stride: over every so manieth of it, by a program that
// defines STRIDE.
void dispatch_covered(const gl::Functions& gl, const gl::Program& program, const Covered& covered, const Covered::Part& part,
                      uint32_t stride = 1);

}  // namespace lightband::passes
