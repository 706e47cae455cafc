#include "passes/upsample.h"

#include "gl/dispatch.h"

namespace lightband::passes {
namespace {

const gl::Program& prepare(gl::Device& device, const char* definitions, const Pyramids& pyramids,
                           const Shading& target) {
    const gl::Functions& gl = device.gl();
    const gl::Program& program = device.compute("upsample", definitions);
    program.use();
    bind_texture(gl, 3, target.decision);
    bind_texture(gl, 4, target.sample_count);
    bind_image(gl, 0, target.radiance, GL_RGBA32F);
    bind_image(gl, 1, pyramids.weights, GL_RGBA16);
    bind_image(gl, 2, target.spread, GL_RGBA32F);
    return program;
}

}  // namespace

void upsample(gl::Device& device, const Settings& settings, const Covered& covered, const Pyramids& pyramids,
              const Shading& target) {
    const gl::Program& program = prepare(device, "", pyramids, target);
    for (uint32_t level = settings.coarsest_level(); level-- > 0;) {
        program.set("level", int32_t(level));
        dispatch_covered(device.gl(), program, covered, covered.levels[level]);
    }
}

// No pixel of the finest lattice is interpolated from another, so that none is read after it was written.
void combine(gl::Device& device, const Covered& covered, const Pyramids& pyramids,
             const std::vector<uint8_t>& neighbour_parts, uint32_t width, const Shading& target) {
    const gl::Functions& gl = device.gl();
    const uint32_t height = uint32_t(neighbour_parts.size() / width);
    const gl::Texture parts = gl::Texture::image(gl, GL_R8UI, width, height);
    parts.upload(width, height, GL_RED_INTEGER, GL_UNSIGNED_BYTE, neighbour_parts.data());
    const gl::Program& program = prepare(device, "COMBINE", pyramids, target);
    bind_texture(gl, 7, parts);
    program.set("level", int32_t(0));
    dispatch_covered(gl, program, covered, covered.levels[0]);
}

}  // namespace lightband::passes
