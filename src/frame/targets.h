// The device memory of a frame: what the passes write, each texture named after what it holds.
#pragma once

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

// The bandwidth buffer. Pyramids are pictures with each level below the finer one; rows[l] is where level l starts.
struct Prediction {
    gl::Texture bandwidth;   // RGBA32F: spatial, angular, image bandwidth, curvature
    gl::Texture prediction;  // RG32F: variance of one sample, mean radiance
    gl::Texture levels;      // R8UI pyramid; 255: nothing seen
    gl::Texture variances;   // R32F pyramid of relative variances
    std::vector<uint32_t> rows;
    uint32_t pyramid_height = 0;

    Prediction(const gl::Functions& gl, uint32_t width, uint32_t height, uint32_t coarsest_level);
    size_t bytes() const { return bandwidth.bytes() + prediction.bytes() + levels.bytes() + variances.bytes(); }
};

struct Shading {
    gl::Texture radiance;      // RGBA32F: RGB; where shaded: mean of squared luminance, where interpolated: variance of the mean
    gl::Texture spread;        // RGBA32F: half the difference of two replicates' luminances; at a witness, of the interpolated value:
                               // its deviation, how much its spread differs, its variance
    gl::Texture sample_count;  // R32UI
    gl::Texture decision;      // R8UI: shaders/decision.glsl

    Shading(const gl::Functions& gl, uint32_t width, uint32_t height);
    void clear(const gl::Functions& gl) const;   // nothing shaded yet
    void forget(const gl::Functions& gl) const;  // how often: what is shaded anew is no continuation
    void decide_all(const gl::Functions& gl) const;  // every pixel to be shaded, with the samples of the first bin
    size_t bytes() const { return radiance.bytes() + spread.bytes() + sample_count.bytes() + decision.bytes(); }
};

}  // namespace lightband
