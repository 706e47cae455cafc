// The map for lookups of footprints (Krivanek and Colbert 2008): on the octahedral square, mip-mapped.
#pragma once

#include "assets/light.h"

namespace lightband {

// map: as Light::texture() holds it; total: the integral of its radiance over the sphere.
FootprintLight footprint_light(gl::Device& device, const gl::Texture& map, uint32_t map_height, double total, Lookup lookup,
                               FootprintLight::Kind kind);

}  // namespace lightband
