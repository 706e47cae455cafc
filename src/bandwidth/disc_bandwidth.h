// Bandwidth of a disc of uniform radiance (section 2.3), in closed form.
#pragma once

#include "bandwidth/wavelet.h"
#include "base/math.h"

namespace lightband {

// Cycles/radian. A disc of radius a has the spectrum 2 J1(x) / x with x = 2 pi a nu (Airy 1835). The rule "energy" asks
// for the frequency below which 95 % of the energy lies, where J0^2 + J1^2 = 0.05, for large x 2 / (pi x): x = 12.7.
// "sum" asks for that from which no amplitude exceeds 0.01 of the largest; the amplitude's envelope is sqrt(8 / pi)
// x^-1.5: x = 29.4.
inline double disc_bandwidth(double angular_radius, BandRule rule) {
    const double x = rule == BandRule::energy ? 12.7 : 29.4;
    return x / (2 * pi * angular_radius);
}

}  // namespace lightband
