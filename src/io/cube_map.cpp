#include "io/cube_map.h"

#include <ImfEnvmap.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/math.h"
#include "io/image_file.h"
#include "scene/environment.h"

namespace lightband::io {
namespace {

// Radiance of the cube from a unit direction.
Vec3 radiance_of(const RgbImage& cube, const Vec3& direction) {
    const Imath::Box2i window({0, 0}, {int(cube.width) - 1, int(cube.height) - 1});
    Imf::CubeMapFace face;
    Imath::V2f within;
    Imf::CubeMap::faceAndPixelPosition(Imath::V3f(float(direction.x), float(direction.y), float(direction.z)), window, face,
                                       within);
    // The corner of the four texels around the place, and how far it is from there. A face of one texel is constant.
    const int last = int(cube.width) - 1;
    const auto texel = [&](int x, int y) {
        const Imath::V2f at = Imf::CubeMap::pixelPosition(face, window, Imath::V2f(float(x), float(y)));
        const float* rgb = cube.texel(uint32_t(std::lround(at.x)), uint32_t(std::lround(at.y)));
        return Vec3(rgb[0], rgb[1], rgb[2]);
    };
    const double x = std::clamp<double>(within.x, 0, last), y = std::clamp<double>(within.y, 0, last);
    const int x0 = std::min(int(x), std::max(last - 1, 0)), y0 = std::min(int(y), std::max(last - 1, 0));
    const int x1 = std::min(x0 + 1, last), y1 = std::min(y0 + 1, last);
    const double fx = x - x0, fy = y - y0;
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x1, y0)) +
           fy * ((1 - fx) * texel(x0, y1) + fx * texel(x1, y1));
}

}  // namespace

RgbImage from_cube_map(const RgbImage& cube, const std::string& name) {
    if (cube.height != 6 * cube.width)
        throw Error(LB_ERROR_FORMAT, text(name, ": a cube map of ", cube.width, " x ", cube.height,
                                          " texels is not six squares, one below the other"));
    // Around the equator, four faces: as many texels as they have, but enough that the edges of small faces stay sharp.
    constexpr uint32_t smallest_width = 512;
    RgbImage map;
    map.width = std::clamp(4 * cube.width, smallest_width, max_map_width);
    map.height = map.width / 2;
    map.rgb.resize(size_t(map.width) * map.height * 3);
    map.notes = cube.notes;
    map.notes.push_back(text("its cube map, of faces of ", cube.width, " x ", cube.width, " texels, was resampled to ", map.width,
                             " x ", map.height, " texels of latitude and longitude"));
    // Rays through each texel along a side; evenly in the sine of the latitude, which is evenly in solid angle.
    constexpr int rays = 4;
    for (uint32_t y = 0; y < map.height; ++y) {
        const double top = std::cos(pi * y / map.height), bottom = std::cos(pi * (y + 1) / map.height);
        for (uint32_t x = 0; x < map.width; ++x) {
            Vec3 sum(0);
            for (int j = 0; j < rays; ++j) {
                const double v = std::acos(top + (bottom - top) * (j + 0.5) / rays) / pi;
                for (int i = 0; i < rays; ++i)
                    sum += radiance_of(cube, direction_of({(x + (i + 0.5) / rays) / map.width, v}));
            }
            for (int c = 0; c < 3; ++c) map.rgb[(size_t(y) * map.width + x) * 3 + size_t(c)] = float(sum[c] / (rays * rays));
        }
    }
    return map;
}

}  // namespace lightband::io
