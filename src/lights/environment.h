// Light from a map: the map on a device, its bandwidth on the octahedral square and the samplers' tables, each made
// when first asked for.
#pragma once

#include <map>
#include <optional>

#include "bandwidth/wavelet.h"
#include "lights/light.h"
#include "sampling/light_tree.h"
#include "sampling/map_sampler.h"
#include "scene/environment.h"
#include "scene/sun.h"

namespace lightband {

// Filled by lights/environment_bandwidth.
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
// (sampling/light_tree.h). Filled by lights/footprint_light.
struct FootprintLight {
    enum class Kind { whole, below_ceilings };
    gl::Texture texture;  // array of a layer for each ceiling, mip-mapped; RGB over the map's mean, and alpha, weighted
                          // by solid angle
    static std::string definitions(Kind kind);
};

// What lies above them: LightTree on a device.
struct LightAbove {
    gl::Buffer trunk;     // two vec4 for each: its direction and sine, its flux and spread
    gl::Buffer parts;     // LightPart
    gl::Texture texture;  // over the parts
};

class EnvironmentLight : public Light {
public:
    // The map has been checked (check_radiance).
    EnvironmentLight(gl::DevicePtr device, RgbImage map);

    static const LightKind registered;
    const LightKind& kind() const override { return registered; }
    const gl::DevicePtr& device() const override { return device_; }
    Vec3 evaluate(const Vec3& direction, Lookup lookup) const override { return radiance(map_, direction, lookup); }
    Sample sample(const Vec2& u) const override;
    double pdf(const Vec3& direction) const override { return sampler_.pdf(direction); }
    double power() const override;
    // Where split_suns is on: the rest of the map, and suns; made once. Empty where the map has no small bright
    // sources.
    std::vector<std::shared_ptr<const Light>> split(const Settings& settings) const override;
    size_t device_bytes() const override;

    const RgbImage& map() const { return map_; }
    const gl::Texture& texture() const { return texture_; }
    const MapSampler& sampler() const { return sampler_; }
    // The radiance of a value of 1 in the texture and the tables: MapSampler::unit().
    double unit() const { return unit_; }
    // Whether a surface may face light so dim beside what it does not see that lookups need care: halves would not hold
    // it, and footprints that reach below the horizon would drown it.
    bool hides_light() const { return hides_light_; }
    // Over the sphere, in units; 1 or more, and less than 2, also where the map is black.
    double mean() const { return sampler_.total() / (4 * pi) / unit_; }
    // Bright sources that are texels of the map: those that are too wide to be suns, and all where split_suns is off.
    const std::vector<Sun>& sources(Lookup lookup) const;
    const EnvironmentBandwidth& bandwidth(BandRule rule) const;
    // Drawn anew when lookup or seed change.
    const MapPoints& points(Lookup lookup, uint32_t seed) const;
    const FootprintLight& footprints(Lookup lookup, FootprintLight::Kind kind) const;
    const LightAbove& above(Lookup lookup) const;

private:
    gl::DevicePtr device_;
    const RgbImage map_;
    const MapSampler sampler_;
    const double unit_;
    const bool hides_light_;
    gl::Texture texture_;  // RGB radiance in units; alpha: the sampler's density, per steradian
    mutable std::map<Lookup, std::vector<std::shared_ptr<const Light>>> split_;
    mutable std::map<Lookup, std::vector<Sun>> sources_;
    mutable std::map<BandRule, EnvironmentBandwidth> bandwidths_;
    mutable MapPoints points_;
    mutable std::pair<Lookup, uint32_t> points_key_;
    mutable std::map<std::pair<Lookup, FootprintLight::Kind>, FootprintLight> footprints_;
    mutable std::map<Lookup, LightAbove> above_;
};

}  // namespace lightband
