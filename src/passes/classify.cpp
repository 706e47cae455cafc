#include "passes/classify.h"

#include <algorithm>

#include "gl/dispatch.h"
#include "passes/gbuffer.h"
#include "passes/uniforms.h"

namespace lightband::passes {
namespace {

constexpr size_t header = 2;  // bent and saturated: before the histogram

std::string definitions(const Settings& settings, const Prediction* prediction) {
    std::string result = text("BINS ", budget_bins, "\nSHARE_ONE ", share_one, "\nBINS_PER_OCTAVE ", bins_per_octave);
    if (prediction == nullptr) return result;
    result += "\nPREDICTED";
    if (prediction->pyramids) result += text("\nINTERPOLATE\nPYRAMID_LEVELS ", prediction->pyramids->rows.size());
    if (settings.shares_follow_variance()) result += "\nSHARES_FOLLOW_VARIANCE";
    if (settings.allocation() == Allocation::constant_variance) result += "\nALLOCATION_CONSTANT_VARIANCE";
    return result;
}

}  // namespace

Histogram Counts::bins() const {
    Histogram sums(budget_bins);
    for (size_t i = 0; i < histogram.size(); ++i) sums[i % budget_bins] += histogram[i];
    return sums;
}

Histogram Counts::new_bins() const {
    Histogram sums(budget_bins);
    for (size_t i = 0; i < histogram.size(); ++i)
        if (i / budget_bins % 2 == 0) sums[i % budget_bins] += histogram[i];
    return sums;
}

Counts classify(gl::Device& device, const SlotTable& slot_of, size_t slots, const Criteria& criteria,
                const Forecast& forecast, uint32_t width, const Covered& covered, const GBuffer& gbuffer,
                const Prediction* prediction, const Shading& target) {
    const Settings& settings = criteria.settings;
    const std::vector<uint8_t>& previous_bins = criteria.previous_bins;
    const gl::Functions& gl = device.gl();
    const gl::Buffer counts(gl, (header + slots * 2 * budget_bins) * sizeof(uint32_t), nullptr);
    counts.clear();
    const bool further = !previous_bins.empty(), interpolates = prediction != nullptr && prediction->pyramids;
    const gl::Program& program = device.compute(
        "classify", text(definitions(settings, prediction), further ? "\nFURTHER_ROUND\n" : "\n",
                         interpolates ? criteria.lights.definitions(LightPass::classify, settings) : ""));
    gl::Texture previous;
    if (further) {
        previous = gl::Texture::image(gl, GL_R8UI, width, uint32_t(previous_bins.size() / width));
        previous.upload(width, uint32_t(previous_bins.size() / width), GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                        previous_bins.data());
    }
    criteria.chosen.set(program);
    if (interpolates) criteria.lights.bind(LightPass::classify, settings, 0, program);
    program.use();
    bind_surfaces(gl, program, gbuffer);
    bind_texture(gl, 2, gbuffer.material);
    bind_texture(gl, 3, slot_of.texture);
    if (prediction != nullptr) {
        bind_texture(gl, 4, prediction->bandwidth);
        bind_texture(gl, 5, prediction->prediction);
        program.set("mean_radiance", float(forecast.mean_radiance));
        program.set("tolerance", float(criteria.tolerance));
    }
    if (interpolates) {
        const Pyramids& pyramids = *prediction->pyramids;
        program.set("coarsest_level", int32_t(settings.coarsest_level()));
        program.set_array("pyramid_rows", pyramids.rows.data(), int32_t(pyramids.rows.size()));
        bind_image(gl, 0, pyramids.levels, GL_R8UI);
        bind_image(gl, 4, pyramids.weights, GL_RGBA16);
        if (settings.shares_follow_variance()) bind_image(gl, 1, pyramids.variances, GL_R32F);
    }
    if (further) {
        bind_texture(gl, 6, previous);
        program.set("new_pixel_steps", int32_t(criteria.new_pixel_steps));
    }
    bind_image(gl, 2, target.decision, GL_R8UI);
    bind_image(gl, 3, target.sample_count, GL_R32UI);
    bind_storage(gl, 0, counts);
    const uint8_t nothing_seen = 0;
    gl.ClearTexImage(target.decision.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &nothing_seen);
    dispatch_covered(gl, program, covered, covered.all);

    std::vector<uint32_t> raw(header + slots * 2 * budget_bins);
    counts.read(0, raw.size() * sizeof(uint32_t), raw.data());
    return {raw[0], raw[1], std::vector<uint32_t>(raw.begin() + header, raw.end())};
}

}  // namespace lightband::passes
