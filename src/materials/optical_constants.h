// Measured refractive indices over the visible range, 380 to 780 nm.
#pragma once

#include "materials/optics.h"
#include "materials/spectrum.h"

namespace lightband {

// The index n + i k at each wavelength of the spectral grid, interpolated linearly between the published values.
using IndexSpectrum = std::array<RefractiveIndex, wavelength_count>;

const IndexSpectrum& index_of_aluminium();
const IndexSpectrum& index_of_chromium();
const IndexSpectrum& index_of_copper();
const IndexSpectrum& index_of_gold();
const IndexSpectrum& index_of_magnesium_fluoride();
const IndexSpectrum& index_of_nickel();

}  // namespace lightband
