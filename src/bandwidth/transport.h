// The operators of figure 4 and their composition (eq. 3, 4 and 6), for distant light. Double precision; the shader
// shaders/transport.glsl does the same.
#pragma once

#include <algorithm>
#include <cmath>

namespace lightband {

// Corner of the box that holds a local light field's spectrum: cycles/metre and cycles/radian, both >= 0.
struct Bandwidth {
    double spatial = 0;
    double angular = 0;
};

// Two forms of the reflection operator. The spectrum of distant light that a curved surface shears is a line,
// spatial = c * angular; cutting the angle to the BRDF's bandwidth cuts both components (correlated). The printed operator
// acts on the corner of a box and keeps the spatial part that the BRDF has removed (box).
enum class TransportForm { correlated, box };

struct Reflection {
    double curvature;       // |c|, 1/metre: largest principal curvature
    double cos_incident;    // cosine at the light's side
    double cos_outgoing;    // cosine at the eye's side, > 0
    double lobe_bandwidth;  // rho, cycles/radian
};

// Each shear adds magnitudes: a bound for either sign (figure 4 prints signs, under which a box's corner could cancel).
inline Bandwidth travel(Bandwidth nu, double distance) { return {nu.spatial, nu.angular + distance * nu.spatial}; }
inline Bandwidth bend(Bandwidth nu, double curvature) { return {nu.spatial + curvature * nu.angular, nu.angular}; }

// eq. 3: P_x C_-c S B C_c P_i.
inline Bandwidth reflect(Bandwidth nu, const Reflection& at, TransportForm form) {
    nu.spatial *= at.cos_incident;
    const double kept = std::min(at.lobe_bandwidth, nu.angular);
    if (form == TransportForm::correlated) {
        nu.angular = kept;
        nu = bend(nu, at.curvature);
    } else {
        nu = bend(nu, at.curvature);
        nu.angular = kept;
    }
    nu = bend(nu, at.curvature);
    nu.spatial /= at.cos_outgoing;
    return nu;
}

// eq. 6, cycles per pixel, saturated at what the finest level can show. radians_per_pixel = max(f_x / W, f_y / H).
constexpr double nyquist = 0.5;
inline double image_bandwidth(double angular, double radians_per_pixel) {
    return std::min(angular * radians_per_pixel, nyquist);
}

// Log2 of the spacing at which a picture of this bandwidth may be sampled: spacing <= 1 / (2 b) (Nyquist; eq. 11 prints
// 1 / b). At most coarsest.
inline int shading_level(double bandwidth, int coarsest) {
    if (bandwidth <= 0) return coarsest;
    return int(std::clamp(std::floor(std::log2(nyquist / bandwidth)), 0.0, double(coarsest)));
}

}  // namespace lightband
