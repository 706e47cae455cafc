// Reflection at smooth interfaces: between two media, and at a stack of thin films. Refractive indices are
// n + i k with k > 0 absorbing; light is unpolarised; the incident medium does not absorb.
#pragma once

#include <complex>
#include <vector>

namespace lightband {

using RefractiveIndex = std::complex<double>;

struct ThinFilm {
    RefractiveIndex index;
    double thickness_nm;
};

// Fresnel's reflectance of the interface. cos_incident in [0, 1].
double fresnel_reflectance(double cos_incident, double incident_index, RefractiveIndex transmitted_index);

// Airy's reflectance of films, listed from the incident medium inwards, on a substrate.
double film_stack_reflectance(double cos_incident, double incident_index, const std::vector<ThinFilm>& films,
                              RefractiveIndex substrate_index, double wavelength_nm);

// Fresnel's reflectance averaged over a diffuse (cosine-weighted) hemisphere of light in air above a dielectric.
double diffuse_fresnel_reflectance(double index);

}  // namespace lightband
