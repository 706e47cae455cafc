// The density that a table's sampler follows, on a grid over half vectors, before it is inverted (src/sampling/lobe_sampler).
#pragma once

#include <vector>

#include "scene/brdf.h"

namespace lightband {

// Cells of the grid: theta_half = x^2 * pi / 2 for x in [0, 1], two rows to a row of the table; phi in [0, pi].
constexpr int lobe_rows = 2 * int(BrdfTable::theta_half_cells);
constexpr int lobe_columns = 64;

// d(wi) / d(x, phi): solid angle of wi for a unit of x and of phi. oh: the cosine between wo and the half vector.
double solid_angle_density(double x, double oh);
Vec3 half_vector(double x, double phi);

struct LobeGrid {
    std::vector<double> mass;        // lobe_rows * lobe_columns: what the density is proportional to, defensive part included
    std::vector<double> most_dense;  // of each row: the sampler's density, at most, per steradian
    double albedo;                   // integral of mean(f) cos(theta_i)
};

// A table's density for outgoing angles in steps of pi / 2 / views.
class LobeGrids {
public:
    LobeGrids(const Brdf& brdf, int views, double defensive_part);
    LobeGrid operator()(int view) const;

private:
    struct Sums;
    Sums look_up(int view) const;

    const Brdf& brdf_;
    const int views_;
    const double defensive_part_;
    std::vector<bool> uneven_;  // of each row of the grid
};

}  // namespace lightband
