#include "materials/spectrum.h"

#include <algorithm>
#include <cmath>

namespace lightband {

namespace {

// CIE standard illuminant D65, relative power, every 10 nm (CIE 15:2004, table T.1).
constexpr Spectrum illuminant_d65 = {
    49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
    108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
    90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
    74.3490, 61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};

// One lobe of the fit: a Gaussian whose inverse widths (1/nm) differ on either side of its peak (nm).
double lobe(double wavelength, double height, double peak, double inverse_width_below, double inverse_width_above) {
    const double t = (wavelength - peak) * (wavelength < peak ? inverse_width_below : inverse_width_above);
    return height * std::exp(-0.5 * t * t);
}

// The CIE 1931 colour matching functions in the multi-lobe fit of Wyman, Sloan and Shirley, "Simple Analytic
// Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013, table 1.
Vec3 colour_matching(double nm) {
    return {lobe(nm, 0.362, 442.0, 0.0624, 0.0374) + lobe(nm, 1.056, 599.8, 0.0264, 0.0323) +
                lobe(nm, -0.065, 501.1, 0.0490, 0.0382),
            lobe(nm, 0.821, 568.8, 0.0213, 0.0247) + lobe(nm, 0.286, 530.9, 0.0613, 0.0322),
            lobe(nm, 1.217, 437.0, 0.0845, 0.0278) + lobe(nm, 0.681, 459.0, 0.0385, 0.0725)};
}

// What each wavelength of a reflectance adds to linear RGB. The fit and the 10 nm grid put the white of D65 within 0.1
// percent of the white of the primaries; X, Y and Z are each scaled so that the two coincide.
std::array<Vec3, wavelength_count> rgb_weights() {
    // Linear Rec. 709 to CIE XYZ (IEC 61966-2-1), written column by column: the red, green and blue primaries.
    const glm::dmat3 xyz_of_rgb(Vec3(0.4124, 0.2126, 0.0193), Vec3(0.3576, 0.7152, 0.1192),
                                Vec3(0.1805, 0.0722, 0.9505));
    std::array<Vec3, wavelength_count> weights;
    Vec3 white(0.0);
    for (size_t sample = 0; sample < wavelength_count; ++sample) {
        weights[sample] = illuminant_d65[sample] * colour_matching(wavelength_nm(sample));
        white += weights[sample];
    }
    const glm::dmat3 rgb_of_xyz = glm::inverse(xyz_of_rgb);
    const Vec3 scale = (xyz_of_rgb * Vec3(1.0)) / white;
    for (Vec3& weight : weights) weight = rgb_of_xyz * (weight * scale);
    return weights;
}

}  // namespace

Vec3 spectrum_rgb(const Spectrum& reflectance) {
    static const std::array<Vec3, wavelength_count> weights = rgb_weights();
    Vec3 rgb(0.0);
    for (size_t sample = 0; sample < wavelength_count; ++sample) rgb += weights[sample] * reflectance[sample];
    return rgb;
}

Vec3 with_saturation(const Vec3& rgb, double saturation) {
    return glm::mix(Vec3(luminance(rgb)), rgb, saturation);
}

double saturation_within_unit_cube(const Vec3& rgb) {
    // Black and white leave the cube by the rounding of their sums; their saturation says nothing.
    constexpr double rounding = 1e-12;
    const double grey = luminance(rgb);
    double saturation = 1.0;
    for (int channel = 0; channel < 3; ++channel) {
        if (rgb[channel] < -rounding) saturation = std::min(saturation, (0.0 - grey) / (rgb[channel] - grey));
        if (rgb[channel] > 1.0 + rounding) saturation = std::min(saturation, (1.0 - grey) / (rgb[channel] - grey));
    }
    return saturation;
}

}  // namespace lightband
