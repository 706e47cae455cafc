// Two directions at an isotropic surface as the four cosines that its models ask for. Exchanging the light and the eye
// exchanges cos_i and cos_o and leaves the rest: a model symmetric in those two is reciprocal.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace lightband {

struct DirectionPair {
    double cos_half;  // normal and half vector
    double cos_diff;  // half vector and either direction
    double cos_i;     // normal and light
    double cos_o;     // normal and eye

    bool above_horizon() const { return cos_i > 0.0 && cos_o > 0.0; }

    // Unit vectors in the local frame.
    static DirectionPair from_directions(const Vec3& wi, const Vec3& wo) {
        return from_cosines(wi.z, wo.z, glm::dot(wi, wo));
    }

    // Angles of Rusinkiewicz 1998, "A New Change of Variables for Efficient BRDF Representation". The light is the
    // half vector's pole turned by (theta_diff, phi_diff), the eye its mirror image.
    static DirectionPair from_angles(double theta_half, double theta_diff, double phi_diff) {
        const double along = std::cos(theta_half) * std::cos(theta_diff);
        const double across = std::sin(theta_half) * std::sin(theta_diff) * std::cos(phi_diff);
        return {std::cos(theta_half), std::cos(theta_diff), along - across, along + across};
    }

    // The same pair inside a flat clear coat of this refractive index (Snell's law: what lies along the surface
    // shrinks by the index, at unchanged azimuth).
    DirectionPair refracted(double index) const {
        const double squared = index * index;
        const double inside_i = std::sqrt(1.0 - (1.0 - cos_i * cos_i) / squared);
        const double inside_o = std::sqrt(1.0 - (1.0 - cos_o * cos_o) / squared);
        const double between = 2.0 * cos_diff * cos_diff - 1.0;
        return from_cosines(inside_i, inside_o, inside_i * inside_o + (between - cos_i * cos_o) / squared);
    }

private:
    // between: cosine of the angle between light and eye, twice theta_diff. The half vector's length is 2 cos_diff;
    // where the directions oppose each other it vanishes and cos_half, the quotient, may round to just above 1.
    static DirectionPair from_cosines(double cos_i, double cos_o, double between) {
        const double cos_diff = std::sqrt(std::max(0.0, 0.5 * (1.0 + std::min(between, 1.0))));
        const double cos_half = cos_diff > 0.0 ? std::min(0.5 * (cos_i + cos_o) / cos_diff, 1.0) : 0.0;
        return {cos_half, cos_diff, cos_i, cos_o};
    }
};

}  // namespace lightband
