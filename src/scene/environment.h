// Distant light: a latitude-longitude map. +Y is up, the image's centre looks along +Z, its left edge along -Z; texels are
// sampled at their centres (OpenEXR's convention).
#pragma once

#include <string>

#include "base/error.h"
#include "base/image.h"
#include "base/math.h"
#include "scene/brdf.h"

namespace lightband {

// Prediction squares radiance times BRDF peaks; up to here the squares stay within float (3e38).
constexpr float largest_radiance = 1e15f;

// Throws code when a texel is negative, not finite or above largest_radiance; the message names source, texel and value.
void check_radiance(const RgbImage& map, const std::string& source, lb_result code);

Vec2 latitude_longitude(const Vec3& direction);       // unit direction -> (u, v) in [0, 1]^2, v down
Vec3 direction_of(const Vec2& latitude_longitude_uv);

// Radiance from a unit direction: the texel that holds it, or bilinear between texel centres (around in longitude, held at
// the poles).
Vec3 radiance(const RgbImage& map, const Vec3& direction, Lookup lookup);

}  // namespace lightband
