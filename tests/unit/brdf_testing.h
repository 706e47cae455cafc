// BRDFs for tests, made by the definition of the table's coordinates.
#pragma once

#include <cmath>

#include "scene/brdf.h"

namespace lightband::testing {

struct Pair {
    Vec3 wi, wo;
};

inline Vec3 turn_about_z(const Vec3& v, double angle) {
    return {std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y, v.z};
}
inline Vec3 turn_about_y(const Vec3& v, double angle) {
    return {std::cos(angle) * v.x + std::sin(angle) * v.z, v.y, std::cos(angle) * v.z - std::sin(angle) * v.x};
}

// The directions of Rusinkiewicz 1998: around the half vector at the pole, the pole then tilted by theta_half.
inline Pair directions_of(double theta_half, double theta_diff, double phi_diff, double phi_half = 0) {
    const auto place = [&](double azimuth) {
        const Vec3 around_pole(std::sin(theta_diff) * std::cos(azimuth), std::sin(theta_diff) * std::sin(azimuth),
                               std::cos(theta_diff));
        return turn_about_z(turn_about_y(around_pole, theta_half), phi_half);
    };
    return {place(phi_diff), place(phi_diff + pi)};
}

// The values of a BRDF at the centres of a table's cells; those that lie below the horizon are not measured.
inline BrdfTable tabulated(const Brdf& brdf) {
    BrdfTable table;
    table.rgb.reserve(BrdfTable::cell_count * 3);
    for (uint32_t h = 0; h < BrdfTable::theta_half_cells; ++h)
        for (uint32_t d = 0; d < BrdfTable::theta_diff_cells; ++d)
            for (uint32_t p = 0; p < BrdfTable::phi_diff_cells; ++p) {
                const double root = (h + 0.5) / BrdfTable::theta_half_cells;
                const Pair pair = directions_of(root * root * pi / 2, (d + 0.5) / BrdfTable::theta_diff_cells * pi / 2,
                                                (p + 0.5) / BrdfTable::phi_diff_cells * pi);
                const bool measured = pair.wi.z > 0 && pair.wo.z > 0;
                const Vec3 value = measured ? evaluate(brdf, pair.wi, pair.wo) : Vec3(-1);
                table.rgb.insert(table.rgb.end(), {float(value.x), float(value.y), float(value.z)});
            }
    return table;
}

}  // namespace lightband::testing
