#include "frame/budget.h"

#include <algorithm>
#include <cmath>

namespace lightband {
namespace {

uint32_t samples_of(uint32_t bin, double scale, uint32_t least, uint32_t most) {
    const double wanted = scale * std::ldexp(1.0, int(bin) - int(budget_bins) / 2);
    return uint32_t(std::clamp(std::round(wanted), double(least), double(most)));
}

}  // namespace

std::vector<uint32_t> plan_budget(const std::vector<uint64_t>& histogram, double mean, uint32_t most) {
    double pixels = 0;
    for (uint64_t count : histogram) pixels += double(count);
    const uint32_t least = uint32_t(std::clamp(std::floor(mean), 1.0, double(std::min(least_samples, most))));
    const auto total = [&](double scale) {
        double sum = 0;
        for (uint32_t bin = 0; bin < budget_bins; ++bin) sum += double(histogram[bin]) * samples_of(bin, scale, least, most);
        return sum;
    };
    // The total grows with the scale: bisection over its logarithm, to far below the rounding of a sample.
    double low = -64, high = 64;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (total(std::exp2(middle)) <= mean * pixels ? low : high) = middle;
    }
    std::vector<uint32_t> samples(budget_bins);
    for (uint32_t bin = 0; bin < budget_bins; ++bin) samples[bin] = samples_of(bin, std::exp2(low), least, most);
    return samples;
}

}  // namespace lightband
