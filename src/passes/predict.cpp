#include "passes/predict.h"

#include <algorithm>
#include <cmath>

#include "gl/dispatch.h"
#include "passes/gbuffer.h"

namespace lightband::passes {
namespace {

// The pilots of every material in one table, slot by slot; none where there is no light.
gl::Buffer all_pilots(const gl::Functions& gl, const Scene::Slots& slots, const Settings& settings, bool any_light) {
    std::vector<Pilot> all;
    for (const Material* material : slots.materials) {
        if (!any_light) break;
        const std::vector<Pilot>& own = material->pilots(settings.band_rule(), settings.pilots());
        all.insert(all.end(), own.begin(), own.end());
    }
    if (all.empty()) all.emplace_back();
    return gl::Buffer(gl, all.size() * sizeof(Pilot), all.data());
}

// Sum over the frame of what shaders/row_sums.glsl adds up; prepare: sets what it needs.
template <class Prepare>
double row_sums(gl::Device& device, uint32_t height, const char* definitions, Prepare prepare) {
    const gl::Functions& gl = device.gl();
    const gl::Buffer sums(gl, height * sizeof(float), nullptr);
    const gl::Program& program = device.compute("row_sums", definitions);
    prepare(program);
    program.use();
    bind_storage(gl, 0, sums);
    gl.DispatchCompute((height + 63) / 64, 1, 1);
    gl.MemoryBarrier(everything);
    std::vector<float> rows(height);
    sums.read(0, rows.size() * sizeof(float), rows.data());
    double total = 0;
    for (float row : rows) total += row;
    return total;
}

}  // namespace

SlotTable slot_table(const gl::Functions& gl, const Scene::Slots& slots) {
    std::vector<uint32_t> slot_of(1, 0);
    slot_of.insert(slot_of.end(), slots.of_instance.begin(), slots.of_instance.end());
    SlotTable table;
    table.buffer = gl::Buffer(gl, slot_of.size() * sizeof(uint32_t), slot_of.data());
    table.texture = gl::Texture::of_buffer(gl, GL_R32UI, table.buffer);
    return table;
}

void predict(gl::Device& device, const Scene& scene, const Lights& lights, const Scene::Slots& slots,
             const SlotTable& slot_of, const Settings& settings, uint32_t height, const Covered& covered,
             const GBuffer& gbuffer, const Prediction& target) {
    const gl::Functions& gl = device.gl();
    const gl::Buffer pilots = all_pilots(gl, slots, settings, !lights.empty());
    const gl::Texture pilots_texture = gl::Texture::of_buffer(gl, GL_RGBA32F, pilots);
    // Where nothing is seen, nothing arrives.
    const float zeros[4] = {0, 0, 0, 0};
    gl.ClearTexImage(target.bandwidth.name(), 0, GL_RGBA, GL_FLOAT, zeros);
    gl.ClearTexImage(target.prediction.name(), 0, GL_RG, GL_FLOAT, zeros);
    const std::string definitions = text(settings.transport() == TransportForm::box ? "\nTRANSPORT_BOX" : "",
                                         settings.variance() == Variance::printed ? "\nVARIANCE_PRINTED" : "", "\n",
                                         lights.definitions(LightPass::predict, settings));
    // Where lights ask for the lobe itself, one dispatch for each material.
    const bool by_lobe = lights.predicts_by_lobe();
    for (size_t slot = 0; slot < (by_lobe ? slots.materials.size() : 1); ++slot) {
        const std::string lobe = by_lobe ? slots.materials[slot]->definitions(settings.brdf_lookup()) +
                                               text("\nLOBE_BANDWIDTH_VIEWS ", LobeBandwidth::views,
                                                    "\nLOBE_BANDWIDTH_SIDE ", LobeBandwidth::side)
                                         : text("LOBE_VIEWS ", LobeTable::views);
        const gl::Program& program = device.compute("bandwidth", lobe + "\n" + definitions);
        program.set("pilot_count", int32_t(settings.pilots()));
        program.set("radians_per_pixel", float(scene.camera->radians_per_pixel(height)));
        program.use();
        bind_surfaces(gl, program, gbuffer);
        bind_texture(gl, 1, gbuffer.material);
        bind_texture(gl, 7, pilots_texture);
        lights.bind(LightPass::predict, settings, 0, program);
        bind_texture(gl, 5, slot_of.texture);
        bind_image(gl, 0, target.bandwidth, GL_RGBA32F);
        bind_image(gl, 1, target.prediction, GL_RG32F);
        if (by_lobe) {
            program.set("slot", uint32_t(slot));
            slots.materials[slot]->bind(program);
            slots.materials[slot]->bind_bandwidth(settings.band_rule());
        }
        dispatch_covered(gl, program, covered, covered.all);
    }
}

Forecast forecast(gl::Device& device, const Covered& covered, const Prediction& prediction, uint32_t height) {
    Forecast result;
    result.covered = covered.all.count;
    if (result.covered == 0) return result;
    const auto predicted = [&](const gl::Program& program) {
        program.set("mean_radiance", float(result.mean_radiance));
        bind_texture(device.gl(), 0, prediction.prediction);
    };
    result.mean_radiance = row_sums(device, height, "", predicted) / result.covered;
    result.relative_deviation = row_sums(device, height, "DEVIATIONS", predicted) / result.covered;
    return result;
}

void pyramids(gl::Device& device, const Forecast& forecast, const Scales& scales, const Settings& settings,
              const Covered& covered, uint32_t width, uint32_t height, const Prediction& prediction,
              const Pyramids& target) {
    const gl::Functions& gl = device.gl();
    const std::string definitions = target.variances ? "VARIANCES" : "";
    const auto bind = [&](const gl::Program& program) {
        program.use();
        bind_image(gl, 0, target.levels, GL_R8UI);
        if (target.variances) bind_image(gl, 1, target.variances, GL_R32F);
    };
    const uint8_t nothing_seen = 255;
    gl.ClearTexImage(target.levels.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &nothing_seen);
    if (target.variances) gl.ClearTexImage(target.variances.name(), 0, GL_RED, GL_FLOAT, nullptr);

    const gl::Buffer scale_buffer(gl, std::max<size_t>(scales.of.size(), 1) * sizeof(float), scales.of.data());
    const gl::Texture scales_texture = gl::Texture::of_buffer(gl, GL_R32F, scale_buffer);
    const gl::Program& finest = device.compute("levels", text("TILE_SIDE ", tile_side, "\n") + definitions);
    bind(finest);
    finest.set("first_scale", scales.first);
    finest.set("coarsest_level", int32_t(settings.coarsest_level()));
    finest.set("mean_radiance", float(forecast.mean_radiance));
    bind_texture(gl, 0, prediction.prediction);
    bind_texture(gl, 1, prediction.bandwidth);
    bind_texture(gl, 2, scales_texture);
    dispatch_covered(gl, finest, covered, covered.all);

    const gl::Program& coarser = device.compute("pyramid", definitions);
    bind(coarser);
    for (size_t level = 1; level < target.rows.size(); ++level) {
        coarser.set("finer_size", int32_t(width), int32_t(height));
        coarser.set("finer_row", int32_t(target.rows[level - 1]));
        coarser.set("row", int32_t(target.rows[level]));
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        dispatch_pixels(gl, width, height);
    }
}

}  // namespace lightband::passes
