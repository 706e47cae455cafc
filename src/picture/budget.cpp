#include "picture/budget.h"

#include <algorithm>
#include <cmath>

namespace lightband {
namespace {

Budget budget_at(double scale, uint32_t least, uint32_t most) {
    Budget budget(budget_bins);
    for (uint32_t bin = 0; bin < budget_bins; ++bin)
        budget[bin] = uint32_t(std::clamp(std::round(scale * share_of(bin)), double(least), double(most)));
    return budget;
}

// The largest scale at which a condition that holds for small scales still holds: bisection over its logarithm, to far
// below the rounding of a sample.
template <class Condition>
double largest_scale(Condition holds) {
    double low = -64, high = 64;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (holds(std::exp2(middle)) ? low : high) = middle;
    }
    return std::exp2(low);
}

}  // namespace

double share_of(uint32_t bin) {
    return std::exp2((double(bin) - share_one) / bins_per_octave);
}

Budget plan_mean(const Histogram& histogram, double mean, uint32_t most) {
    double pixels = 0;
    for (uint64_t count : histogram) pixels += double(count);
    const uint32_t least = uint32_t(std::clamp(std::floor(mean), 1.0, double(std::min(least_samples, most))));
    const double scale = largest_scale([&](double candidate) {
        const Budget budget = budget_at(candidate, least, most);
        double sum = 0;
        for (uint32_t bin = 0; bin < budget_bins; ++bin) sum += double(histogram[bin]) * budget[bin];
        return sum <= mean * pixels;
    });
    return budget_at(scale, least, most);
}

double predicted_noise(const Histogram& histogram, const Budget& budget, Allocation allocation) {
    double sum = 0;
    for (uint32_t bin = 0; bin < budget_bins; ++bin) {
        const double share = share_of(bin);
        sum += double(histogram[bin]) * (allocation == Allocation::least_error ? share * share : share) / budget[bin];
    }
    return sum;
}

Budget plan_noise(const Histogram& histogram, double noise, uint32_t most, Allocation allocation) {
    const uint32_t least = std::min(least_samples, most);
    const double scale = largest_scale([&](double candidate) {
        return predicted_noise(histogram, budget_at(candidate, least, most), allocation) > noise;
    });
    // Where the least samples suffice, bins above those that hold pixels have more all the same: further rounds may
    // need them.
    uint32_t highest = budget_bins - 1;
    while (highest > 0 && histogram[highest] == 0) --highest;
    // The next sample up, where the noise is below the goal.
    return budget_at(std::max(scale * (1 + 1e-9), least / share_of(highest)), least, most);
}

RoundSamples round_samples(const std::vector<SampledGroup>& sampled, const Histogram& new_pixels,
                           const Budget& budget) {
    RoundSamples result;
    const auto add = [&](double pixels, uint32_t bin) {
        result.pixels += pixels;
        result.samples += pixels * budget[bin];
    };
    for (const SampledGroup& group : sampled)
        if (budget[group.bin] >= least_resampling_factor * group.samples) add(group.pixels, group.bin);
    for (uint32_t bin = 0; bin < budget_bins; ++bin) add(double(new_pixels[bin]), bin);
    return result;
}

Budget replan_cost(const std::vector<SampledGroup>& sampled, const Histogram& new_pixels, double cost,
                   double pixel_samples, uint32_t most) {
    const uint32_t least = std::min(least_samples, most);
    const double scale = largest_scale([&](double candidate) {
        const RoundSamples all = round_samples(sampled, new_pixels, budget_at(candidate, least, most));
        return all.samples + pixel_samples * all.pixels <= cost;
    });
    return budget_at(scale, least, most);
}

}  // namespace lightband
