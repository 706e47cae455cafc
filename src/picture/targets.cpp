#include "picture/targets.h"

#include <algorithm>

#include "base/text.h"
#include "picture/decision.h"

namespace lightband {

using gl::Texture;

GBuffer::GBuffer(const gl::Functions& gl, uint32_t width, uint32_t height)
    : surface(Texture::image(gl, GL_RGBA32F, width, height)),
      material(Texture::image(gl, GL_R8UI, width, height)),
      depth(Texture::image(gl, GL_DEPTH_COMPONENT32F, width, height)) {}

Pyramids::Pyramids(const gl::Functions& gl, uint32_t width, uint32_t picture_height, uint32_t coarsest_level, bool with_variances) {
    for (uint32_t level = 0, h = picture_height; level <= coarsest_level; ++level, h = (h + 1) / 2) {
        rows.push_back(height);
        height += h;
    }
    levels = Texture::image(gl, GL_R8UI, width, height);
    if (with_variances) variances = Texture::image(gl, GL_R32F, width, height);
    weights = Texture::image(gl, GL_RGBA16, width, picture_height);
}

namespace {

// Cells of all levels below one.
constexpr size_t cells_below(uint32_t level) { return ((size_t(1) << 2 * level) - (size_t(1) << 2 * MirrorCells::first_level)) / 3; }

// More cells than this many for each covered pixel would hold one pixel each; and all tables together are bounded.
constexpr uint64_t cells_a_pixel = 4, most_cells = 1u << 22;

// A pixel's cell: shaders/mirrors.glsl, cell_word.
uint32_t column_of(uint32_t word) { return word & 0x3fff; }
uint32_t row_of(uint32_t word) { return word >> 14 & 0x3fff; }

uint32_t finest_level(size_t slots, uint64_t covered_pixels) {
    uint32_t level = MirrorCells::first_level;
    while (level < 10 && (uint64_t(1) << 2 * (level + 1)) <= cells_a_pixel * covered_pixels &&
           slots * cells_below(level + 2) <= most_cells)
        ++level;
    return level;
}

Table table(const gl::Functions& gl, GLenum format, size_t words) {
    Table result;
    result.buffer = gl::Buffer(gl, words * sizeof(uint32_t), nullptr);
    result.texture = Texture::of_buffer(gl, format, result.buffer);
    return result;
}

}  // namespace

MirrorCells::MirrorCells(const gl::Functions& gl, uint32_t width, uint32_t height, size_t slots, uint64_t covered_pixels)
    : cells(Texture::image(gl, GL_R32UI, width, height)),
      last_level(finest_level(slots, covered_pixels)) {
    const size_t count = std::max<size_t>(slots, 1) * cells_below(last_level + 1);
    for (Table* each : {&claims, &counts, &occupants}) *each = table(gl, GL_R32UI, count);
    mirrors = table(gl, GL_RGBA32UI, 4 * std::max<uint64_t>(covered_pixels, 1));
}

uint32_t MirrorCells::tile_of(uint32_t word, uint32_t slot) {
    if (level_of(word) == too_fine) return slot * tiles;  // it is shaded, and asks for nothing
    const uint32_t coarser = level_of(word) - first_level;
    return slot * tiles + ((row_of(word) >> coarser) << first_level) + (column_of(word) >> coarser);
}

size_t MirrorCells::index_of(uint32_t word, uint32_t slot) const {
    const uint32_t level = level_of(word);
    return slot * cells_below(last_level + 1) + cells_below(level) + (size_t(row_of(word)) << level) + column_of(word);
}

std::string MirrorCells::definitions() const {
    return text("FIRST_LEVEL ", first_level, "\nLAST_LEVEL ", last_level, "\nTOO_FINE ", too_fine);
}

size_t MirrorCells::bytes() const {
    return cells.bytes() + claims.buffer.bytes() + counts.buffer.bytes() + occupants.buffer.bytes() +
           mirrors.buffer.bytes();
}

Prediction::Prediction(const gl::Functions& gl, uint32_t width, uint32_t height, bool over_directions)
    : bandwidth(Texture::image(gl, GL_RGBA32F, width, height)),
      prediction(Texture::image(gl, GL_RG32F, width, height)),
      reflected(over_directions ? Texture::image(gl, GL_R32F, width, height) : Texture()) {}

size_t Prediction::bytes() const {
    return bandwidth.bytes() + prediction.bytes() + reflected.bytes() + (pyramids ? pyramids->bytes() : 0) +
           (mirrors ? mirrors->bytes() : 0);
}

Shading::Shading(const gl::Functions& gl, uint32_t width, uint32_t height)
    : radiance(Texture::image(gl, GL_RGBA32F, width, height)),
      spread(Texture::image(gl, GL_RGBA32F, width, height)),
      sample_count(Texture::image(gl, GL_R32UI, width, height)),
      decision(Texture::image(gl, GL_R8UI, width, height)) {}

void Shading::clear(const gl::Functions& gl) const {
    const float zeros[4] = {0, 0, 0, 0};
    gl.ClearTexImage(radiance.name(), 0, GL_RGBA, GL_FLOAT, zeros);
    gl.ClearTexImage(spread.name(), 0, GL_RGBA, GL_FLOAT, zeros);
    forget(gl);
}

void Shading::forget(const gl::Functions& gl) const {
    const uint32_t none = 0;
    gl.ClearTexImage(sample_count.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &none);
}

void Shading::decide_all(const gl::Functions& gl) const {
    gl.ClearTexImage(decision.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &first_bin);
}

}  // namespace lightband
