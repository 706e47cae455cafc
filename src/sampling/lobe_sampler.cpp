#include "sampling/lobe_sampler.h"

#include <algorithm>
#include <cmath>

#include "bandwidth/octahedral.h"
#include "sampling/lobe_grid.h"

namespace lightband {
namespace {

// Turns `cells` non-negative masses over [0, end] into `steps` equally probable intervals that cover it.
void invert(const std::vector<double>& mass, double end, int steps, LobeTable::Step* out) {
    double total = 0;
    for (double m : mass) total += m;
    const double cell_width = end / double(mass.size());
    double before = 0, last = 0;
    size_t cell = 0;
    for (int k = 0; k < steps; ++k) {
        const double target = total * (k + 1) / steps;
        while (cell + 1 < mass.size() && before + mass[cell] < target) before += mass[cell++];
        const double inside = mass[cell] > 0 ? std::min((target - before) / mass[cell], 1.0) : 1.0;
        const double next = k + 1 == steps ? end : (double(cell) + inside) * cell_width;
        out[k] = {float(last), float(next) - float(last)};
        last = float(next);
    }
}

LobeSample sample_table(const LobeTable& table, const Vec3& wo, const Vec2& u) {
    const int view = LobeTable::view_of(wo.z);
    const double scaled_x = u.x * LobeTable::radial;
    const int k = std::min(int(scaled_x), LobeTable::radial - 1);
    const LobeTable::Step xs = table.x[size_t(view * LobeTable::radial + k)];
    const double x = xs.start + (scaled_x - k) * xs.width;

    const double side = u.y < 0.5 ? 1 : -1;
    const double scaled_phi = (u.y < 0.5 ? 2 * u.y : 2 - 2 * u.y) * LobeTable::azimuthal;
    const int l = std::min(int(scaled_phi), LobeTable::azimuthal - 1);
    const LobeTable::Step ps = table.phi[size_t((view * LobeTable::radial + k) * LobeTable::azimuthal + l)];
    const double phi = side * (ps.start + (scaled_phi - l) * ps.width);

    LobeSample result;
    result.half = half_vector(x, phi);
    const double oh = glm::dot(wo, result.half);
    if (oh <= 0) return result;
    result.wi = 2 * oh * result.half - wo;
    if (result.wi.z <= 0) return result;
    const double per_area = 1.0 / (LobeTable::radial * xs.width * 2 * LobeTable::azimuthal * ps.width);
    result.pdf = per_area / solid_angle_density(x, oh);
    return result;
}

// The step of a row of adjoining intervals that holds value.
int step_holding(const LobeTable::Step* steps, int count, double value) {
    int k = 0;
    while (k + 1 < count && value >= double(steps[k + 1].start)) ++k;
    return k;
}

// LobeTable::denser of one view, whose steps of x are known.
void find_denser(const std::vector<double>& most_dense, const LobeTable::Step* xs, float* denser) {
    for (size_t i = 0; i < most_dense.size(); ++i) {
        const double end = double(i + 1) / lobe_rows;
        const int k = step_holding(xs, LobeTable::radial, end);
        const double drawn = std::min((k + (end - xs[k].start) / xs[k].width) / LobeTable::radial, 1.0);
        for (int octave = 0; octave < LobeTable::octaves; ++octave)
            if (most_dense[i] > std::ldexp(1.0, LobeTable::first_octave + octave)) denser[octave] = float(drawn);
    }
}

double pdf_table(const LobeTable& table, const Vec3& wi, const Vec3& wo) {
    const Vec3 h = glm::normalize(wi + wo);
    const double x = std::sqrt(std::atan2(std::hypot(h.x, h.y), h.z) / (pi / 2));
    const double phi = std::abs(std::atan2(h.y, h.x));
    const int view = LobeTable::view_of(wo.z);
    const LobeTable::Step* xs = &table.x[size_t(view * LobeTable::radial)];
    const int k = step_holding(xs, LobeTable::radial, x);
    const LobeTable::Step* ps = &table.phi[size_t((view * LobeTable::radial + k) * LobeTable::azimuthal)];
    const int l = step_holding(ps, LobeTable::azimuthal, phi);
    return 1.0 / (LobeTable::radial * xs[k].width * 2 * LobeTable::azimuthal * ps[l].width) /
           solid_angle_density(x, glm::dot(wo, h));
}

// Visible normals of GGX (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
LobeSample sample_ggx(const Ggx& ggx, const Vec3& wo, const Vec2& u) {
    const Vec3 v = glm::normalize(Vec3(ggx.alpha * wo.x, ggx.alpha * wo.y, wo.z));
    const double r = std::sqrt(u.x), azimuth = 2 * pi * u.y;
    // wo has azimuth 0, so the frame around v is (-v.z, 0, v.x) and +Y.
    const double t1 = r * std::cos(azimuth), s = 0.5 * (1 + v.z);
    const double t2 = (1 - s) * std::sqrt(std::max(0.0, 1 - t1 * t1)) + s * r * std::sin(azimuth);
    const double t3 = std::sqrt(std::max(0.0, 1 - t1 * t1 - t2 * t2));
    const Vec3 n = t1 * Vec3(0, 1, 0) + t2 * Vec3(-v.z, 0, v.x) + t3 * v;
    LobeSample result;
    result.half = glm::normalize(Vec3(ggx.alpha * n.x, ggx.alpha * n.y, std::max(n.z, 0.0)));
    result.wi = 2 * glm::dot(wo, result.half) * result.half - wo;
    return result;
}

double pdf_ggx(const Ggx& ggx, const Vec3& wi, const Vec3& wo) {
    const Vec3 h = glm::normalize(wi + wo);
    const double a2 = ggx.alpha * ggx.alpha, t = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    // D G1(wo) / (4 cos_o), with G1 = 2 cos_o / (cos_o + sqrt(a2 + (1 - a2) cos_o^2)).
    return a2 / (pi * t * t) * 0.5 / (wo.z + std::sqrt(a2 + (1 - a2) * wo.z * wo.z));
}

}  // namespace

int LobeTable::view_of(double cos_outgoing) {
    return std::clamp(int(std::acos(std::clamp(cos_outgoing, 0.0, 1.0)) / (pi / 2) * views), 0, views - 1);
}

LobeTable lobe_table(const Brdf& brdf) {
    LobeTable table;
    table.x.resize(size_t(LobeTable::views) * LobeTable::radial);
    table.phi.resize(table.x.size() * LobeTable::azimuthal);
    table.denser.resize(size_t(LobeTable::views) * LobeTable::octaves);
    const LobeGrids grids(brdf, LobeTable::views, LobeTable::defensive_part);
    for (int view = 0; view < LobeTable::views; ++view) {
        const auto [grid, most_dense, albedo] = grids(view);
        table.albedo.push_back(float(albedo));
        std::vector<double> rows(lobe_rows);
        for (int i = 0; i < lobe_rows; ++i)
            for (int j = 0; j < lobe_columns; ++j) rows[size_t(i)] += grid[size_t(i) * lobe_columns + size_t(j)];
        LobeTable::Step* xs = &table.x[size_t(view) * LobeTable::radial];
        invert(rows, 1.0, LobeTable::radial, xs);
        find_denser(most_dense, xs, &table.denser[size_t(view) * LobeTable::octaves]);
        for (int k = 0; k < LobeTable::radial; ++k) {
            // The azimuth's density over the whole step: rows in proportion to their overlap with it.
            std::vector<double> column(lobe_columns);
            const double first = xs[k].start * lobe_rows, last = (xs[k].start + xs[k].width) * lobe_rows;
            for (int i = int(first); i < lobe_rows && i < last; ++i) {
                const double overlap = std::min(last, i + 1.0) - std::max(first, double(i));
                for (int j = 0; j < lobe_columns; ++j) column[size_t(j)] += overlap * grid[size_t(i) * lobe_columns + size_t(j)];
            }
            invert(column, pi, LobeTable::azimuthal,
                   &table.phi[(size_t(view) * LobeTable::radial + size_t(k)) * LobeTable::azimuthal]);
        }
    }
    return table;
}

LobeImportance lobe_importance(const Brdf& brdf) {
    constexpr int side = LobeImportance::side, supersampling = 4, fine = side * supersampling;
    // A peak narrower than the lookups would be seen by chance; one as wide as a cell is seen where it is.
    Brdf smooth = brdf;
    if (auto* ggx = std::get_if<Ggx>(&smooth)) ggx->alpha = std::max(ggx->alpha, 1.0 / side);
    LobeImportance result;
    result.values.resize(size_t(LobeTable::views) * side * side);
    result.peaks.resize(result.values.size());
    for (int view = 0; view < LobeTable::views; ++view) {
        const double theta = (view + 0.5) / LobeTable::views * pi / 2;
        const Vec3 wo(std::sin(theta), 0, std::cos(theta));
        double albedo = 0;
        for (int y = 0; y < fine; ++y)
            for (int x = 0; x < fine; ++x) {
                const Vec3 wi = HemiOctahedral::to_direction(Vec2(x + 0.5, y + 0.5) / double(fine));
                const double value = luminance(evaluate(smooth, wi, wo)) * wi.z, reach = std::abs(wi.x) + std::abs(wi.y) + wi.z;
                const size_t cell = size_t((view * side + y / supersampling) * side + x / supersampling);
                result.values[cell] += float(value / (supersampling * supersampling));
                result.peaks[cell] = std::max(result.peaks[cell], float(value));
                albedo += value * 2 * reach * reach * reach / (fine * fine);  // the square's point covers 2 reach^3 steradians
            }
        result.albedos.push_back(float(albedo));
    }
    return result;
}

LobeSampler::LobeSampler(const Brdf& brdf) : brdf_(brdf) {
    if (std::holds_alternative<BrdfTable>(brdf)) table_ = lobe_table(brdf);
}

LobeSample LobeSampler::sample(const Vec3& wo, const Vec2& u) const {
    if (!table_.x.empty()) return sample_table(table_, wo, u);
    LobeSample result;
    if (const auto* ggx = std::get_if<Ggx>(&brdf_)) {
        result = sample_ggx(*ggx, wo, u);
    } else {
        const double r = std::sqrt(u.x), phi = 2 * pi * u.y;
        result.wi = Vec3(r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1 - u.x)));
        result.half = glm::normalize(result.wi + wo);
    }
    result.pdf = pdf(result.wi, wo);
    return result;
}

double LobeSampler::pdf(const Vec3& wi, const Vec3& wo) const {
    if (!(wi.z > 0)) return 0;
    if (!table_.x.empty()) return pdf_table(table_, wi, wo);
    if (const auto* ggx = std::get_if<Ggx>(&brdf_)) return pdf_ggx(*ggx, wi, wo);
    return wi.z / pi;
}

}  // namespace lightband
