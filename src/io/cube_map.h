// OpenEXR's cube maps, resampled.
#pragma once

#include <string>

#include "base/image.h"

namespace lightband::io {

// A latitude-longitude map of the light of a cube map: six square faces, one below the other, in the order and orientation
// of ImfEnvmap.h (+X, -X, +Y, -Y, +Z, -Z). As there, texels along the edges of a face are centred on the edges; between
// texels the cube is bilinear. Each texel of the result is the mean over its solid angle.
// LB_ERROR_FORMAT where the picture is not six times as high as it is wide.
RgbImage from_cube_map(const RgbImage& cube, const std::string& name);

}  // namespace lightband::io
