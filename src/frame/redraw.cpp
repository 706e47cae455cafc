#include "frame/redraw.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "picture/decision.h"

namespace lightband {
namespace {

// Samples that know their own variance as well as the mean of all pixels does: a variance of n samples of a kurtosis of this much is
// off by as much as itself at n = kurtosis, and pixels differ among each other by about as much.
constexpr double telling_samples = 16;
// Up to so many times what a bin has is nearer to it than to the next.
const double half_a_bin = std::exp2(0.5 / bins_per_octave);
// Pixels are grouped by what they deserve over what they had, in steps of 2^(1 / 16).
constexpr double steps_per_octave = 16;

// A pixel that a former round drew.
struct Candidate {
    size_t at;
    double samples, noise, deserved;  // noise: squared and relative, as often as it is interpolated from; deserved: samples
};

std::vector<Candidate> candidates(const RoundPixels& pixels, double mean_luminance) {
    std::vector<Candidate> result;
    double sum = 0;
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        if (!is_shaded(pixels.decision[i]) || pixels.sample_count[i] == 0) continue;
        const double scale = scale_of(pixels, i, mean_luminance);
        result.push_back({i, double(pixels.sample_count[i]), scale > 0 ? variance_of_mean(pixels, i) / (scale * scale) : 0, 0});
        sum += result.back().noise;
    }
    for (Candidate& pixel : result) {
        const double weight = pixel.samples / (pixel.samples + telling_samples);
        pixel.noise = weight * pixel.noise + (1 - weight) * sum / double(result.size());
    }
    return result;
}

// The factor on what they deserve at which so much of their noise is left.
double factor_leaving(double part, const std::vector<Candidate>& candidates) {
    std::map<int, double> noise;  // by the logarithm of what is deserved over what was had
    double all = 0;
    for (const Candidate& pixel : candidates) {
        if (!(pixel.deserved > 0)) continue;
        noise[int(std::lround(steps_per_octave * std::log2(pixel.deserved / pixel.samples)))] += pixel.noise;
        all += pixel.noise;
    }
    double low = -64, high = 64;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        double left = 0;
        for (const auto& [step, sum] : noise) {
            const double octaves = middle + step / steps_per_octave;
            left += octaves >= std::log2(double(worth_redrawing)) ? sum * std::exp2(-stratified_gain * octaves) : sum;
        }
        (left > part * all ? low : high) = middle;
    }
    return std::exp2(high);
}

// The nearest bin; but what is worth redrawing by a hair must not fall short of it by another.
uint32_t bin_of(double deserved, uint32_t worth, const Budget& budget) {
    const double nearest = std::min(half_a_bin * deserved, 0x1p31);
    ptrdiff_t bin = std::max<ptrdiff_t>(std::upper_bound(budget.begin(), budget.end(), uint32_t(nearest)) - budget.begin(), 1) - 1;
    if (nearest >= worth) bin = std::max(bin, std::lower_bound(budget.begin(), budget.end(), worth) - budget.begin());
    return uint32_t(std::min<ptrdiff_t>(bin, budget_bins - 1));
}

}  // namespace

Redraw redraw(const RoundPixels& pixels, const std::vector<float>& areas, double mean_luminance, Allocation allocation,
              const Budget& budget, double part) {
    Redraw result;
    result.bins.resize(pixels.material.size());
    std::vector<Candidate> drawn = candidates(pixels, mean_luminance);
    double deserved = 0, had = 0;
    for (Candidate& pixel : drawn) {
        // Up to a factor: what would make all errors alike, or the last sample of each lessen the frame's by as much.
        if (allocation == Allocation::constant_variance) {
            pixel.deserved = pixel.samples * std::pow(pixel.noise, 1 / stratified_gain);
        } else {
            if (!areas.empty()) pixel.noise *= double(areas[pixel.at]);
            pixel.deserved = pixel.samples * std::pow(pixel.noise / pixel.samples, 1 / (1 + stratified_gain));
        }
        deserved += pixel.deserved;
        had += pixel.samples;
    }
    const double factor = !(deserved > 0) ? 0 : part > 0 ? factor_leaving(part, drawn) : had / deserved;
    std::map<std::pair<uint32_t, uint32_t>, double> groups;
    double planned = 0;
    for (const Candidate& pixel : drawn) {
        const uint32_t worth = worth_redrawing * uint32_t(pixel.samples);
        uint32_t bin = bin_of(factor * pixel.deserved, worth, budget);
        // What stays as it is comes last in the list, apart: lanes beside those that draw anew would wait for them. What has the most
        // that it may have is counted by its bin.
        if (part > 0 && budget[bin] < worth && budget[bin] < budget.back()) bin = 0;
        result.bins[pixel.at] = uint8_t(bin);
        planned += part > 0 && budget[bin] >= worth ? double(budget[bin]) : pixel.samples;
        ++groups[{bin, uint32_t(pixel.samples)}];
    }
    for (const auto& [key, count] : groups) result.drawn.push_back({key.first, key.second, count});
    if (had > 0) result.growth = planned / had;
    return result;
}

}  // namespace lightband
