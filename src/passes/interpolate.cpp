#include "passes/interpolate.h"

#include "gl/dispatch.h"
#include "passes/gbuffer.h"

namespace lightband::passes {
namespace {

void run(gl::Device& device, const Settings& settings, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
         const Prediction& prediction, bool combined, const Shading& target) {
    const gl::Functions& gl = device.gl();
    const gl::Program& program = prediction.mirrors
                                     ? device.compute("interpolate", text(prediction.mirrors->definitions(), combined ? "\nCOMBINE" : ""))
                                     : device.compute("upsample", combined ? "COMBINE" : "");
    program.use();
    bind_texture(gl, 3, target.decision);
    bind_texture(gl, 4, target.sample_count);
    bind_image(gl, 0, target.radiance, GL_RGBA32F);
    bind_image(gl, 2, target.spread, GL_RGBA32F);
    if (prediction.mirrors) {
        bind_surfaces(gl, program, gbuffer);
        bind_texture(gl, 2, gbuffer.material);
        bind_texture(gl, 5, slot_of.texture);
        bind_texture(gl, 6, prediction.mirrors->cells);
        bind_texture(gl, 11, prediction.mirrors->occupants.texture);
        bind_texture(gl, 12, prediction.mirrors->mirrors.texture);
        dispatch_covered(gl, program, covered, covered.all);
        return;
    }
    bind_image(gl, 1, prediction.pyramids->weights, GL_RGBA16);
    for (uint32_t level = combined ? 1 : settings.coarsest_level(); level-- > 0;) {
        program.set("level", int32_t(level));
        dispatch_covered(gl, program, covered, covered.levels[level]);
    }
}

}  // namespace

void interpolate(gl::Device& device, const Settings& settings, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
                 const Prediction& prediction, const Shading& target) {
    run(device, settings, slot_of, covered, gbuffer, prediction, false, target);
}

void combine(gl::Device& device, const Settings& settings, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
             const Prediction& prediction, const std::vector<uint8_t>& neighbour_parts, uint32_t width, const Shading& target) {
    const gl::Functions& gl = device.gl();
    const uint32_t height = uint32_t(neighbour_parts.size() / width);
    const gl::Texture parts = gl::Texture::image(gl, GL_R8UI, width, height);
    parts.upload(width, height, GL_RED_INTEGER, GL_UNSIGNED_BYTE, neighbour_parts.data());
    bind_texture(gl, 7, parts);
    // In the image, pixels of the finest lattice alone are written, of which none is another's parent. Over directions, a pixel's neighbours
    // may be written at the same time: all are interpolated from what was there before.
    gl::Texture before;
    if (prediction.mirrors) {
        before = gl::Texture::image(gl, GL_RGBA32F, width, height);
        gl.CopyImageSubData(target.radiance.name(), GL_TEXTURE_2D, 0, 0, 0, 0, before.name(), GL_TEXTURE_2D, 0, 0, 0, 0, GLsizei(width),
                            GLsizei(height), 1);
    }
    bind_image(gl, 3, prediction.mirrors ? before : target.radiance, GL_RGBA32F);
    run(device, settings, slot_of, covered, gbuffer, prediction, true, target);
}

}  // namespace lightband::passes
