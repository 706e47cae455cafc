// The map for lookups of footprints (Krivanek and Colbert 2008): on the octahedral square, mip-mapped.
#pragma once

#include "assets/light.h"

namespace lightband {

FootprintLight footprint_light(const Light& light, Lookup lookup, FootprintLight::Kind kind);

}  // namespace lightband
