#include "materials/optics.h"

#include <cmath>

#include "base/math.h"

namespace lightband {

namespace {

// A medium at one direction of propagation: the square of its index and the normal component q of the wave vector,
// in units of the wave number of vacuum. The principal root has Re q, Im q >= 0: the wave travels and fades inwards.
struct Wave {
    RefractiveIndex index_squared;
    std::complex<double> normal;

    Wave(RefractiveIndex index, double tangential_squared)
        : index_squared(index * index), normal(std::sqrt(index_squared - tangential_squared)) {}
};

struct Amplitudes {
    std::complex<double> perpendicular;
    std::complex<double> parallel;
};

// Fresnel's amplitude coefficients (Born and Wolf, Principles of Optics, sec. 1.5.2, written with q).
Amplitudes interface_amplitudes(const Wave& from, const Wave& to) {
    const std::complex<double> a = to.index_squared * from.normal;
    const std::complex<double> b = from.index_squared * to.normal;
    return {(from.normal - to.normal) / (from.normal + to.normal), (a - b) / (a + b)};
}

// Airy's sum over the reflections inside a film (Born and Wolf, sec. 7.6, eq. 7.6.9): front is the coefficient of its
// upper interface, back that of everything below, phase the factor of one round trip.
std::complex<double> airy_sum(std::complex<double> front, std::complex<double> back, std::complex<double> phase) {
    return (front + back * phase) / (1.0 + front * back * phase);
}

}  // namespace

double film_stack_reflectance(double cos_incident, double incident_index, const std::vector<ThinFilm>& films,
                              RefractiveIndex substrate_index, double wavelength_nm) {
    if (cos_incident == 0.0) return 1.0;  // the limit of every interface at grazing incidence
    const double tangential_squared = incident_index * incident_index * (1.0 - cos_incident * cos_incident);
    Wave below(substrate_index, tangential_squared);
    Amplitudes reflected{0.0, 0.0};
    std::complex<double> phase = 0.0;
    for (size_t level = films.size() + 1; level-- > 0;) {
        const Wave above(level == 0 ? RefractiveIndex(incident_index) : films[level - 1].index, tangential_squared);
        const Amplitudes front = interface_amplitudes(above, below);
        reflected = {airy_sum(front.perpendicular, reflected.perpendicular, phase),
                     airy_sum(front.parallel, reflected.parallel, phase)};
        if (level > 0) {
            const std::complex<double> i(0.0, 1.0);
            phase = std::exp(i * (4.0 * pi * films[level - 1].thickness_nm / wavelength_nm) * above.normal);
        }
        below = above;
    }
    return 0.5 * (std::norm(reflected.perpendicular) + std::norm(reflected.parallel));
}

double fresnel_reflectance(double cos_incident, double incident_index, RefractiveIndex transmitted_index) {
    constexpr double any_wavelength = 1.0;  // there is no film whose thickness it could be compared with
    return film_stack_reflectance(cos_incident, incident_index, {}, transmitted_index, any_wavelength);
}

double diffuse_fresnel_reflectance(double index) {
    constexpr int steps = 1024;  // midpoint rule in sin^2(theta)
    double sum = 0.0;
    for (int step = 0; step < steps; ++step) {
        const double sin_squared = (step + 0.5) / steps;
        sum += fresnel_reflectance(std::sqrt(1.0 - sin_squared), 1.0, index);
    }
    return sum / steps;
}

}  // namespace lightband
