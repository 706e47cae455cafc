// Importance sampling of a latitude-longitude map by its radiance, and a table of directions drawn beforehand.
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"
#include "scene/brdf.h"

namespace lightband {

// Density: constant over each texel, in proportion to the mean radiance that bilinear lookup shows within it, so that a dark
// texel beside a bright one is drawn as often as its border deserves. An all-black map is drawn evenly.
class MapSampler {
public:
    explicit MapSampler(const RgbImage& map);

    struct Sample {
        Vec3 direction;
        double pdf;  // per steradian
    };
    Sample sample(const Vec2& u) const;
    double pdf(const Vec3& direction) const;
    // The density between texel centres, as a texture that holds it shows it: for weights, not a density itself.
    double interpolated_pdf(const Vec3& direction) const;
    double texel_pdf(uint32_t x, uint32_t y) const;
    // Integral over the sphere of the (mean of RGB) radiance that the density is proportional to.
    double total() const { return rows_.back(); }

private:
    double solid_angle(uint32_t row) const;  // of one texel of a row

    uint32_t width_, height_;
    std::vector<double> texels_;  // running sums along each row, weight times solid angle
    std::vector<double> rows_;    // running sums of whole rows
};

// What a shader reads for one direction.
struct MapPoint {
    float direction[3];
    float inverse_pdf;
    float radiance[3];
    float weight_pdf;  // the density as the shader looks it up elsewhere, for the balance heuristic
};

// `count` directions by the (0,2)-sequence under a digital shift that the seed chooses.
std::vector<MapPoint> draw_map_points(const RgbImage& map, const MapSampler& sampler, Lookup lookup, uint32_t seed,
                                      uint32_t count);

}  // namespace lightband
