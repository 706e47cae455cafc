#include "frame/resampling.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "picture/constants.h"
#include "picture/decision.h"

namespace lightband {
namespace {

// Half a bin, as a factor on the number of samples.
const double half_a_bin = std::exp2(0.5 / bins_per_octave);
// Pixels are grouped by the logarithm of the samples that they should get over those that they have, in steps of 2^(1 /
// 16).
constexpr double steps_per_octave = 16;

// A pixel that a round has sampled.
struct Candidate {
    size_t at;
    double samples, noise,
        wanted;  // noise: squared and relative, times the pixels that are interpolated from it; wanted: samples
};

std::vector<Candidate> candidates(const RoundPixels& pixels, double mean_luminance) {
    std::vector<Candidate> result;
    double sum = 0;
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        if (!is_shaded(pixels.decision[i]) || pixels.sample_count[i] == 0) continue;
        const double scale = scale_of(pixels, i, mean_luminance);
        result.push_back(
            {i, double(pixels.sample_count[i]), scale > 0 ? variance_of_mean(pixels, i) / (scale * scale) : 0, 0});
        sum += result.back().noise;
    }
    for (Candidate& pixel : result) {
        const double weight = pixel.samples / (pixel.samples + constants::prior_samples);
        pixel.noise = weight * pixel.noise + (1 - weight) * sum / double(result.size());
    }
    return result;
}

// The factor on the samples that pixels should get at which so much of their noise is left.
double factor_leaving(double part, const std::vector<Candidate>& candidates) {
    std::map<int, double> noise;  // by that logarithm
    double all = 0;
    for (const Candidate& pixel : candidates) {
        if (!(pixel.wanted > 0)) continue;
        noise[int(std::lround(steps_per_octave * std::log2(pixel.wanted / pixel.samples)))] += pixel.noise;
        all += pixel.noise;
    }
    double low = -64, high = 64;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        double left = 0;
        for (const auto& [step, sum] : noise) {
            const double octaves = middle + step / steps_per_octave;
            left += octaves >= std::log2(double(least_resampling_factor))
                        ? sum * std::exp2(-constants::stratified_gain * octaves)
                        : sum;
        }
        (left > part * all ? low : high) = middle;
    }
    return std::exp2(high);
}

// The nearest bin; but of a pixel that is worth sampling again, no bin whose rounding would make it not worth it.
uint32_t bin_of(double wanted, uint32_t worth, const Budget& budget) {
    const double nearest = std::min(half_a_bin * wanted, 0x1p31);
    ptrdiff_t bin =
        std::max<ptrdiff_t>(std::upper_bound(budget.begin(), budget.end(), uint32_t(nearest)) - budget.begin(), 1) - 1;
    if (nearest >= worth) bin = std::max(bin, std::lower_bound(budget.begin(), budget.end(), worth) - budget.begin());
    return uint32_t(std::min<ptrdiff_t>(bin, budget_bins - 1));
}

}  // namespace

Resampling plan_resampling(const RoundPixels& pixels, const std::vector<float>& areas, double mean_luminance,
                           Allocation allocation, const Budget& budget, double part) {
    Resampling result;
    result.bins.resize(pixels.material.size());
    std::vector<Candidate> sampled = candidates(pixels, mean_luminance);
    double wanted = 0, had = 0;
    for (Candidate& pixel : sampled) {
        // Up to a factor: the number that would make all errors alike; or at which one more sample of any pixel would
        // reduce the frame's error by as much.
        if (allocation == Allocation::constant_variance) {
            pixel.wanted = pixel.samples * std::pow(pixel.noise, 1 / constants::stratified_gain);
        } else {
            if (!areas.empty()) pixel.noise *= double(areas[pixel.at]);
            pixel.wanted = pixel.samples * std::pow(pixel.noise / pixel.samples, 1 / (1 + constants::stratified_gain));
        }
        wanted += pixel.wanted;
        had += pixel.samples;
    }
    const double factor = !(wanted > 0) ? 0 : part > 0 ? factor_leaving(part, sampled) : had / wanted;
    std::map<std::pair<uint32_t, uint32_t>, double> groups;
    double planned = 0;
    for (const Candidate& pixel : sampled) {
        const uint32_t worth = least_resampling_factor * uint32_t(pixel.samples);
        uint32_t bin = bin_of(factor * pixel.wanted, worth, budget);
        // A pixel that is left as it is comes last in the list, or the invocations beside it would wait for those that
        // sample. One that has as many samples as it may have is counted by its bin.
        if (part > 0 && budget[bin] < worth && budget[bin] < budget.back()) bin = 0;
        result.bins[pixel.at] = uint8_t(bin);
        planned += part > 0 && budget[bin] >= worth ? double(budget[bin]) : pixel.samples;
        ++groups[{bin, uint32_t(pixel.samples)}];
    }
    for (const auto& [key, count] : groups) result.sampled.push_back({key.first, key.second, count});
    if (had > 0) result.growth = planned / had;
    return result;
}

}  // namespace lightband
