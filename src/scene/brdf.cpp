#include "scene/brdf.h"

#include <algorithm>
#include <cmath>

namespace lightband {
namespace {

constexpr double half_cells = BrdfTable::theta_half_cells;
constexpr double diff_cells = BrdfTable::theta_diff_cells;
constexpr double phi_cells = BrdfTable::phi_diff_cells;

// Angle of a unit vector to +Z, exact for small angles where acos loses half its digits.
double polar_angle(const Vec3& v) { return std::atan2(std::hypot(v.x, v.y), v.z); }

Vec3 cell_value(const BrdfTable& table, int h, int d, int p, bool* measured) {
    const float* rgb = &table.rgb[BrdfTable::cell(uint32_t(h), uint32_t(d), uint32_t(p)) * 3];
    *measured = rgb[0] >= 0;
    return *measured ? Vec3(rgb[0], rgb[1], rgb[2]) : Vec3(0);
}

Vec3 nearest_cell(const BrdfTable& table, const TableCoordinates& at) {
    const int h = std::min(int(at.theta_half), int(half_cells) - 1);
    const int d = std::min(int(at.theta_diff), int(diff_cells) - 1);
    const int p = std::min(int(at.phi_diff), int(phi_cells) - 1);
    bool measured;
    return cell_value(table, h, d, p, &measured);
}

// Trilinear between cell centres; cells that were not measured have no weight. phi_diff is periodic, the polar
// angles end at their outermost centres.
Vec3 between_cells(const BrdfTable& table, const TableCoordinates& at) {
    const double h = std::clamp(at.theta_half - 0.5, 0.0, half_cells - 1);
    const double d = std::clamp(at.theta_diff - 0.5, 0.0, diff_cells - 1);
    const double p = at.phi_diff - 0.5;
    const int h0 = std::min(int(h), int(half_cells) - 2), d0 = std::min(int(d), int(diff_cells) - 2);
    const int p0 = int(std::floor(p));
    Vec3 sum(0);
    double weights = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int dh = corner & 1, dd = corner >> 1 & 1, dp = corner >> 2;
        const double weight = (dh ? h - h0 : 1 - (h - h0)) * (dd ? d - d0 : 1 - (d - d0)) *
                              (dp ? p - p0 : 1 - (p - p0));
        const int phi = (p0 + dp + int(phi_cells)) % int(phi_cells);
        bool measured;
        const Vec3 value = cell_value(table, h0 + dh, d0 + dd, phi, &measured);
        if (measured) {
            sum += weight * value;
            weights += weight;
        }
    }
    return weights > 0 ? sum / weights : Vec3(0);
}

Vec3 evaluate_ggx(const Ggx& ggx, const Vec3& wi, const Vec3& wo) {
    const Vec3 h = glm::normalize(wi + wo);
    const double a2 = ggx.alpha * ggx.alpha;
    // h.z^2 (a2 - 1) + 1, written so that a mirror's peak does not cancel.
    const double t = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    const double d = a2 / (pi * t * t);
    const double si = std::sqrt(a2 + (1 - a2) * wi.z * wi.z), so = std::sqrt(a2 + (1 - a2) * wo.z * wo.z);
    const double visibility = 0.5 / (wo.z * si + wi.z * so);  // G / (4 cos_i cos_o)
    const double c = 1 - glm::dot(wi, h);
    const Vec3 fresnel = ggx.f0 + (Vec3(1) - ggx.f0) * (c * c * c * c * c);
    return d * visibility * fresnel;
}

}  // namespace

TableCoordinates table_coordinates(const Vec3& wi, const Vec3& wo) {
    const Vec3 h = glm::normalize(wi + wo);
    const double theta_half = polar_angle(h);
    const double theta_diff = std::atan2(glm::length(wi - wo), glm::length(wi + wo));
    // In the half vector's frame; both arguments carry the factor sin(theta_half), and vanish together at the pole,
    // where the azimuth has no meaning and atan2 gives 0.
    double phi = std::atan2(wi.y * h.x - wi.x * h.y, h.z * glm::dot(wi, h) - wi.z);
    if (phi < 0) phi += pi;
    if (phi >= pi) phi -= pi;
    return {std::sqrt(theta_half / (pi / 2)) * half_cells, theta_diff / (pi / 2) * diff_cells, phi / pi * phi_cells};
}

Vec3 evaluate(const Brdf& brdf, const Vec3& wi, const Vec3& wo, Lookup lookup) {
    if (!(wi.z > 0) || !(wo.z > 0)) return Vec3(0);
    if (const auto* table = std::get_if<BrdfTable>(&brdf)) {
        const TableCoordinates at = table_coordinates(wi, wo);
        return lookup == Lookup::nearest ? nearest_cell(*table, at) : between_cells(*table, at);
    }
    if (const auto* lambert = std::get_if<Lambert>(&brdf)) return lambert->albedo / pi;
    return evaluate_ggx(std::get<Ggx>(brdf), wi, wo);
}

Vec3 directional_albedo(const Brdf& brdf, double theta_o) {
    // Half vectors with theta_half = x^2 * pi / 2 as in the table: steps shrink towards the mirror direction.
    constexpr int radial = 1440, azimuthal = 360;
    const Vec3 wo(std::sin(theta_o), 0, std::cos(theta_o));
    Vec3 sum(0);
    for (int i = 0; i < radial; ++i) {
        const double x = (i + 0.5) / radial, theta = x * x * pi / 2;
        const double area = std::sin(theta) * pi * x / radial * (2 * pi / azimuthal);
        for (int j = 0; j < azimuthal; ++j) {
            const double phi = (j + 0.5) * 2 * pi / azimuthal;
            const Vec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            const double oh = glm::dot(wo, h);
            if (oh <= 0) continue;
            const Vec3 wi = 2 * oh * h - wo;
            sum += evaluate(brdf, wi, wo) * (std::max(wi.z, 0.0) * 4 * oh * area);
        }
    }
    return sum;
}

}  // namespace lightband
