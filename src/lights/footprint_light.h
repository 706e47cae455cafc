// The map for lookups of footprints (Krivanek and Colbert 2008): on the octahedral square, mip-mapped.
#pragma once

#include "lights/environment.h"

namespace lightband {

FootprintLight footprint_light(const EnvironmentLight& light, Lookup lookup, FootprintLight::Kind kind);

}  // namespace lightband
