#include "io/display.h"

#include <algorithm>
#include <cmath>

namespace lightband::io {
namespace {

// Hable's constants: shoulder strength, linear strength, linear angle, toe strength, toe numerator, toe denominator.
constexpr double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
constexpr double limit = 1 - E / F;  // of the curve at infinite light

double hable(double x) { return (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F; }

// Where the curve passes through mid-grey: the positive root of hable(x) = 0.18 limit, which is a quadratic equation.
constexpr double mid_grey = 0.18;
const double mid_grey_at = [] {
    const double g = mid_grey * limit + E / F;
    const double a = A * (1 - g), b = C * B - g * B, c = D * E - g * D * F;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}();

uint8_t eight_bits(double value) { return uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

// IEC 61966-2-1.
double srgb(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

}  // namespace

double filmic(double radiance) {
    // Beyond, the curve is within 1e-12 of 1, and squares would overflow later on.
    constexpr double brightest = 1e12;
    return hable(std::clamp(radiance, 0.0, brightest) * (mid_grey_at / mid_grey)) / limit;
}

std::vector<uint8_t> to_srgb(const float* rgba, size_t pixels, const Display& display) {
    const double gain = std::exp2(display.exposure);
    std::vector<uint8_t> bytes(pixels * 4);
    for (size_t i = 0; i < bytes.size(); i += 4) {
        const double coverage = rgba[i + 3];
        const bool partial = coverage > 0 && coverage < 1 && !display.opaque;
        for (size_t c = 0; c < 3; ++c) {
            const double value = gain * rgba[i + c] / (partial ? coverage : 1);
            bytes[i + c] = eight_bits(srgb(display.tone_curve == ToneCurve::filmic ? filmic(value) : value));
        }
        bytes[i + 3] = display.opaque ? 255 : eight_bits(coverage);
    }
    return bytes;
}

}  // namespace lightband::io
