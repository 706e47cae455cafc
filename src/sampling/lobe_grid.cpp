#include "sampling/lobe_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightband {
namespace {

// Neighbouring cells of a table whose values differ by more than this factor may hide light from one lookup in the middle of each cell
// of the grid, which is up to three cells of the table wide. The weight of a sample would be off by as much.
constexpr float uneven_contrast = 4;
// Where they do, so many lookups are made along phi, one for each cell of the table, at as many outgoing angles, from one end of the
// view's interval to the other; and all of them on both sides of the plane of wo and the normal, which a table need not mirror.
constexpr int uneven_lookups = 3, sides = 2;
// Every cell of the grid above the horizon is drawn at least this part as densely as the densest of its neighbours. A step of the
// inverse (src/sampling/lobe_sampler) that crosses an edge would else spread a sliver of the bright side over its dark side.
constexpr double share_of_neighbour = 0.25;

constexpr double infinity = std::numeric_limits<double>::infinity();

double mean(const Vec3& rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

bool differ(float a, float b) { return std::max(a, b) > uneven_contrast * std::max(std::min(a, b), 0.0f); }

// Both directions of the middle of a cell lie above the horizon: a measurement of it could exist.
bool is_above_horizon(uint32_t h, uint32_t d, uint32_t p) {
    const double x = (h + 0.5) / BrdfTable::theta_half_cells, half = x * x * pi / 2;
    const double diff = (d + 0.5) / BrdfTable::theta_diff_cells * pi / 2, phi = (p + 0.5) / BrdfTable::phi_diff_cells * pi;
    return std::cos(diff) * std::cos(half) > std::abs(std::sin(diff) * std::cos(phi) * std::sin(half));
}

// Whether neighbours along theta_diff or phi_diff differ, or mirrored cells, within one row of theta_half.
bool is_uneven(const BrdfTable& table, uint32_t h) {
    const auto value = [&](uint32_t d, uint32_t p) {
        const float* rgb = &table.rgb[BrdfTable::cell(h, d, p) * 3];
        return rgb[0] + rgb[1] + rgb[2];
    };
    for (uint32_t d = 0; d < BrdfTable::theta_diff_cells; ++d)
        for (uint32_t p = 0; p < BrdfTable::phi_diff_cells; ++p) {
            if (!is_above_horizon(h, d, p)) continue;
            const uint32_t next_p = (p + 1) % BrdfTable::phi_diff_cells, next_d = std::min(d + 1, BrdfTable::theta_diff_cells - 1);
            const uint32_t mirrored = BrdfTable::phi_diff_cells - 1 - p;
            if (differ(value(d, p), value(d, mirrored))) return true;
            if (differ(value(d, p), value(d, next_p)) && is_above_horizon(h, d, next_p)) return true;
            if (differ(value(d, p), value(next_d, p)) && is_above_horizon(h, next_d, p)) return true;
        }
    return false;
}

}  // namespace

double solid_angle_density(double x, double oh) { return 4 * oh * std::sin(x * x * pi / 2) * pi * x; }

Vec3 half_vector(double x, double phi) {
    const double theta = x * x * pi / 2;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

LobeGrids::LobeGrids(const Brdf& brdf, int views, double defensive_part)
    : brdf_(brdf), views_(views), defensive_part_(defensive_part), uneven_(lobe_rows) {
    if (const auto* table = std::get_if<BrdfTable>(&brdf))
        for (uint32_t row = 0; row < lobe_rows; ++row)
            uneven_[row] = row % 2 == 0 ? is_uneven(*table, row / 2) : uneven_[row - 1];
}

// Over the grid's cells: root mean squares of what the lookups give, and whether any lies above the horizon; over its rows: the most
// reflected and the least solid angle.
struct LobeGrids::Sums {
    std::vector<double> mass;
    std::vector<bool> above;
    std::vector<double> most_reflected, least_solid_angle;
    double total = 0;  // of the means, over all cells

    void spread();
};

// The variance of the samples that fall into one cell is least where the density follows the root of the mean square.
LobeGrids::Sums LobeGrids::look_up(int view) const {
    constexpr size_t cells = size_t(lobe_rows) * lobe_columns;
    Sums sums{std::vector<double>(cells), std::vector<bool>(cells), std::vector<double>(lobe_rows),
              std::vector<double>(lobe_rows, infinity)};
    for (int i = 0; i < lobe_rows; ++i) {
        const int along = uneven_[size_t(i)] ? uneven_lookups : 1, lookups = along > 1 ? along * along * sides : 1;
        const double x = (i + 0.5) / lobe_rows;
        for (int j = 0; j < lobe_columns; ++j) {
            const size_t cell = size_t(i) * lobe_columns + size_t(j);
            double squares = 0, sum = 0;
            for (int k = 0; k < lookups; ++k) {
                // Angles at both ends of the view's interval, or in its middle alone.
                const double within = along > 1 ? double(k / along % along) / (along - 1) : 0.5;
                const double theta = (view + within) / views_ * pi / 2, phi = (j + (k % along + 0.5) / along) / lobe_columns * pi;
                const Vec3 wo(std::sin(theta), 0, std::cos(theta));
                const Vec3 h = half_vector(x, k < along * along ? phi : -phi);
                const double oh = glm::dot(wo, h);
                if (oh <= 0) continue;
                const Vec3 wi = 2 * oh * h - wo;
                if (wi.z <= 0) continue;
                sums.above[cell] = true;
                const double reflected = mean(evaluate(brdf_, wi, wo)) * wi.z, value = reflected * solid_angle_density(x, oh);
                sum += value;
                squares += value * value;
                sums.most_reflected[size_t(i)] = std::max(sums.most_reflected[size_t(i)], reflected);
                sums.least_solid_angle[size_t(i)] =
                    std::min(sums.least_solid_angle[size_t(i)], solid_angle_density(double(i) / lobe_rows, oh));
            }
            sums.mass[cell] = std::sqrt(squares / lookups);
            sums.total += sum / lookups;
        }
    }
    return sums;
}

// Raises cells towards the densest of the eight around them.
void LobeGrids::Sums::spread() {
    const std::vector<double> own = mass;
    for (int i = 0; i < lobe_rows; ++i)
        for (int j = 0; j < lobe_columns; ++j) {
            const size_t cell = size_t(i) * lobe_columns + size_t(j);
            if (!above[cell]) continue;
            for (int y = std::max(i - 1, 0); y <= std::min(i + 1, lobe_rows - 1); ++y)
                for (int x = std::max(j - 1, 0); x <= std::min(j + 1, lobe_columns - 1); ++x)
                    mass[cell] = std::max(mass[cell], share_of_neighbour * own[size_t(y) * lobe_columns + size_t(x)]);
        }
}

LobeGrid LobeGrids::operator()(int view) const {
    Sums sums = look_up(view);
    sums.spread();
    double total = 0;
    for (const double mass : sums.mass) total += mass;
    // A black lobe is sampled evenly: its samples carry nothing, but they must exist.
    const double even = total > 0 ? total * defensive_part_ / (1 - defensive_part_) : 1.0;
    for (double& mass : sums.mass) mass += even / double(sums.mass.size());
    const double albedo = sums.total * (1.0 / lobe_rows) * (2 * pi / lobe_columns);
    std::vector<double> most_dense(lobe_rows);
    for (size_t i = 0; i < most_dense.size(); ++i) {
        const double followed = albedo > 0 ? (1 - defensive_part_) * sums.most_reflected[i] / albedo : 0;
        most_dense[i] = followed + (albedo > 0 ? defensive_part_ : 1) / (2 * pi) / sums.least_solid_angle[i];
    }
    return {std::move(sums.mass), std::move(most_dense), albedo};
}

}  // namespace lightband
