#include "passes/shade.h"

#include <algorithm>

#include "gl/dispatch.h"
#include "passes/gbuffer.h"

namespace lightband::passes {
namespace {

// Samples of one dispatch: about half a second on a software renderer of two cores, so that progress moves and cancelling works; some
// milliseconds on a graphics processor, beside which the wait between two dispatches is short.
constexpr uint64_t dispatch_samples = 1u << 21;

// Pixels of one workgroup: no fewer than most graphics processors run at a time, few enough that some dozen control pixels make more
// than one.
constexpr uint32_t group = 32;

std::string definitions(const Light& light, const Material& material, const Settings& settings) {
    std::string result = material.definitions(settings.brdf_lookup()) +
                         text("\nSHADE_GROUP ", group, "\nBINS ", budget_bins, "\nPART_SAMPLES ", part_samples, "\nLEAST_RESAMPLING_FACTOR ",
                              least_resampling_factor, "u");
    if (settings.sequence() == Sequence::random) result += "\nSEQUENCE_RANDOM";
    switch (settings.sampler()) {
        case Sampler::cut:
            result += text("\nSAMPLER_CUT\nFILTERED\nTRUNK_PARTS ", LightTree::trunks[0].count, "\nCOARSE_TRUNK_PARTS ",
                           LightTree::trunks[1].count, "\nTREE_DEPTH ", LightTree::depth, "u\nCEILING_WORTH ", Ceilings::worth, "\n",
                           FootprintLight::definitions(FootprintLight::Kind::below_ceilings));
            break;
        case Sampler::combined:
            result += text("\nSAMPLER_COMBINED\nMAP_POINTS ", MapPoints::count, "u\nMAP_CLUSTERS ", MapPoints::cluster_count,
                           "\nMAP_WORTH ", map_sample_worth);
            break;
        case Sampler::filtered:
            result += "\nFILTERED\n" + FootprintLight::definitions(FootprintLight::Kind::whole);
            break;
        case Sampler::brdf: break;
    }
    if (light.hides_light()) result += "\nHIDES_LIGHT";
    if (settings.environment_lookup() == Lookup::nearest) result += "\nENVIRONMENT_NEAREST";
    return result;
}

// The tables of the sampler, each made when first asked for.
void bind_sampler(const gl::Functions& gl, const Light& light, const Material& material, const Settings& settings, uint32_t seed,
                  const gl::Program& program) {
    const Lookup lookup = settings.environment_lookup();
    const Sampler sampler = settings.sampler();
    if (sampler == Sampler::filtered || sampler == Sampler::cut) {
        const FootprintLight& footprints =
            light.footprints(lookup, sampler == Sampler::cut ? FootprintLight::Kind::below_ceilings : FootprintLight::Kind::whole);
        program.set("mean_light", float(light.mean()));
        bind_texture(gl, 13, footprints.texture);
    }
    if (sampler == Sampler::cut) {
        const LightAbove& above = light.above(lookup);
        bind_texture(gl, 10, above.texture);
        bind_uniforms(gl, 0, above.trunk);
        material.bind_importance();
    }
    if (sampler == Sampler::combined) {
        const MapPoints& points = light.points(lookup, seed);
        bind_texture(gl, 10, points.texture);
        bind_uniforms(gl, 0, points.clusters);
        material.bind_importance();
    }
}

}  // namespace

void make_tables(const Scene& scene, const Scene::Slots& slots, const Settings& settings, uint32_t map_points_seed) {
    const Light& light = *scene.light;
    const Lookup lookup = settings.environment_lookup();
    const Sampler sampler = settings.sampler();
    if (sampler == Sampler::filtered) light.footprints(lookup, FootprintLight::Kind::whole);
    if (sampler == Sampler::cut) {
        light.footprints(lookup, FootprintLight::Kind::below_ceilings);
        light.above(lookup);
    }
    if (sampler == Sampler::combined) light.points(lookup, map_points_seed);
    if (sampler == Sampler::cut || sampler == Sampler::combined)
        for (const Material* material : slots.materials) material->bind_importance();
}

void shade(gl::Device& device, const Scene& scene, const Scene::Slots& slots, const Settings& settings, const Seeds& seeds,
           const ShadingList& list, const GBuffer& gbuffer, const Shading& target, const Drawn& drawn) {
    const gl::Functions& gl = device.gl();
    uint64_t done = 0;
    for (const ShadingList::Part& part : list.parts) {
        const Material& material = *slots.materials[part.slot];
        const gl::Program& program = device.compute("shade", definitions(*scene.light, material, settings));
        program.set("seed", seeds.samples);
        program.set_array("samples", list.samples.data(), int32_t(budget_bins));
        material.bind(program);
        bind_texture(gl, 0, scene.light->texture());
        bind_texture(gl, 1, list.entries_texture);
        bind_surfaces(gl, program, gbuffer);
        bind_texture(gl, 7, target.decision);
        bind_sampler(gl, *scene.light, material, settings, seeds.map_points, program);
        program.use();
        bind_image(gl, 0, target.radiance, GL_RGBA32F);
        bind_image(gl, 1, target.sample_count, GL_R32UI);
        bind_image(gl, 2, target.spread, GL_RGBA32F);
        for (uint32_t round = 0; round < part.rounds(); ++round) {
            program.set("part", round);
            const uint32_t all = part.pixels(round), most_samples = std::min(part_samples, part.runs.front().samples);
            const uint32_t pixels = std::clamp(uint32_t(dispatch_samples / most_samples), group, most_groups * group);
            for (uint32_t first = 0; first < all; first += pixels) {
                const uint32_t count = std::min(pixels, all - first);
                program.set("first", part.first + first);
                program.set("count", count);
                gl.DispatchCompute((count + group - 1) / group, 1, 1);
                gl.MemoryBarrier(everything);
                gl.Finish();
                drawn(done + part.samples(round, first + count));
            }
            done += part.samples(round, all);
        }
    }
}

void background(gl::Device& device, const Scene& scene, uint32_t width, uint32_t height, const GBuffer& gbuffer,
                Lookup lookup, const Shading& target) {
    const gl::Functions& gl = device.gl();
    const gl::Program& program = device.compute("background", lookup == Lookup::nearest ? "ENVIRONMENT_NEAREST" : "");
    set_rays(program, gbuffer.rays);
    program.use();
    bind_texture(gl, 0, scene.light->texture());
    bind_texture(gl, 1, gbuffer.material);
    bind_image(gl, 0, target.radiance, GL_RGBA32F);
    dispatch_pixels(gl, width, height);
}

}  // namespace lightband::passes
