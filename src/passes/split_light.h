// A map mip-mapped on the octahedral square, so that a sample of a lobe can look up the mean over its footprint (Krivanek and
// Colbert 2008); where the map is sampled too, the mean of what lies under one of several soft ceilings.
#pragma once

#include "scene/light.h"

namespace lightband::passes {

// map: a latitude-longitude texture of map_height rows, its alpha the sampler's density, which is 1 / total times the radiance.
LightLayers split_light(gl::Device& device, const gl::Texture& map, uint32_t map_height, double total, Lookup lookup,
                        LightLayers::Kind kind);

}  // namespace lightband::passes
