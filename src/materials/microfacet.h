// The microfacet lobes: GGX for polished and ground surfaces, "Charlie" for the fuzz of cloth. Each is a distribution
// of normals D and a visibility V = G / (4 cos_i cos_o); the lobe is D * V * reflectance of one facet.
#pragma once

#include <cmath>

#include "base/math.h"
#include "materials/direction_pair.h"

namespace lightband {

// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 33.
inline double ggx_distribution(double cos_half, double alpha) {
    const double cos_squared = cos_half * cos_half;
    const double slope = (1.0 - cos_squared) + alpha * alpha * cos_squared;
    return alpha * alpha / (pi * slope * slope);
}

// Height-correlated Smith shadowing: Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based
// BRDFs", eq. 99 with eq. 72, divided by 4 cos_i cos_o.
inline double ggx_visibility(double cos_i, double cos_o, double alpha) {
    const double alpha_squared = alpha * alpha;
    const double spread_i = std::sqrt(alpha_squared + (1.0 - alpha_squared) * cos_i * cos_i);
    const double spread_o = std::sqrt(alpha_squared + (1.0 - alpha_squared) * cos_o * cos_o);
    return 0.5 / (cos_i * spread_o + cos_o * spread_i);
}

inline double ggx_lobe(const DirectionPair& pair, double alpha) {
    return ggx_distribution(pair.cos_half, alpha) * ggx_visibility(pair.cos_i, pair.cos_o, alpha);
}

// Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF".
inline double charlie_distribution(double cos_half, double roughness) {
    const double sin_half = std::sqrt(1.0 - cos_half * cos_half);
    return (2.0 + 1.0 / roughness) * std::pow(sin_half, 1.0 / roughness) / (2.0 * pi);
}

// The same paper's fit of the Smith function, table 1: the logarithm of Lambda for cosines below one half.
inline double charlie_log_lambda(double cosine, double roughness) {
    const double smooth = (1.0 - roughness) * (1.0 - roughness);
    const auto between = [smooth](double at_0, double at_1) { return smooth * at_0 + (1.0 - smooth) * at_1; };
    const double a = between(25.3245, 21.5473);
    const double b = between(3.32435, 3.82987);
    const double c = between(0.16801, 0.19823);
    const double d = between(-1.27393, -1.97760);
    const double e = between(-4.85967, -4.32054);
    return a / (1.0 + b * std::pow(cosine, c)) + d * cosine + e;
}

// Beyond one half the logarithm is continued by point symmetry.
inline double charlie_lambda(double cosine, double roughness) {
    return cosine < 0.5
               ? std::exp(charlie_log_lambda(cosine, roughness))
               : std::exp(2.0 * charlie_log_lambda(0.5, roughness) - charlie_log_lambda(1.0 - cosine, roughness));
}

// The paper softens the light's side of the shadow border for looks; that would break reciprocity.
inline double charlie_lobe(const DirectionPair& pair, double roughness) {
    const double shadowing =
        1.0 / (1.0 + charlie_lambda(pair.cos_i, roughness) + charlie_lambda(pair.cos_o, roughness));
    return charlie_distribution(pair.cos_half, roughness) * shadowing / (4.0 * pair.cos_i * pair.cos_o);
}

}  // namespace lightband
