#include "passes/covered.h"

#include <algorithm>

#include "gl/dispatch.h"
#include "gl/read_back.h"
#include "picture/decision.h"

namespace lightband::passes {
namespace {

constexpr uint32_t group = 64;

}  // namespace

Covered covered(const gl::Functions& gl, const GBuffer& gbuffer, uint32_t width, uint32_t height,
                uint32_t coarsest_level, std::vector<uint8_t>* material) {
    *material = read_bytes(gbuffer.material, size_t(width) * height);
    std::vector<std::vector<uint32_t>> by_level(coarsest_level + 1);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            if ((*material)[size_t(y) * width + x] != 0)
                by_level[lattice_level(x, y, coarsest_level)].push_back(y << 16 | x);

    Covered result;
    result.levels.resize(by_level.size());
    std::vector<uint32_t> entries;
    for (size_t level = by_level.size(); level-- > 0;) {
        result.levels[level] = {uint32_t(entries.size()), uint32_t(by_level[level].size())};
        entries.insert(entries.end(), by_level[level].begin(), by_level[level].end());
    }
    result.all.count = uint32_t(entries.size());
    if (entries.empty()) entries.push_back(0);
    result.entries = gl::Buffer(gl, entries.size() * sizeof(uint32_t), entries.data());
    result.texture = gl::Texture::of_buffer(gl, GL_R32UI, result.entries);
    return result;
}

void dispatch_covered(const gl::Functions& gl, const gl::Program& program, const Covered& covered,
                      const Covered::Part& part) {
    constexpr uint32_t most = most_groups * group;
    bind_texture(gl, 15, covered.texture);
    for (uint32_t done = 0; done < part.count; done += most) {
        const uint32_t count = std::min(part.count - done, most);
        program.set("first", part.first + done);
        program.set("count", count);
        gl.DispatchCompute((count + group - 1) / group, 1, 1);
    }
    gl.MemoryBarrier(everything);
}

}  // namespace lightband::passes
