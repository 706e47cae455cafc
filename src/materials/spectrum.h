// From a reflectance spectrum to linear RGB with Rec. 709 primaries: what the CIE 1931 observer sees under D65.
#pragma once

#include <array>
#include <cstddef>

#include "base/math.h"

namespace lightband {

// Samples of the visible range: 380, 390 ... 780 nm, the grid on which the CIE publishes illuminant D65.
constexpr size_t wavelength_count = 41;
using Spectrum = std::array<double, wavelength_count>;

constexpr double wavelength_nm(size_t sample) { return 380.0 + 10.0 * double(sample); }

// The perfect reflector is (1, 1, 1). A saturated spectrum lies outside the triangle of the primaries: a channel can be
// negative or, for bright metals such as gold, above 1.
Vec3 spectrum_rgb(const Spectrum& reflectance);

// The colour of the same luminance on the way from grey (saturation 0) to rgb (saturation 1).
Vec3 with_saturation(const Vec3& rgb, double saturation);

// The largest saturation, at most 1, with which every channel lies in [0, 1]. The luminance must lie there.
double saturation_within_unit_cube(const Vec3& rgb);

}  // namespace lightband
