// Where the cells of a MERL table lie, and which of them a light and an eye above the horizon can reach.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/math.h"
#include "scene/brdf_table.h"

namespace lightband {

// Angles of Rusinkiewicz 1998, radians.
struct TableAngles {
    double theta_half, theta_diff, phi_diff;

    // The smaller of the cosines of the light and of the eye to the normal: negative below the horizon.
    double lower_cosine() const {
        return std::cos(theta_half) * std::cos(theta_diff) -
               std::sin(theta_half) * std::sin(theta_diff) * std::fabs(std::cos(phi_diff));
    }
};

// One cell of the table. Its diagonal starts at the corner that lies highest above the horizon, where both polar angles
// are smallest and phi_diff is nearest to 90 degrees, passes the centre at 1/2 and ends at the lowest corner at 1.
struct TableCell {
    uint32_t theta_half, theta_diff, phi_diff;

    static TableCell numbered(size_t cell) {
        constexpr size_t phi_cells = BrdfTable::phi_diff_cells, diff_cells = BrdfTable::theta_diff_cells;
        return {uint32_t(cell / phi_cells / diff_cells), uint32_t(cell / phi_cells % diff_cells),
                uint32_t(cell % phi_cells)};
    }

    TableAngles on_diagonal(double t) const {
        const double root = (theta_half + t) / BrdfTable::theta_half_cells;
        const double phi = phi_diff < BrdfTable::phi_diff_cells / 2 ? phi_diff + 1 - t : phi_diff + t;
        return {root * root * pi / 2, (theta_diff + t) / BrdfTable::theta_diff_cells * pi / 2,
                phi / BrdfTable::phi_diff_cells * pi};
    }

    TableAngles centre() const { return on_diagonal(0.5); }

    // Whether any light and eye above the horizon fall into the cell.
    bool reaches_above_horizon() const { return on_diagonal(0).lower_cosine() > 0; }

    // The centre; where that lies below the horizon, the middle of the part of the diagonal above it. For cells that
    // reach above the horizon.
    TableAngles representative() const {
        if (centre().lower_cosine() > 0) return centre();
        constexpr int halvings = 40;  // of a half: the horizon to 5e-13 of the diagonal
        double above = 0, below = 0.5;
        for (int i = 0; i < halvings; ++i) {
            const double middle = (above + below) / 2;
            (on_diagonal(middle).lower_cosine() > 0 ? above : below) = middle;
        }
        return on_diagonal(above / 2);
    }
};

}  // namespace lightband
