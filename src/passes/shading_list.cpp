#include "passes/shading_list.h"

#include <algorithm>

#include "gl/dispatch.h"
#include "passes/gbuffer.h"

namespace lightband::passes {
namespace {

// Bins of a slot in the order of the list: most samples first.
template <class Visit>
void visit_bins(Visit visit) {
    for (uint32_t bin = budget_bins; bin-- > 0;) visit(bin);
}

}  // namespace

uint32_t ShadingList::Part::rounds(uint32_t each) const { return (runs.front().samples + each - 1) / each; }

uint32_t ShadingList::Part::pixels(uint32_t round, uint32_t each) const {
    uint32_t result = 0;
    for (const Run& run : runs)
        if (run.samples > round * each) result += run.pixels;
    return result;
}

uint64_t ShadingList::Part::samples(uint32_t round, uint32_t first_pixels, uint32_t each) const {
    uint64_t result = 0;
    for (const Run& run : runs) {
        const uint32_t own = std::min(run.pixels, first_pixels), had = std::min(run.samples, round * each);
        result += uint64_t(own) * std::min(run.samples - had, each);
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
    const gl::Program& program = device.compute("shading_list", text("BINS ", budget_bins));
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
