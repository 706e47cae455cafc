#include "passes/mirror_cells.h"

#include <algorithm>
#include <cmath>

#include "gl/dispatch.h"
#include "passes/gbuffer.h"
#include "passes/uniforms.h"

namespace lightband::passes {

void mirror_cells(gl::Device& device, const Scales& scales, const Witnesses& witnesses,
                  const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer, const Shading& shading,
                  const Prediction& prediction, uint32_t stride) {
    const MirrorCells& target = *prediction.mirrors;
    const gl::Functions& gl = device.gl();
    const gl::Buffer scale_buffer(gl, std::max<size_t>(scales.of.size(), 1) * sizeof(float), scales.of.data());
    const gl::Texture scales_texture = gl::Texture::of_buffer(gl, GL_R32F, scale_buffer);
    for (const Table* table : {&target.claims, &target.counts, &target.occupants}) table->buffer.clear();

    const auto run = [&](const char* name, const auto& bind) {
        const gl::Program& program = device.compute(name, target.definitions() + "\nSTRIDE");
        witnesses.set(program);
        program.use();
        bind_surfaces(gl, program, gbuffer);
        bind_texture(gl, 2, gbuffer.material);
        bind_texture(gl, 3, slot_of.texture);
        bind_image(gl, 1, shading.sample_count, GL_R32UI);
        bind(program);
        dispatch_covered(gl, program, covered, covered.all, stride);
    };
    // Of fewer pixels, cells hold as many where they are as much wider.
    const float wider = float(1 / std::sqrt(double(stride)));
    run("claim_cells", [&](const gl::Program& program) {
        program.set("wider", wider);
        program.set("first_scale", scales.first);
        bind_texture(gl, 4, prediction.reflected);
        bind_texture(gl, 5, scales_texture);
        bind_texture(gl, 6, prediction.prediction);
        bind_image(gl, 0, target.cells, GL_R32UI);
        bind_image(gl, 2, target.mirrors.texture, GL_RGBA32UI);
        bind_storage(gl, 0, target.claims.buffer);
        bind_storage(gl, 1, target.counts.buffer);
    });
    run("fill_cells", [&](const gl::Program&) {
        bind_texture(gl, 4, target.cells);
        bind_texture(gl, 5, target.claims.texture);
        bind_texture(gl, 6, target.mirrors.texture);
        bind_storage(gl, 0, target.occupants.buffer);
    });
}

}  // namespace lightband::passes
