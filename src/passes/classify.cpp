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

// Bins of a slot in the order of the list: most samples first.
template <class Visit>
void visit_bins(Visit visit) {
    for (uint32_t bin = budget_bins; bin-- > 0;) visit(bin);
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

Counts classify(gl::Device& device, const SlotTable& slot_of, size_t slots, const Criteria& criteria, const Forecast& forecast,
                uint32_t width, const Covered& covered, const GBuffer& gbuffer, const Prediction* prediction, const Shading& target) {
    const Settings& settings = criteria.settings;
    const std::vector<uint8_t>& previous_bins = criteria.previous_bins;
    const gl::Functions& gl = device.gl();
    const gl::Buffer counts(gl, (header + slots * 2 * budget_bins) * sizeof(uint32_t), nullptr);
    counts.clear();
    const bool further = !previous_bins.empty();
    const gl::Program& program = device.compute("classify", definitions(settings, prediction) + lamp_definitions(criteria.lamps) +
                                                                (further ? "\nFURTHER_ROUND" : ""));
    gl::Texture previous;
    if (further) {
        previous = gl::Texture::image(gl, GL_R8UI, width, uint32_t(previous_bins.size() / width));
        previous.upload(width, uint32_t(previous_bins.size() / width), GL_RED_INTEGER, GL_UNSIGNED_BYTE, previous_bins.data());
    }
    criteria.chosen.set(program);
    set_lamps(program, criteria.lamps);
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
    if (prediction != nullptr && prediction->pyramids) {
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

uint32_t ShadingList::Part::rounds() const { return (runs.front().samples + part_samples - 1) / part_samples; }

uint32_t ShadingList::Part::pixels(uint32_t round) const {
    uint32_t result = 0;
    for (const Run& run : runs)
        if (run.samples > round * part_samples) result += run.pixels;
    return result;
}

uint64_t ShadingList::Part::samples(uint32_t round, uint32_t first_pixels) const {
    uint64_t result = 0;
    for (const Run& run : runs) {
        const uint32_t own = std::min(run.pixels, first_pixels), had = std::min(run.samples, round * part_samples);
        result += uint64_t(own) * std::min(run.samples - had, part_samples);
        first_pixels -= own;
    }
    return result;
}

ShadingList shading_list(gl::Device& device, const SlotTable& slot_of, const Counts& counts, const Budget& budget,
                         const Covered& covered, const GBuffer& gbuffer, const Shading& target) {
    const gl::Functions& gl = device.gl();
    const size_t parts = counts.histogram.size() / budget_bins;  // two of each slot
    ShadingList list;
    list.samples = budget;
    std::vector<uint32_t> cursors(std::max<size_t>(counts.histogram.size(), 1));
    uint32_t place = 0;
    for (uint32_t index = 0; index < parts; ++index) {
        ShadingList::Part part{index / 2, place, {}};
        visit_bins([&](uint32_t bin) {
            const uint32_t count = counts.histogram[index * budget_bins + bin];
            cursors[index * budget_bins + bin] = place;
            place += count;
            if (count == 0) return;
            list.total_samples += uint64_t(count) * list.samples[bin];
            part.runs.push_back({count, list.samples[bin]});
        });
        if (!part.runs.empty()) list.parts.push_back(std::move(part));
    }
    list.pixels = place;

    list.entries = gl::Buffer(gl, std::max<size_t>(place, 1) * sizeof(uint32_t), nullptr);
    list.entries_texture = gl::Texture::of_buffer(gl, GL_R32UI, list.entries);
    const gl::Buffer cursor_buffer(gl, cursors.size() * sizeof(uint32_t), cursors.data());
    const gl::Program& program = device.compute("scatter", text("BINS ", budget_bins));
    program.use();
    bind_texture(gl, 0, target.decision);
    bind_texture(gl, 1, gbuffer.material);
    bind_texture(gl, 2, slot_of.texture);
    bind_storage(gl, 0, cursor_buffer);
    bind_storage(gl, 1, list.entries);
    bind_image(gl, 0, target.sample_count, GL_R32UI);
    dispatch_covered(gl, program, covered, covered.all);
    return list;
}

ShadingList even_list(gl::Device& device, const std::vector<std::vector<uint32_t>>& pixels_of_slot, uint32_t samples) {
    ShadingList list;
    list.samples.assign(budget_bins, samples);
    std::vector<uint32_t> entries;
    for (uint32_t slot = 0; slot < pixels_of_slot.size(); ++slot) {
        const std::vector<uint32_t>& own = pixels_of_slot[slot];
        if (own.empty()) continue;
        list.parts.push_back({slot, uint32_t(entries.size()), {{uint32_t(own.size()), samples}}});
        entries.insert(entries.end(), own.begin(), own.end());
    }
    list.pixels = entries.size();
    list.total_samples = list.pixels * samples;
    if (entries.empty()) entries.push_back(0);
    list.entries = gl::Buffer(device.gl(), entries.size() * sizeof(uint32_t), entries.data());
    list.entries_texture = gl::Texture::of_buffer(device.gl(), GL_R32UI, list.entries);
    return list;
}

}  // namespace lightband::passes
