// The light of a map above a soft ceiling, as a tree of compact parts: what a pixel sums over a cut through (Walter et al. 2005,
// "Lightcuts", of one distant map). What is below the ceiling is left to the lobe's samples.
#pragma once

#include <vector>

#include "base/image.h"
#include "sampling/map_sampler.h"

namespace lightband {

// Soft ceilings: of radiance L, L T / (L + T) lies below the ceiling T, the rest above it. A pixel takes the ceiling that suits its
// lobe's density in a direction: where the balance heuristic would weigh a sample of the lobe as much as `worth` of the map. They rise
// from half the map's mean in steps of a factor 4; beyond the last, nothing lies above.
// The density with which the map is sampled stands for its radiance: 4 pi times it is L over the mean.
struct Ceilings {
    static constexpr uint32_t count = 8;
    static constexpr double first = 0.5;  // of the map's mean radiance
    static constexpr double worth = 8;    // measured (docs/decisions/0009): 2 to 32, least error at 8
    static double at(uint32_t layer) { return first * double(1u << 2 * layer); }
    static double part_above(uint32_t layer, double map_density) {
        const double radiance = 4 * pi * map_density;
        return radiance / (radiance + at(layer));
    }
};

// A part of the sphere whose light above the ceilings counts as if it all came from its centre. vec4s in shaders.
struct LightPart {
    float direction[3];  // unit: the mean over its light
    float sine;          // of the half angle of the cone around it that holds the whole part; 1: a hemisphere or more
    struct Flux {
        float rgb[3];    // the integral of its radiance above the ceiling, in MapSampler::unit()
        float spread;    // flux (mean of RGB) times the variance of the part's directions
    } flux[Ceilings::count];
};

struct LightTree {
    // Parts that every cut has, or more parts in their place: a second, coarser trunk for cuts of fewer parts than it has itself.
    struct Trunk {
        uint32_t first, count;
    };
    static constexpr Trunk trunks[] = {{0, 64}, {64, 32}};
    static constexpr uint32_t trunk_parts = trunks[0].count + trunks[1].count;
    static constexpr uint32_t depth = 8;  // how often one of them can be halved
    static constexpr uint32_t heap = 2u << depth;

    // Of each part of either trunk a heap: its parts after d halvings are those from place 2^d to 2^(d + 1); place 0 is unused. The
    // last ones are empty where the light has fewer places. The same place of all heaps lies together: most cuts need the first few.
    std::vector<LightPart> parts;  // heap * trunk_parts
    static constexpr size_t index(size_t trunk_part, size_t place) { return place * trunk_parts + trunk_part; }
};

// Linear lookup lights between texels as a shader does.
LightTree light_tree(const RgbImage& map, const MapSampler& sampler, Lookup lookup);

}  // namespace lightband
