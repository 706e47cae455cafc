#include "passes/interpolate.h"

#include "gl/dispatch.h"
#include "passes/gbuffer.h"

namespace lightband::passes {

void interpolate(gl::Device& device, const Settings& settings, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
                 const Prediction& prediction, const Shading& target) {
    const gl::Functions& gl = device.gl();
    const gl::Program& program =
        prediction.mirrors ? device.compute("interpolate", prediction.mirrors->definitions()) : device.compute("upsample");
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
    for (uint32_t level = settings.coarsest_level(); level-- > 0;) {
        program.set("level", int32_t(level));
        dispatch_covered(gl, program, covered, covered.levels[level]);
    }
}

}  // namespace lightband::passes
