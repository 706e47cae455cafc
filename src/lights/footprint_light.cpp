#include "lights/footprint_light.h"

#include <cmath>

#include "bandwidth/octahedral.h"
#include "gl/dispatch.h"

namespace lightband {
namespace {

// Footprints below a texel are looked up in the map itself; 256 texels a side are some 0.8 degrees wide.
constexpr uint32_t smallest_side = 16, largest_side = 256;

}  // namespace

FootprintLight footprint_light(const EnvironmentLight& light, Lookup lookup, FootprintLight::Kind kind) {
    gl::Device& device = *light.device();
    const gl::Functions& gl = device.gl();
    FootprintLight result;
    const uint32_t map_height = light.map().height, side = octahedral_side(map_height, smallest_side, largest_side);
    const uint32_t levels = uint32_t(std::log2(side)) + 1;
    // Half floats hold what is cut, some 3 2^13 times the mean at most; of the whole, a texel may be brighter.
    const bool below = kind == FootprintLight::Kind::below_ceilings, halves = below && !light.hides_light();
    const GLenum format = halves ? GL_RGBA16F : GL_RGBA32F;
    const uint32_t layers = below ? Ceilings::count : 1;
    result.texture = gl::Texture::image_array(gl, format, side, side, layers, levels);

    const std::string definitions =
        FootprintLight::definitions(kind) + (halves ? "\nLIGHT_FORMAT rgba16f" : "\nLIGHT_FORMAT rgba32f");
    const gl::Program& resample =
        device.compute("footprint_light", definitions + (lookup == Lookup::nearest ? "\nENVIRONMENT_NEAREST" : ""));
    resample.set("side", int32_t(side));
    resample.set("supersampling", octahedral_supersampling(map_height, side));
    resample.set("inverse_mean", float(1 / light.mean()));
    resample.use();
    bind_texture(gl, 0, light.texture());
    bind_images(gl, 0, result.texture, format);
    dispatch_pixels(gl, side, side);

    for (uint32_t level = 1; level < levels; ++level) {
        const gl::Program& average = device.compute("footprint_average", definitions);
        average.set("level", int32_t(level - 1));
        average.use();
        bind_texture(gl, 0, result.texture);
        bind_images(gl, 0, result.texture, format, level);
        dispatch_pixels(gl, side >> level, side >> level);
    }
    // The level nearest to a footprint, bilinearly: two levels cost twice and were not measured to err less.
    result.texture.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    result.texture.parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    device.check("preparing an environment for lookups of footprints");
    return result;
}

}  // namespace lightband
