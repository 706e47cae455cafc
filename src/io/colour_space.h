// Colours of other primaries, converted to those of Rec. 709.
#pragma once

#include <optional>
#include <string>

#include "base/image.h"
#include "base/math.h"

namespace lightband::io {

// CIE (x, y) of the three primaries and of the white that their sum shows.
struct Chromaticities {
    Vec2 red, green, blue, white;
};

constexpr Chromaticities rec709 = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};
// Of files that store CIE XYZ itself; the white is the equal-energy illuminant.
constexpr Chromaticities cie_xyz = {{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};

// The matrix from linear RGB of these primaries to linear Rec. 709. The neutral colour, which is their white where none is
// given, becomes that of Rec. 709 by Bradford's chromatic adaptation (Lam 1985; http://www.brucelindbloom.com, "Chromatic
// Adaptation"). Nothing where the colours are those of Rec. 709 to the digits that headers hold. LB_ERROR_FORMAT where the
// primaries span no colours or a white is none; name stands in the message.
std::optional<glm::dmat3> to_rec709(const Chromaticities& from, const std::optional<Vec2>& neutral, const std::string& name);

// Applies the matrix to every texel. A colour outside the gamut of Rec. 709 has a negative component there: of texels
// that had none before, it becomes 0, and the image's notes say of how many.
void convert_colours(const glm::dmat3& matrix, RgbImage* image);

}  // namespace lightband::io
