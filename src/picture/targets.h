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
    gl::Texture
        surface;  // RGBA32F: unit normal towards the eye; depth, metres, negative where the normal had to be bent
    gl::Texture material;  // R8UI: instance number + 1
    gl::Texture depth;     // for the rasteriser
    Camera::Rays rays{};   // along which the depths lie

    GBuffer(const gl::Functions& gl, uint32_t width, uint32_t height);
    size_t bytes() const { return surface.bytes() + material.bytes() + depth.bytes(); }
};

// For interpolation. Pyramids are pictures with each level below the finer one; rows[l] is where level l starts.
struct Pyramids {
    gl::Texture levels;     // R8UI; 255: nothing seen
    gl::Texture variances;  // R32F: relative; none where nothing asks for it
    gl::Texture weights;    // RGBA16, of the picture's size: of the parents of each pixel that may be interpolated
    std::vector<uint32_t> rows;
    uint32_t height = 0;  // of all levels

    Pyramids(const gl::Functions& gl, uint32_t width, uint32_t height, uint32_t coarsest_level, bool with_variances);
    size_t bytes() const { return levels.bytes() + variances.bytes() + weights.bytes(); }
};

// The bandwidth buffer, and what interpolation makes of it.
struct Prediction {
    gl::Texture bandwidth;             // RGBA32F: spatial, angular, image bandwidth, curvature
    gl::Texture prediction;            // RG32F: variance of one sample, mean radiance
    std::optional<Pyramids> pyramids;  // none where every pixel is shaded

    Prediction(const gl::Functions& gl, uint32_t width, uint32_t height);
    size_t bytes() const { return bandwidth.bytes() + prediction.bytes() + (pyramids ? pyramids->bytes() : 0); }
};

struct Shading {
    gl::Texture
        radiance;  // RGBA32F: RGB; where shaded: mean of squared luminance, where interpolated: variance of the mean
    gl::Texture
        spread;  // RGBA32F: half the difference of two replicates' luminances; where a shaded pixel was compared with
                 // interpolation, of the interpolated value: its deviation, how much its spread differs, its variance
                 // (negative: something speaks against interpolation there, shaders/lattice.glsl)
    gl::Texture sample_count;  // R32UI
    gl::Texture decision;      // R8UI: shaders/decision.glsl

    Shading(const gl::Functions& gl, uint32_t width, uint32_t height);
    void clear(const gl::Functions& gl) const;           // nothing shaded yet
    void forget(const gl::Functions& gl) const;          // how often: what is shaded anew is no continuation
    void decide_nothing(const gl::Functions& gl) const;  // no pixel is shaded or interpolated
    void decide_all(const gl::Functions& gl) const;      // every pixel to be shaded, with the samples of the first bin
    size_t bytes() const { return radiance.bytes() + spread.bytes() + sample_count.bytes() + decision.bytes(); }
};

}  // namespace lightband
