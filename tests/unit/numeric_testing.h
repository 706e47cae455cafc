// What the tests of numbers share: closeness with the values in the message, random directions from fixed seeds,
// quantiles.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "base/math.h"
#include "io_testing.h"

namespace lightband::testing {

// A dozen operations in double precision: each rounds by at most 2^-53 = 1.1e-16 of values of about 1.
constexpr double rounding = 1e-14;

inline void check_close(const char* what, double actual, double expected, double tolerance) {
    if (!(std::fabs(actual - expected) <= tolerance))
        fail_msg("%s: %.17g is not within %g of %.17g", what, actual, tolerance, expected);
}

inline void check_at_most(const char* what, double actual, double limit) {
    if (!(actual <= limit)) fail_msg("%s: %.17g exceeds %.17g", what, actual, limit);
}

inline void check_vector(const char* what, const Vec3& actual, const Vec3& expected, double tolerance) {
    for (int c = 0; c < 3; ++c) check_close(what, actual[c], expected[c], tolerance);
}

// The standard's distributions differ between libraries; these numbers do not.
class Random {
public:
    explicit Random(uint64_t seed) : engine_(seed) {}
    double uniform() { return double(engine_() >> 11) * 0x1p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
    uint32_t below(uint32_t limit) { return uint32_t(engine_() % limit); }
    Vec3 direction() {
        const double z = uniform(-1, 1), r = std::sqrt(1 - z * z), phi = uniform(0, 2 * pi);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }
    Vec3 hemisphere() {
        Vec3 d = direction();
        d.z = std::fabs(d.z);
        return d;
    }

private:
    std::mt19937_64 engine_;
};

// The value that a part `part` (0 .. 1) of all values stays below.
inline double percentile(std::vector<double> values, double part) {
    const size_t place = std::min(values.size() - 1, size_t(part * double(values.size())));
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(place), values.end());
    return values[place];
}

// The value that a standard normal variable exceeds with this probability, by bisection.
inline double normal_quantile(double probability) {
    double low = 0, high = 10;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(middle / std::sqrt(2.0)) > probability ? low : high) = middle;
    }
    return low;
}

// The same for chi-square, by the cube root's approximate normality (Wilson and Hilferty 1931); for the hundreds of
// degrees of freedom used here it is good to four digits.
inline double chi_square_quantile(double probability, double degrees) {
    const double spread = 2 / (9 * degrees);
    return degrees * std::pow(1 - spread + normal_quantile(probability) * std::sqrt(spread), 3);
}

}  // namespace lightband::testing
