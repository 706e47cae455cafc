// Values for the cells of a measured table that its measurement left out.
#pragma once

#include <cstddef>

#include "base/math.h"
#include "scene/brdf_table.h"

namespace lightband {

// Cells without a measured value that light and eye above the horizon can reach.
struct UnmeasuredCells {
    size_t filled = 0;
    size_t left = 0;  // nothing was measured that they could be filled from; they still reflect nothing
};

// Fills cells along their arc, the cells of one theta_half and one phi_diff in the order of theta_diff: between two
// measured cells linearly; before the first and after the last, towards grazing, with that cell's value. It does not
// grow towards grazing, as a microfacet lobe's would: how steeply cannot be told from unreliable cells, and a matte
// surface would reflect more than it receives. An arc without any measured cell takes the values of the next smaller
// theta_half if its own exceeds grazing_half_angle.
//
// Measurements leave out the last degrees before grazing, or are not reliable there: Ngan, Durand and Matusik 2005,
// "Experimental Analysis of BRDF Models", use none beyond 80 degrees.
UnmeasuredCells fill_unmeasured_cells(BrdfTable& table);

// Radians. Light and eye are then on average within 20 degrees of the horizon, far from the highlight, so that a lobe
// changes little from one theta_half to the next.
constexpr double grazing_half_angle = 70 * pi / 180;

}  // namespace lightband
