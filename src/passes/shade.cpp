#include "passes/shade.h"

#include <algorithm>

#include "gl/dispatch.h"
#include "passes/gbuffer.h"

namespace lightband::passes {
namespace {

// Samples of one dispatch: about half a second on a software renderer of two cores, so that progress moves and
// cancelling works; some milliseconds on a graphics processor, beside which the wait between two dispatches is short.
constexpr uint64_t dispatch_samples = 1u << 21;

// Pixels of one workgroup: no fewer than most graphics processors run at a time, few enough that some dozen control
// pixels make more than one.
constexpr uint32_t group = 32;

std::string definitions(const Lights& lights, const Material& material, const Settings& settings, uint32_t each) {
    return material.definitions(settings.brdf_lookup()) +
           text("\nSHADE_GROUP ", group, "\nBINS ", budget_bins, "\nPART_SAMPLES ", each, "\nLEAST_RESAMPLING_FACTOR ",
                least_resampling_factor, settings.sequence() == Sequence::random ? "u\nSEQUENCE_RANDOM\n" : "u\n",
                lights.definitions(LightPass::shade, settings));
}

}  // namespace

void shade(gl::Device& device, const Lights& lights, const Scene::Slots& slots, const Settings& settings,
           const Seeds& seeds, const ShadingList& list, const GBuffer& gbuffer, const Shading& target,
           const Drawn& drawn) {
    const gl::Functions& gl = device.gl();
    const uint32_t each = part_samples_beside(lights.loops_per_sample());
    uint64_t done = 0;
    for (const ShadingList::Part& part : list.parts) {
        const Material& material = *slots.materials[part.slot];
        const gl::Program& program = device.compute("shade", definitions(lights, material, settings, each));
        program.set("seed", seeds.samples);
        program.set_array("samples", list.samples.data(), int32_t(budget_bins));
        material.bind(program);
        if (lights.needs_importance(settings)) material.bind_importance();
        bind_texture(gl, 1, list.entries_texture);
        bind_surfaces(gl, program, gbuffer);
        bind_texture(gl, 7, target.decision);
        lights.bind(LightPass::shade, settings, seeds.map_points, program);
        program.use();
        bind_image(gl, 0, target.radiance, GL_RGBA32F);
        bind_image(gl, 1, target.sample_count, GL_R32UI);
        bind_image(gl, 2, target.spread, GL_RGBA32F);
        for (uint32_t round = 0; round < part.rounds(each); ++round) {
            program.set("part", round);
            const uint32_t all = part.pixels(round, each), most_samples = std::min(each, part.runs.front().samples);
            const uint32_t pixels = std::clamp(uint32_t(dispatch_samples / most_samples), group, most_groups * group);
            for (uint32_t first = 0; first < all; first += pixels) {
                const uint32_t count = std::min(pixels, all - first);
                program.set("first", part.first + first);
                program.set("count", count);
                gl.DispatchCompute((count + group - 1) / group, 1, 1);
                gl.MemoryBarrier(everything);
                gl.Finish();
                drawn(done + part.samples(round, first + count, each));
            }
            done += part.samples(round, all, each);
        }
    }
}

void background(gl::Device& device, const Lights& lights, const Settings& settings, uint32_t width, uint32_t height,
                const GBuffer& gbuffer, const Shading& target) {
    const gl::Functions& gl = device.gl();
    const gl::Program& program = device.compute("background", lights.definitions(LightPass::background, settings));
    set_rays(program, gbuffer.rays);
    program.use();
    lights.bind(LightPass::background, settings, 0, program);
    bind_texture(gl, 1, gbuffer.material);
    bind_image(gl, 0, target.radiance, GL_RGBA32F);
    dispatch_pixels(gl, width, height);
}

}  // namespace lightband::passes
