#include "assets/footprint_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bandwidth/octahedral.h"
#include "gl/dispatch.h"

namespace lightband {
namespace {

// Footprints below a texel are looked up in the map itself; 256 texels a side are some 0.8 degrees wide.
constexpr uint32_t smallest_side = 16, largest_side = 256;

}  // namespace

FootprintLight footprint_light(gl::Device& device, const gl::Texture& map, uint32_t map_height, double total, Lookup lookup,
                               FootprintLight::Kind kind) {
    const gl::Functions& gl = device.gl();
    FootprintLight result;
    const uint32_t side = octahedral_side(map_height, smallest_side, largest_side);
    const uint32_t levels = uint32_t(std::log2(side)) + 1;
    // Half floats hold what is cut, some 3 2^13 times the mean at most; of the whole, a texel may be brighter.
    const bool whole = kind == FootprintLight::Kind::whole;
    const GLenum format = whole ? GL_RGBA32F : GL_RGBA16F;
    result.texture = gl::Texture::image_array(gl, format, side, side, whole ? 1 : Ceilings::count, levels);
    result.unit = total / (4 * pi);

    const std::string definitions = FootprintLight::definitions(kind);
    const gl::Program& resample =
        device.compute("footprint_light", definitions + (lookup == Lookup::nearest ? "\nENVIRONMENT_NEAREST" : ""));
    resample.set("side", int32_t(side));
    resample.set("supersampling", octahedral_supersampling(map_height, side));
    // A map so dark that this leaves the range of float is black: the largest float times 0.
    resample.set("inverse_unit", float(std::min(1 / result.unit, double(std::numeric_limits<float>::max()))));
    resample.use();
    bind_texture(gl, 0, map);
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
