// The device memory of a frame: what the passes write, each texture named after what it holds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gl/objects.h"
#include "scene/camera.h"

namespace lightband {

// One texel per pixel, rows top-down.
struct GBuffer {
    gl::Texture surface;   // RGBA32F: unit normal towards the eye; depth, metres, negative where the normal had to be bent
    gl::Texture material;  // R8UI: instance number + 1
    gl::Texture depth;     // for the rasteriser
    Camera::Rays rays{};   // along which the depths lie

    GBuffer(const gl::Functions& gl, uint32_t width, uint32_t height);
    size_t bytes() const { return surface.bytes() + material.bytes() + depth.bytes(); }
};

// For interpolation in the image. Pyramids are pictures with each level below the finer one; rows[l] is where level l starts.
struct Pyramids {
    gl::Texture levels;     // R8UI; 255: nothing seen
    gl::Texture variances;  // R32F: relative; none where nothing asks for it
    gl::Texture weights;    // RGBA16, of the picture's size: of the parents of each pixel that may be interpolated
    std::vector<uint32_t> rows;
    uint32_t height = 0;  // of all levels

    Pyramids(const gl::Functions& gl, uint32_t width, uint32_t height, uint32_t coarsest_level, bool with_variances);
    size_t bytes() const { return levels.bytes() + variances.bytes() + weights.bytes(); }
};

// A table that is written as storage or as an image, and read as a texture.
struct Table {
    gl::Buffer buffer;
    gl::Texture texture;
};

// For interpolation over directions: pixels sorted by where a mirror would send the eye's ray (shaders/mirrors.glsl). Levels are
// octahedral squares of 2^l cells a side, one of each for every BRDF slot.
struct MirrorCells {
    gl::Texture cells;  // R32UI: level and cell of each pixel
    Table claims;       // which pixel speaks for a cell
    Table counts;       // how many pixels lie in it
    Table occupants;    // a shaded pixel in it, of its own level or one beside that
    Table mirrors;      // four words for each covered pixel
    uint32_t last_level;

    static constexpr uint32_t first_level = 3, tiles = 1u << 2 * first_level;
    // Of the word of a pixel that asks for finer cells than there are.
    static constexpr uint32_t too_fine = 15;

    MirrorCells(const gl::Functions& gl, uint32_t width, uint32_t height, size_t slots, uint64_t covered_pixels);
    static uint32_t level_of(uint32_t word) { return word >> 28; }
    static uint32_t tile_of(uint32_t word, uint32_t slot);
    size_t index_of(uint32_t word, uint32_t slot) const;  // into the tables
    std::string definitions() const;
    size_t bytes() const;
};

// The bandwidth buffer, and what interpolation makes of it: at most one of the two ways.
struct Prediction {
    gl::Texture bandwidth;   // RGBA32F: spatial, angular, image bandwidth, curvature
    gl::Texture prediction;  // RG32F: variance of one sample, mean radiance
    gl::Texture reflected;   // R32F: bandwidth over mirror directions, cycles per radian; none where nothing asks for it
    std::optional<Pyramids> pyramids;
    std::optional<MirrorCells> mirrors;

    Prediction(const gl::Functions& gl, uint32_t width, uint32_t height, bool over_directions);
    bool interpolates() const { return pyramids || mirrors; }
    size_t bytes() const;
};

struct Shading {
    gl::Texture radiance;      // RGBA32F: RGB; where shaded: mean of squared luminance, where interpolated: variance of the mean
    gl::Texture spread;        // RGBA32F: half the difference of two replicates' luminances; where a shaded pixel was compared with
                               // interpolation, of the interpolated value: its deviation, how much its spread differs, its variance
                               // (negative: something speaks against interpolation there, shaders/lattice.glsl)
    gl::Texture sample_count;  // R32UI
    gl::Texture decision;      // R8UI: shaders/decision.glsl

    Shading(const gl::Functions& gl, uint32_t width, uint32_t height);
    void clear(const gl::Functions& gl) const;   // nothing shaded yet
    void forget(const gl::Functions& gl) const;  // how often: what is shaded anew is no continuation
    void decide_all(const gl::Functions& gl) const;  // every pixel to be shaded, with the samples of the first bin
    size_t bytes() const { return radiance.bytes() + spread.bytes() + sample_count.bytes() + decision.bytes(); }
};

}  // namespace lightband
