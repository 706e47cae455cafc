// Small bright sources of a map, such as the sun: found, and taken out of the map as suns.
#pragma once

#include <vector>

#include "base/image.h"
#include "scene/brdf.h"
#include "scene/sun.h"

namespace lightband {

// Sources so small that a surface's horizon crosses one within a few pixels, and so bright that radiance has an edge
// there. Of radiance that a map holds, one such source hides the rest from every table that is made relative to the
// map's mean.
struct BrightSources {
    // What a source brings at least, in parts of all light that comes from none, as may a pixel's that sees none: an
    // edge of less is seen by pixels that are shaded although they might be interpolated, in time.
    static constexpr double least_contrast = 0.5;
    static constexpr uint32_t most = 8;
    // Half angle of the cone in which a source's light is looked for, radians: four suns. What is wider fades over its
    // own width.
    static constexpr double reach = 0.02;
    // Radians: what would become a wider disc stays in the map, as do the texels of maps of 128 rows and fewer. A texel
    // is no disc, and at the line where it sets the two differ: by 17 % of what a frame shows under a map of 16 rows,
    // by 1.3 % under one of 64 (bench/suns.py).
    static constexpr double largest_radius = reach;

    RgbImage rest;  // the map, where the sources are no brighter than what surrounds them
    // Brightest first: discs of the same flux (the integral of radiance over directions), of the same mean direction
    // and as wide, by the root mean square of the distance from it.
    std::vector<Sun> suns;
};

// unit: of radiance, near the map's mean (MapSampler::unit). lookup: by which the map is read, and by which its flux
// counts. rest is empty where there are no suns.
BrightSources split_bright_sources(const RgbImage& map, double unit, Lookup lookup);

// The sources themselves, of any width, as the suns that they would be.
std::vector<Sun> bright_sources(const RgbImage& map, double unit, Lookup lookup);

// The solid angle over which a texel of a row counts: the integral of its weight in lookups over all directions.
double lookup_solid_angle(uint32_t width, uint32_t height, uint32_t row, Lookup lookup);

}  // namespace lightband
