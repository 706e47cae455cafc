// Lamps of a map: places so small that a surface's horizon crosses one within a few pixels, and so bright that radiance has an edge there.
// Bandwidth knows nothing of that edge, and what pilots stand for is too wide to see it (shaders/lamps.glsl).
#pragma once

#include <vector>

#include "base/image.h"
#include "base/math.h"

namespace lightband {

struct Lamp {
    // What a lamp brings at least, in parts of all light that comes from no lamp, as may a pixel's that sees none: an edge of less is seen
    // by witnesses in time.
    static constexpr double least_contrast = 0.5;
    static constexpr uint32_t most = 8;
    // Half angle of the cone in which its light is looked for, radians: four suns. What is wider fades over its own width.
    static constexpr double reach = 0.02;

    Vec3 direction;  // unit, towards its brightest texel
    double size;     // half the angle that it fills, lookups between texels included; radians
};

// Brightest first. unit: of radiance, near the map's mean (MapSampler::unit).
std::vector<Lamp> lamps(const RgbImage& map, double unit);

}  // namespace lightband
