#include "sampling/bright_sources.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "scene/environment.h"

namespace lightband {
namespace {

struct Place {
    uint32_t x, y;
    bool operator<(const Place& other) const { return std::pair(y, x) < std::pair(other.y, other.x); }
};

// A map's texels with their light taken off as sources are found.
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

    // Takes off what comes from the cone around a direction: how much, and from which texels.
    double take(const Vec3& axis, double half_angle, std::vector<Place>* places) {
        double taken = 0;
        const double latitude = std::asin(std::clamp(axis.y, -1.0, 1.0)), inside = std::cos(half_angle);
        for (uint32_t y = 0; y < map_.height; ++y) {
            if (std::abs(latitudes_[y] - latitude) > half_angle) continue;
            for (uint32_t x = 0; x < map_.width; ++x) {
                if (glm::dot(axis, direction(x, y)) < inside) continue;
                taken += double(std::exchange(at(x, y), 0.0f));
                places->push_back({x, y});
            }
        }
        return taken;
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

struct Source {
    double flux;  // luminance, up to a factor
    std::vector<Place> places;
};

std::vector<Source> find_sources(const RgbImage& map, double unit) {
    Texels texels(map, unit);
    std::vector<Source> found;
    double rest = texels.all();
    while (rest > 0 && found.size() < BrightSources::most) {
        Source source{};
        source.flux = texels.take(texels.brightest(), BrightSources::reach, &source.places);
        if (!(source.flux > 0)) break;
        rest -= source.flux;
        found.push_back(std::move(source));
    }
    found.erase(
        std::remove_if(found.begin(), found.end(),
                       [&](const Source& source) { return source.flux < BrightSources::least_contrast * rest; }),
        found.end());
    return found;
}

// What surrounds some texels: the median of those beside them, of each channel; a median, since another source may be
// among them.
Vec3 level_around(const RgbImage& map, const std::vector<Place>& places) {
    const std::set<Place> inside(places.begin(), places.end());
    std::set<Place> around;
    for (const Place& place : places)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const int64_t y = int64_t(place.y) + dy;
                const Place beside{uint32_t((int64_t(place.x) + dx + map.width) % map.width), uint32_t(y)};
                if (y >= 0 && y < map.height && inside.count(beside) == 0) around.insert(beside);
            }
    Vec3 level(0);
    if (around.empty()) return level;
    for (int c = 0; c < 3; ++c) {
        std::vector<float> values;
        for (const Place& place : around) values.push_back(map.texel(place.x, place.y)[c]);
        std::nth_element(values.begin(), values.begin() + ptrdiff_t(values.size() / 2), values.end());
        level[c] = double(values[values.size() / 2]);
    }
    return level;
}

// Lowers a source's texels to what surrounds them; the sun of what was taken off.
Sun take_off(const Source& source, Lookup lookup, RgbImage* map) {
    const Vec3 level = level_around(*map, source.places);
    // Of a texel's own width along an axis, the mean square: bilinear weights are triangles of half a width of one
    // texel.
    const double height = pi / map->height, width = 2 * pi / map->width,
                 own_square = lookup == Lookup::linear ? 1.0 / 6 : 1.0 / 12;
    Vec3 flux(0), moment(0);
    double weights = 0, squares = 0;
    std::vector<std::pair<Vec3, double>> taken;
    for (const Place& place : source.places) {
        float* rgb = &map->rgb[(size_t(place.y) * map->width + place.x) * 3];
        const Vec3 direction = direction_of(Vec2((place.x + 0.5) / map->width, (place.y + 0.5) / map->height));
        Vec3 off;
        for (int c = 0; c < 3; ++c) {
            const float lowered = std::min(rgb[c], float(level[c]));
            off[c] = double(rgb[c]) - double(lowered);
            rgb[c] = lowered;
        }
        off *= lookup_solid_angle(map->width, map->height, place.y, lookup);
        flux += off;
        const double weight = luminance(off), across = width * std::sqrt(1 - direction.y * direction.y);
        weights += weight;
        moment += weight * direction;
        squares += weight * own_square * (height * height + across * across);
        taken.emplace_back(direction, weight);
    }
    Sun sun;
    sun.direction = glm::normalize(moment);
    for (const auto& [direction, weight] : taken)
        squares += weight * glm::dot(direction - sun.direction, direction - sun.direction);
    // Over a disc of radius a, the mean square of the distance from its middle is a^2 / 2.
    sun.angular_radius = std::clamp(std::sqrt(2 * squares / weights), Sun::least_radius, Sun::largest_radius);
    sun.irradiance = flux * (sun.projected_solid_angle() / sun.solid_angle());
    return sun;
}

}  // namespace

double lookup_solid_angle(uint32_t width, uint32_t height, uint32_t row, Lookup lookup) {
    const double h = pi / height, polar = (row + 0.5) * h;
    if (lookup == Lookup::nearest) return 2 * pi / width * (std::cos(polar - h / 2) - std::cos(polar + h / 2));
    // The integral of (1 - |t| / h) sin(polar + t) to either side; beyond the first and the last row, texels are held.
    const double up = row == 0 ? 1 - std::cos(polar) : -std::cos(polar) - (std::sin(polar - h) - std::sin(polar)) / h;
    const double down =
        row + 1 == height ? 1 + std::cos(polar) : std::cos(polar) - (std::sin(polar + h) - std::sin(polar)) / h;
    return 2 * pi / width * (up + down);
}

std::vector<Sun> bright_sources(const RgbImage& map, double unit, Lookup lookup) {
    std::vector<Sun> suns;
    for (const Source& source : find_sources(map, unit)) {
        RgbImage without = map;
        const Sun sun = take_off(source, lookup, &without);
        if (luminance(sun.irradiance) > 0) suns.push_back(sun);
    }
    return suns;
}

BrightSources split_bright_sources(const RgbImage& map, double unit, Lookup lookup) {
    BrightSources result;
    const std::vector<Source> sources = find_sources(map, unit);
    if (sources.empty()) return result;
    result.rest = map;
    for (const Source& source : sources) {
        RgbImage without = result.rest;
        const Sun sun = take_off(source, lookup, &without);
        // A source may be no brighter than what surrounds it.
        if (!(luminance(sun.irradiance) > 0) || sun.angular_radius > BrightSources::largest_radius) continue;
        result.suns.push_back(sun);
        result.rest = std::move(without);
    }
    if (result.suns.empty()) result.rest = {};
    return result;
}

}  // namespace lightband
