// The shading integral of one pixel (eq. 1) by brute force, in double precision and without OpenGL: what the renderers
// are judged by.
#pragma once

#include "base/image.h"
#include "base/math.h"
#include "scene/brdf.h"

namespace lightband {

struct ShadingPoint {
    Vec3 normal;  // unit, world
    Vec3 wo;      // unit, world, towards the eye
};

struct OracleSettings {
    Lookup brdf_lookup = Lookup::nearest;
    Lookup environment_lookup = Lookup::linear;
    // The sphere is cut into (2 * rows) x rows cells of equal latitude and longitude, each evaluated at its centre.
    int rows = 512;
};

// Radiance towards the eye under the map, by midpoint quadrature over the sphere of light: it shares no sampler with the
// renderers.
Vec3 reflected_radiance(const Brdf& brdf, const RgbImage& map, const ShadingPoint& point,
                        const OracleSettings& settings = {});

}  // namespace lightband
