// An isotropic reflectance tabulated in the MERL layout (Matusik et al. 2003): cells of (theta_half, theta_diff,
// phi_diff), theta_half quadratic, phi_diff folded to [0, pi) by reciprocity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lightband {

// Under one of the smallest cells 2e6 per steradian would reflect all light; prediction and noise square what is reflected, and up to here,
// under the brightest map (largest_radiance), the squares of what a sample brings stay within float.
constexpr float largest_reflectance = 1e9f;

struct BrdfTable {
    static constexpr uint32_t theta_half_cells = 90;
    static constexpr uint32_t theta_diff_cells = 90;
    static constexpr uint32_t phi_diff_cells = 180;
    static constexpr size_t cell_count = size_t(theta_half_cells) * theta_diff_cells * phi_diff_cells;

    // cell_count * 3, RGB interleaved, 1/steradian. A cell that was not measured, or that lies below the
    // horizon as a whole, holds -1 in all three channels.
    std::vector<float> rgb;

    static constexpr size_t cell(uint32_t theta_half, uint32_t theta_diff, uint32_t phi_diff) {
        return (size_t(theta_half) * theta_diff_cells + theta_diff) * phi_diff_cells + phi_diff;
    }
};

}  // namespace lightband
