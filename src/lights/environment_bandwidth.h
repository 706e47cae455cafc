// Instant bandwidth of a map (section 2.3): onto the octahedral square, through Daubechies-4 wavelets, to
// cycles/radian.
#pragma once

#include "lights/environment.h"

namespace lightband {

// map: a latitude-longitude texture of map_height rows. Runs on the GPU; costs milliseconds.
EnvironmentBandwidth environment_bandwidth(gl::Device& device, const gl::Texture& map, uint32_t map_height,
                                           BandRule rule);

}  // namespace lightband
