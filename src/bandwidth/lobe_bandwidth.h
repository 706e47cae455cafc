// Local angular bandwidth of a BRDF's lobes: for each view, the wavelet bandwidth of f * cos(theta_i) over the incident
// hemisphere (section 2.3, "Reflectance").
#pragma once

#include <vector>

#include "bandwidth/wavelet.h"
#include "scene/brdf.h"

namespace lightband {

struct LobeBandwidth {
    static constexpr int views = 32;  // cos(theta_o) = (view + 0.5) / views
    static constexpr int side = 64;   // hemi-octahedral square of incident directions, in the frame where wo has azimuth 0
    // Lobes are analysed at this resolution, then reduced to the largest value of each side x side cell.
    static constexpr int analysis_side = 256;

    std::vector<float> values;  // views * side * side, cycles/radian

    // The value for unit directions in a local frame where wo has azimuth 0: nearest cell.
    double at(const Vec3& wi, const Vec3& wo) const;
};

// A lobe whose finest wavelet level counts has an unknown, larger bandwidth; the papers store "an arbitrarily large
// value". Finite, so that it can be multiplied: above any frequency a frame can show.
constexpr double unbounded_bandwidth = 1e9;

LobeBandwidth lobe_bandwidth(const Brdf& brdf, BandRule rule);

}  // namespace lightband
