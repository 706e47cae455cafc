// A reflectance: a table in the MERL layout, Lambert, or GGX. Double precision; the shaders are judged by it.
#pragma once

#include <variant>

#include "base/math.h"
#include "scene/brdf_table.h"

namespace lightband {

struct Lambert {
    Vec3 albedo;
};

// Walter et al. 2007 with height-correlated Smith shadowing (Heitz 2014, eq. 99) and Schlick's Fresnel term.
struct Ggx {
    double alpha;
    Vec3 f0;
};

enum class Lookup { nearest, linear };

using Brdf = std::variant<BrdfTable, Lambert, Ggx>;

// Position in a MERL table, in cells: cell i covers [i, i + 1).
struct TableCoordinates {
    double theta_half, theta_diff, phi_diff;
};
TableCoordinates table_coordinates(const Vec3& wi, const Vec3& wo);

// f(wi, wo), 1/steradian, for unit directions in the local frame; 0 where either lies on or below the horizon.
Vec3 evaluate(const Brdf& brdf, const Vec3& wi, const Vec3& wo, Lookup lookup = Lookup::nearest);

// Directional albedo: the integral of f * cos(theta_i) over wi, for wo at theta_o, by midpoint quadrature over half
// vectors on a grid that resolves a table's cells.
Vec3 directional_albedo(const Brdf& brdf, double theta_o);

}  // namespace lightband
