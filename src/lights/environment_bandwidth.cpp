#include "lights/environment_bandwidth.h"

#include <algorithm>
#include <cmath>

#include "bandwidth/octahedral.h"
#include "gl/dispatch.h"

namespace lightband {
namespace {

// The square's side: its mean texel is about as wide as the map's; bounded so that a frame's lookups stay in caches.
constexpr uint32_t smallest_side = 64, largest_side = 1024;

void dispatch_square(const gl::Functions& gl, uint32_t side) {
    dispatch_pixels(gl, side, side);
}

}  // namespace

EnvironmentBandwidth environment_bandwidth(gl::Device& device, const gl::Texture& map, uint32_t map_height,
                                           BandRule rule) {
    const gl::Functions& gl = device.gl();
    EnvironmentBandwidth result;
    const uint32_t side = result.side = octahedral_side(map_height, smallest_side, largest_side);
    const uint32_t all_levels = uint32_t(std::log2(side)) + 1;
    const uint32_t levels = all_levels - 1;  // of wavelets: down to a single texel
    result.moments = gl::Texture::image(gl, GL_RGBA32F, side, side, all_levels);
    result.bandwidth = gl::Texture::image(gl, GL_R32F, side, side);
    // Level k of these pyramids is the transform's level k (approximation), k + 1 (details and their reach).
    const gl::Texture smooth = gl::Texture::image(gl, GL_R32F, side, side, levels + 1);
    const gl::Texture details = gl::Texture::image(gl, GL_R32F, side / 2, side / 2, levels);
    const gl::Texture reach = gl::Texture::image(gl, GL_R32F, side / 2, side / 2, levels);

    const gl::Program& resample = device.compute("environment_resample");
    resample.set("side", int32_t(side));
    resample.set("supersampling", octahedral_supersampling(map_height, side));
    resample.use();
    bind_texture(gl, 0, map);
    bind_image(gl, 0, result.moments, GL_RGBA32F);
    bind_image(gl, 1, smooth, GL_R32F);
    dispatch_square(gl, side);

    for (uint32_t k = 0; k < levels; ++k) {
        const gl::Program& wavelet = device.compute("environment_wavelet");
        wavelet.set("side", int32_t(side >> k));
        wavelet.set("finer_level", int32_t(k));
        wavelet.use();
        bind_texture(gl, 0, smooth);
        bind_image(gl, 0, smooth, GL_R32F, k + 1);
        bind_image(gl, 1, details, GL_R32F, k);
        dispatch_square(gl, side >> (k + 1));

        const gl::Program& reaching = device.compute("environment_reach");
        reaching.set("side", int32_t(side >> (k + 1)));
        reaching.set("level", int32_t(k));
        reaching.use();
        bind_texture(gl, 0, details);
        bind_image(gl, 0, reach, GL_R32F, k);
        dispatch_square(gl, side >> (k + 1));
    }

    const gl::Program& bandwidth =
        device.compute("environment_bandwidth", rule == BandRule::energy ? "BAND_RULE_ENERGY" : "");
    bandwidth.set("side", int32_t(side));
    bandwidth.set("levels", int32_t(levels));
    bandwidth.use();
    // The coarsest approximation is read at its own level, found by `at >> levels`.
    smooth.parameter(GL_TEXTURE_BASE_LEVEL, GLint(levels));
    bind_texture(gl, 0, reach);
    bind_texture(gl, 1, smooth);
    bind_image(gl, 0, result.moments, GL_RGBA32F);
    bind_image(gl, 1, result.bandwidth, GL_R32F);
    dispatch_square(gl, side);

    for (uint32_t level = 1; level < all_levels; ++level) {
        const gl::Program& average = device.compute("environment_average");
        average.set("level", int32_t(level - 1));
        average.use();
        bind_texture(gl, 0, result.moments);
        bind_image(gl, 0, result.moments, GL_RGBA32F, level);
        dispatch_square(gl, side >> level);
    }
    // A pilot reads the level of its footprint, bilinearly.
    result.moments.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    result.moments.parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    device.check("bandwidth of an environment");
    return result;
}

}  // namespace lightband
