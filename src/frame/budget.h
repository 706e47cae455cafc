// How many samples each bin of pixels gets: the host plans on a histogram that the classification counted.
#pragma once

#include <cstdint>
#include <vector>

namespace lightband {

// Pixels are binned by log2 of the share of samples that they deserve: bin b deserves 2^(b - bins / 2).
constexpr uint32_t budget_bins = 64;
// Fewer would leave one of the two samplers of one of the two replicates without a point.
constexpr uint32_t least_samples = 16;

using Histogram = std::vector<uint64_t>;  // pixels per bin
using Budget = std::vector<uint32_t>;     // samples per pixel of each bin

// In proportion to the shares, within [least_samples, most] (or [1, ...] where mean is smaller), with the mean over all pixels as
// near to `mean` as rounding lets.
Budget plan_mean(const Histogram& histogram, double mean, uint32_t most);

// What a share says of a pixel: under least_error the squared error that it leaves in the frame, times its samples, is the
// share's square; under constant_variance it is the share itself.
enum class Allocation { least_error, constant_variance };

// Sum over the frame's pixels of their squared relative error by noise, as predicted.
double predicted_noise(const Histogram& histogram, const Budget& budget, Allocation allocation);

// The fewest samples whose predicted_noise is at most `noise`, or as many as `most` lets.
Budget plan_noise(const Histogram& histogram, double noise, uint32_t most, Allocation allocation);

}  // namespace lightband
