#include "scene/environment.h"

#include <algorithm>
#include <cmath>

namespace lightband {

void check_radiance(const RgbImage& map, const std::string& source, lb_result code) {
    const char* const names[3] = {"red", "green", "blue"};
    for (size_t i = 0; i < map.rgb.size(); ++i) {
        const float value = map.rgb[i];
        if (value >= 0 && value <= largest_radiance) continue;
        const size_t texel = i / 3;
        throw Error(code, text(source, ": ", names[i % 3], " of texel (", texel % map.width, ", ", texel / map.width,
                               ") is ", value, "; radiance must be finite, not negative and at most ", largest_radiance));
    }
}

Vec2 latitude_longitude(const Vec3& d) {
    const double latitude = std::atan2(d.y, std::hypot(d.x, d.z));
    return {0.5 - std::atan2(d.x, d.z) / (2 * pi), 0.5 - latitude / pi};
}

Vec3 direction_of(const Vec2& uv) {
    const double longitude = (0.5 - uv.x) * 2 * pi, latitude = (0.5 - uv.y) * pi;
    return {std::cos(latitude) * std::sin(longitude), std::sin(latitude), std::cos(latitude) * std::cos(longitude)};
}

Vec3 radiance(const RgbImage& map, const Vec3& direction, Lookup lookup) {
    const int width = int(map.width), height = int(map.height);
    const Vec2 at = latitude_longitude(direction) * Vec2(width, height);
    const auto texel = [&](int x, int y) {
        const float* rgb = map.texel(uint32_t((x % width + width) % width), uint32_t(std::clamp(y, 0, height - 1)));
        return Vec3(rgb[0], rgb[1], rgb[2]);
    };
    if (lookup == Lookup::nearest) return texel(int(std::floor(at.x)), int(std::floor(at.y)));
    const double x = at.x - 0.5, y = at.y - 0.5;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    const double fx = x - x0, fy = y - y0;
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
           fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
}

}  // namespace lightband
