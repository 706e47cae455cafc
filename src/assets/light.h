// An environment on a device: its map, and its bandwidth on the octahedral square, computed there when first asked for.
#pragma once

#include <map>
#include <optional>

#include "bandwidth/wavelet.h"
#include "gl/objects.h"
#include "sampling/lamps.h"
#include "sampling/light_tree.h"
#include "sampling/map_sampler.h"
#include "scene/environment.h"

namespace lightband {

// Filled by passes/environment_bandwidth.
struct EnvironmentBandwidth {
    uint32_t side = 0;
    gl::Texture moments;    // mip-mapped means of L, L^2, L nu_a
    gl::Texture bandwidth;  // nu_a, cycles/radian
};

// Directions drawn from a map beforehand; a pixel takes those of some clusters (docs/decisions/0006).
struct MapPoints {
    static constexpr uint32_t count = 1u << 16, cluster_count = 64;
    gl::Buffer points, clusters;  // two vec4 each: sampling/map_sampler.h, MapPoint and MapCluster
    gl::Texture texture;          // over the points
};

// A map for lookups of footprints, on the octahedral square: whole, or what lies below each of the soft ceilings
// (sampling/light_tree.h). Filled by passes/footprint_light.
struct FootprintLight {
    enum class Kind { whole, below_ceilings };
    gl::Texture texture;  // array of a layer for each ceiling, mip-mapped; RGB over the map's mean, and alpha, weighted by solid angle
    static std::string definitions(Kind kind);
};

// What lies above them: LightTree on a device.
struct LightAbove {
    gl::Buffer trunk;     // two vec4 for each: its direction and sine, its flux and spread
    gl::Buffer parts;     // LightPart
    gl::Texture texture;  // over the parts
};

class Light {
public:
    // The map has been checked (check_radiance).
    Light(gl::DevicePtr device, RgbImage map);

    const gl::DevicePtr& device() const { return device_; }
    const RgbImage& map() const { return map_; }
    const gl::Texture& texture() const { return texture_; }
    const MapSampler& sampler() const { return sampler_; }
    // The radiance of a value of 1 in whatever shaders read and write: MapSampler::unit().
    double unit() const { return unit_; }
    // Whether a surface may face light so dim beside what it does not see that lookups need care: halves would not hold it, and
    // footprints that reach below the horizon would drown it.
    bool hides_light() const { return hides_light_; }
    // Over the sphere, in units.
    double mean() const { return sampler_.total() / (4 * pi) / unit_; }
    const std::vector<Lamp>& lamps() const;
    const EnvironmentBandwidth& bandwidth(BandRule rule) const;
    // Drawn anew when lookup or seed change.
    const MapPoints& points(Lookup lookup, uint32_t seed) const;
    const FootprintLight& footprints(Lookup lookup, FootprintLight::Kind kind) const;
    const LightAbove& above(Lookup lookup) const;
    size_t device_bytes() const;

private:
    gl::DevicePtr device_;
    const RgbImage map_;
    const MapSampler sampler_;
    const double unit_;
    const bool hides_light_;
    gl::Texture texture_;  // RGB radiance in units; alpha: the sampler's density, per steradian
    mutable std::optional<std::vector<Lamp>> lamps_;
    mutable std::map<BandRule, EnvironmentBandwidth> bandwidths_;
    mutable MapPoints points_;
    mutable std::pair<Lookup, uint32_t> points_key_;
    mutable std::map<std::pair<Lookup, FootprintLight::Kind>, FootprintLight> footprints_;
    mutable std::map<Lookup, LightAbove> above_;
};

}  // namespace lightband
