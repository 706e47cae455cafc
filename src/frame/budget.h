// How many samples each bin of pixels gets: the host plans on a histogram that the classification counted.
#pragma once

#include <cstdint>
#include <vector>

namespace lightband {

// Pixels are binned by log2 of the share of samples that they deserve: bin b deserves 2^(b - bins / 2).
constexpr uint32_t budget_bins = 64;
// Fewer points than this would not stratify both dimensions of the (0,2)-sequence.
constexpr uint32_t least_samples = 4;

// histogram: pixels per bin. Returns samples per pixel of each bin, in proportion to the shares, within
// [least_samples, most] (or [1, ...] where mean is smaller), with the mean over all pixels as near to `mean` as rounding lets.
std::vector<uint32_t> plan_budget(const std::vector<uint64_t>& histogram, double mean, uint32_t most);

}  // namespace lightband
