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
    // What shaders count radiance in, whatever a scene is measured in: the power of two at or below the mean of that radiance (1 where the
    // map is black). So products of radiances near the mean stay far within the range of float, and no digit of them changes.
    double unit() const;
    // The least that a surface may face, over the mean of the whole sphere: the mean density of the dimmest of its octants, of which one
    // lies in every hemisphere. Where an octant is black, a hemisphere may hold as little as a sliver of others: then that of the dimmest
    // cell of some ten degrees that is not.
    double dimmest_view() const;

private:
    double least_density(uint32_t columns, uint32_t rows, bool* black) const;
    double solid_angle(uint32_t row) const;  // of one texel of a row

    uint32_t width_, height_;
    std::vector<double> texels_;  // running sums along each row, weight times solid angle
    std::vector<double> rows_;    // running sums of whole rows
};

// What a shader reads for one direction.
struct MapPoint {
    float direction[3];
    float inverse_pdf;
    float radiance[3];   // in MapSampler::unit()
    float weight_pdf;  // the density as the shader looks it up elsewhere, for the balance heuristic
};

// `count` directions by the (0,2)-sequence under a digital shift that the seed chooses.
std::vector<MapPoint> draw_map_points(const RgbImage& map, const MapSampler& sampler, Lookup lookup, uint32_t seed,
                                      uint32_t count);

// A part of the sphere that holds an equal number of the points, and so an equal part of the map's light.
struct MapCluster {
    float direction[3];  // unit: the middle of its points
    float sine;          // of the half angle of the cone around it that holds them all; 1 where that is a hemisphere or more
    float density;       // the map's sampling density, averaged over the cluster, per steradian
    float unused[3];
};

// In the balance heuristic a sample of the map counts as so many of the lobe: chosen by what its cluster sends to the eye, it is
// better placed than its density says. Measured (docs/decisions/0006): 1 to 64, least error at 8.
constexpr double map_sample_worth = 8;

// Sorts the points (a power of two) into `clusters` clusters (another) by halving each set across its widest extent. Within a
// cluster the order is that of bit-reversed halvings: every aligned block of 2^k points puts one into each of 2^k compact parts.
std::vector<MapCluster> cluster_points(std::vector<MapPoint>* points, uint32_t clusters);

}  // namespace lightband
