// How many samples each bin of pixels gets: the host plans on a histogram that the classification counted.
#pragma once

#include <cstdint>
#include <vector>

namespace lightband {

// Pixels are binned by their weight when samples are shared, four bins an octave: bin b has a weight of 2^((b -
// share_one) / 4).
constexpr uint32_t budget_bins = 126, share_one = 63, bins_per_octave = 4;
double share_of(uint32_t bin);
// Fewer save little, since a pixel costs as much as 30 before its first one, and make noise look like an error of
// interpolation (docs/decisions/0007).
constexpr uint32_t least_samples = 16;

using Histogram = std::vector<uint64_t>;  // pixels per bin
using Budget = std::vector<uint32_t>;     // samples per pixel of each bin

// In proportion to the shares, within [least_samples, most] (or [1, ...] where mean is smaller), with the mean over all
// pixels as near to `mean` as rounding lets.
Budget plan_mean(const Histogram& histogram, double mean, uint32_t most);

// What a share says of a pixel: under least_error the squared error that it leaves in the frame, times its samples, is
// the share's square; under constant_variance it is the share itself.
enum class Allocation { least_error, constant_variance };

// Sum over the frame's pixels of their squared relative error by noise, as predicted.
double predicted_noise(const Histogram& histogram, const Budget& budget, Allocation allocation);

// The fewest samples whose predicted_noise is at most `noise`, or as many as `most` lets.
Budget plan_noise(const Histogram& histogram, double noise, uint32_t most, Allocation allocation);

// A pixel is sampled again from the start or left as it is. Its squared error e becomes e r^-g with r times the
// samples, and the sum over pixels is least where one more sample of any pixel reduces it by as much; so sampling one
// again reduces it by as much as its samples would elsewhere from r = (1 + g)^(1 / g) = 1.93 on.
constexpr uint32_t least_resampling_factor = 2;

// Pixels that rounds before have sampled, of one bin and with the same number of samples.
struct SampledGroup {
    uint32_t bin, samples;
    double pixels;
};

// What a further round samples: pixels that it is the first to sample, and those that it samples again.
struct RoundSamples {
    double pixels = 0, samples = 0;
};
RoundSamples round_samples(const std::vector<SampledGroup>& sampled, const Histogram& new_pixels, const Budget& budget);

// The largest budget that costs no more than `cost` samples, the fixed cost of a pixel being so many.
Budget replan_cost(const std::vector<SampledGroup>& sampled, const Histogram& new_pixels, double cost,
                   double pixel_samples, uint32_t most);

}  // namespace lightband
