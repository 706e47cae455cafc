#include "materials/optical_constants.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lightband {

namespace {

// One line of a published table. The tables reach just beyond both ends of the spectral grid.
struct Measurement {
    double wavelength_nm;
    double n;
    double k;
};

IndexSpectrum interpolated(const std::vector<Measurement>& table) {
    IndexSpectrum spectrum;
    for (size_t sample = 0; sample < wavelength_count; ++sample) {
        const double wavelength = wavelength_nm(sample);
        const auto above = std::find_if(table.begin(), table.end(),
                                        [=](const Measurement& line) { return line.wavelength_nm >= wavelength; });
        const auto below = above - 1;
        const double t = (wavelength - below->wavelength_nm) / (above->wavelength_nm - below->wavelength_nm);
        spectrum[sample] = {below->n + t * (above->n - below->n), below->k + t * (above->k - below->k)};
    }
    return spectrum;
}

}  // namespace

// P. B. Johnson and R. W. Christy, "Optical constants of the noble metals", Phys. Rev. B 6, 4370 (1972).
const IndexSpectrum& index_of_gold() {
    static const IndexSpectrum spectrum =
        interpolated({{367.9, 1.48, 1.895}, {381.5, 1.46, 1.933}, {397.4, 1.47, 1.952}, {413.3, 1.46, 1.958},
                      {430.5, 1.45, 1.948}, {450.9, 1.38, 1.914}, {471.4, 1.31, 1.849}, {495.9, 1.04, 1.833},
                      {520.9, 0.62, 2.081}, {548.6, 0.43, 2.455}, {582.1, 0.29, 2.863}, {616.8, 0.21, 3.272},
                      {659.5, 0.14, 3.697}, {704.5, 0.13, 4.103}, {756.0, 0.14, 4.542}, {821.1, 0.16, 5.083}});
    return spectrum;
}

// The same paper.
const IndexSpectrum& index_of_copper() {
    static const IndexSpectrum spectrum =
        interpolated({{367.9, 1.36, 1.975}, {381.5, 1.33, 2.045}, {397.4, 1.32, 2.116}, {413.3, 1.28, 2.207},
                      {430.5, 1.25, 2.305}, {450.9, 1.24, 2.397}, {471.4, 1.25, 2.483}, {495.9, 1.22, 2.564},
                      {520.9, 1.18, 2.608}, {548.6, 1.02, 2.577}, {582.1, 0.70, 2.704}, {616.8, 0.30, 3.205},
                      {659.5, 0.22, 3.747}, {704.5, 0.21, 4.205}, {756.0, 0.24, 4.665}, {821.1, 0.26, 5.180}});
    return spectrum;
}

// P. B. Johnson and R. W. Christy, "Optical constants of transition metals: Ti, V, Cr, Mn, Fe, Co, Ni, and Pd",
// Phys. Rev. B 9, 5056 (1974).
const IndexSpectrum& index_of_nickel() {
    static const IndexSpectrum spectrum =
        interpolated({{368.0, 1.70, 2.40}, {381.0, 1.72, 2.48}, {397.0, 1.72, 2.57}, {413.0, 1.70, 2.69},
                      {431.0, 1.71, 2.82}, {451.0, 1.73, 2.95}, {471.0, 1.78, 3.09}, {496.0, 1.82, 3.25},
                      {521.0, 1.85, 3.42}, {549.0, 1.92, 3.61}, {582.0, 1.96, 3.80}, {617.0, 1.99, 4.02},
                      {659.0, 1.99, 4.26}, {704.0, 2.06, 4.50}, {756.0, 2.13, 4.73}, {821.0, 2.26, 4.97}});
    return spectrum;
}

// The same paper.
const IndexSpectrum& index_of_chromium() {
    static const IndexSpectrum spectrum =
        interpolated({{368.0, 1.87, 2.69}, {381.0, 1.92, 2.74}, {397.0, 2.00, 2.83}, {413.0, 2.08, 2.93},
                      {431.0, 2.19, 3.04}, {451.0, 2.33, 3.14}, {471.0, 2.51, 3.24}, {496.0, 2.75, 3.30},
                      {521.0, 2.94, 3.33}, {549.0, 3.18, 3.33}, {582.0, 3.22, 3.30}, {617.0, 3.17, 3.30},
                      {659.0, 3.09, 3.34}, {704.0, 3.05, 3.39}, {756.0, 3.08, 3.42}, {821.0, 3.20, 3.48}});
    return spectrum;
}

// A. D. Rakic, "Algorithm for the determination of intrinsic optical constants of metal films: application to
// aluminum", Appl. Opt. 34, 4755 (1995).
const IndexSpectrum& index_of_aluminium() {
    static const IndexSpectrum spectrum =
        interpolated({{364.66, 0.39877, 4.3957}, {413.28, 0.52135, 5.0008}, {442.80, 0.60790, 5.3676},
                      {476.87, 0.72780, 5.7781}, {516.60, 0.87340, 6.2418}, {563.57, 1.0728, 6.7839},
                      {619.93, 1.3660, 7.4052},  {652.25, 1.5724, 7.7354},  {688.81, 1.8301, 8.0601},
                      {729.32, 2.1606, 8.3565},  {774.91, 2.6154, 8.4914},  {794.78, 2.7675, 8.3866}});
    return spectrum;
}

// M. J. Dodge, "Refractive properties of magnesium fluoride", Appl. Opt. 23, 1980 (1984): the Sellmeier equation
// n^2 - 1 = sum of B lambda^2 / (lambda^2 - C^2) for the ordinary ray, lambda in micrometres.
const IndexSpectrum& index_of_magnesium_fluoride() {
    static const IndexSpectrum spectrum = [] {
        constexpr double strength[3] = {0.48755108, 0.39875031, 2.3120353};
        constexpr double resonance_um[3] = {0.04338408, 0.09461442, 23.793604};
        IndexSpectrum result;
        for (size_t sample = 0; sample < wavelength_count; ++sample) {
            const double um = 1e-3 * wavelength_nm(sample);
            double index_squared = 1.0;
            for (int term = 0; term < 3; ++term)
                index_squared += strength[term] * um * um / (um * um - resonance_um[term] * resonance_um[term]);
            result[sample] = std::sqrt(index_squared);
        }
        return result;
    }();
    return spectrum;
}

}  // namespace lightband
