#include "sampling/lamps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/environment.h"

namespace lightband {
namespace {

// A map's texels with their light taken off as lamps are found.
class Texels {
public:
    Texels(const RgbImage& map, double unit) : map_(map), flux_(size_t(map.width) * map.height) {
        for (uint32_t x = 0; x < map.width; ++x) azimuths_.push_back(direction_of(Vec2((x + 0.5) / map.width, 0.5)));
        for (uint32_t y = 0; y < map.height; ++y) {
            latitudes_.push_back(pi * (0.5 - (y + 0.5) / map.height));
            for (uint32_t x = 0; x < map.width; ++x) {
                const float* rgb = map.texel(x, y);
                // Radiance times solid angle, up to a factor.
                at(x, y) = float(luminance(Vec3(rgb[0], rgb[1], rgb[2])) / unit * std::cos(latitudes_[y]));
                all_ += double(at(x, y));
            }
        }
    }

    double all() const { return all_; }

    Vec3 brightest() const {
        const size_t place = size_t(std::max_element(flux_.begin(), flux_.end()) - flux_.begin());
        return direction(uint32_t(place % map_.width), uint32_t(place / map_.width));
    }

    // Takes off what comes from the cone around a direction: how much, and the root mean square of its distance from there.
    std::pair<double, double> take(const Vec3& axis, double half_angle) {
        double taken = 0, squares = 0;
        const double latitude = std::asin(std::clamp(axis.y, -1.0, 1.0)), inside = std::cos(half_angle);
        for (uint32_t y = 0; y < map_.height; ++y) {
            if (std::abs(latitudes_[y] - latitude) > half_angle) continue;
            for (uint32_t x = 0; x < map_.width; ++x) {
                const Vec3 apart = direction(x, y) - axis;
                if (glm::dot(axis, direction(x, y)) < inside) continue;
                const double flux = double(std::exchange(at(x, y), 0.0f));
                taken += flux;
                squares += flux * glm::dot(apart, apart);
            }
        }
        return {taken, taken > 0 ? std::sqrt(squares / taken) : 0};
    }

private:
    float& at(uint32_t x, uint32_t y) { return flux_[size_t(y) * map_.width + x]; }
    Vec3 direction(uint32_t x, uint32_t y) const {
        return std::cos(latitudes_[y]) * azimuths_[x] + Vec3(0, std::sin(latitudes_[y]), 0);
    }

    const RgbImage& map_;
    std::vector<float> flux_;  // a map may have 2^27 texels
    std::vector<double> latitudes_;
    std::vector<Vec3> azimuths_;
    double all_ = 0;
};

}  // namespace

std::vector<Lamp> lamps(const RgbImage& map, double unit) {
    // A disc's radius over the root mean square distance from its middle; and a texel, beyond whose half the next one's share begins.
    const double disc = std::sqrt(2.0), texel = pi / map.height;
    Texels texels(map, unit);
    std::vector<Lamp> found;
    std::vector<double> fluxes;
    double rest = texels.all();
    while (rest > 0 && found.size() < Lamp::most) {
        const Vec3 direction = texels.brightest();
        const auto [flux, deviation] = texels.take(direction, Lamp::reach);
        if (!(flux > 0)) break;
        found.push_back({direction, disc * deviation + texel});
        fluxes.push_back(flux);
        rest -= flux;
    }
    size_t kept = 0;
    for (size_t i = 0; i < found.size(); ++i)
        if (fluxes[i] >= Lamp::least_contrast * rest) found[kept++] = found[i];
    found.resize(kept);
    return found;
}

}  // namespace lightband
