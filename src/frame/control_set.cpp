#include "frame/control_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/hash.h"
#include "frame/error_control.h"

namespace lightband {
namespace {

// Pixels of a control set: squared errors differ by orders of magnitude from pixel to pixel, and their mean over a few hundred is known to
// a quarter or so; its ratio to what the spreads estimate, to a tenth or so. More pixels cost more than they save (docs/decisions/0010).
constexpr double least_pixels = 288, part_beyond = 1.0 / 192, most_part = 1.0 / 32;
// Of a small frame this part at most, or nothing would be interpolated; of so few pixels nothing is, and all are in the set.
constexpr double most_covered = 0.5, few_covered = 64;
constexpr double fewest_samples = 64, most_samples = 1 << 16;

// The light cut and the footprints of a biased sampler shrink with its samples, and so does its error. Over the scenes of docs/trade.md a
// pixel of N samples differs from one of 4 N by 1.04 of its own squared error (0.87 to 1.16 by scene), from one of 8 N by 1.01
// (docs/decisions/0010): of the other's error, which falls as N^-g, at most this part is visible.
constexpr double visible_control_error = 0.3;
// With fewer times a pixel's own samples, control samples tell more of their own error than of the pixel's.
constexpr double least_gain = 1.8;

// A pixel of n samples of a light cut errs by 0.2 to 0.4 of n^(-g / 2): there are about as many pilot samples as will be planned. A pixel
// that is sampled by the map's clusters errs by 0.5 to 1 over the square root of its samples: as much, with so many times n^g.
constexpr double unbiased_share = 5;
constexpr double expected_error = 0.3, least_pilot = 16, most_pilot = 512;
// Part of the samples that there is time for; no control set where it would not do for this many pixels.
constexpr double part_of_affordable = 0.06, fewest_pixels = 64;

// Pixels err by as much as their variances estimate, give or take half of that, before any control sample is drawn (docs/decisions/0010).
constexpr double expected_uncertainty = 0.5;

// Standard deviations of unbiased samples that chance may reach: for a few dozen pixels, one in a thousand each.
constexpr double sure_deviations = 3;

double clamped_square_of(double value) { return std::min(value * value, BiasEstimate::largest_square); }

}  // namespace

bool is_chosen_by(uint32_t x, uint32_t y, uint32_t seed, double part) { return hash((y << 16 | x) ^ hash(seed)) < part * 0x1p32; }

bool ControlSet::has_enough_samples_for(double own_samples) const { return samples >= least_gain * own_samples; }

double ControlSet::square(const Pixel& pixel, double displayed, double scale, double own_samples) const {
    const double square = clamped_square_of((displayed - pixel.mean) / scale);
    if (!pixel.biased) return square - clamped_square_of(pixel.spread / scale);
    return square / (1 + visible_control_error * std::pow(own_samples / samples, stratified_gain));
}

double ControlSet::squared_error_of_other(const Pixel& pixel, double displayed, double scale, double sampled, double own_samples) const {
    const double square = clamped_square_of((displayed - pixel.mean) / scale);
    return square -
           (pixel.biased ? sampled * std::pow(own_samples / samples, stratified_gain) : clamped_square_of(pixel.spread / scale));
}

bool ControlSet::sees_more_than(const Pixel& unbiased, const Pixel& cut) {
    return unbiased.mean - sure_deviations * unbiased.deviation > cut.mean;
}

uint32_t ControlSet::unbiased_samples(double pilot) {
    return uint32_t(std::clamp(unbiased_share * std::pow(pilot, stratified_gain), fewest_samples, most_samples));
}

ControlSet::Effort ControlSet::effort(const Settings& settings, double covered_pixels, double affordable) {
    const bool cut = settings.sampler() == Sampler::cut, biased = cut || settings.sampler() == Sampler::filtered;
    const double target = settings.target_error();
    const bool planned = settings.method() == Method::adaptive && target > 0;
    if (covered_pixels == 0 || !(biased || planned)) return {};
    double pixels = std::min(least_pixels + part_beyond * covered_pixels, std::max(most_part * covered_pixels, least_pixels));
    double pilot = double(settings.samples()) * settings.accumulate(), samples = gain * pilot;
    if (target > 0) {
        pilot = std::clamp(std::pow(expected_error / target, 2 / stratified_gain), least_pilot, most_pilot);
        samples = gain * pilot;
    }
    if (!cut) samples = unbiased_samples(pilot);
    if (settings.time_budget() > 0) {
        const double own = part_of_affordable * affordable;
        if (!(target > 0)) samples = most_samples;
        samples = std::min(samples, own / pixels - Throughput::pixel_samples);
        pixels = std::min(pixels, own / (fewest_samples + Throughput::pixel_samples));
        if (pixels < fewest_pixels) return {};
    }
    samples = std::clamp(samples, fewest_samples, most_samples);
    // Where time alone is asked for there are no pilot samples.
    pilot = !planned && (!cut || settings.time_budget() > 0) ? 0 : cut ? samples / gain : pilot;
    const double part = covered_pixels > few_covered ? std::min(pixels / covered_pixels, most_covered) : 1;
    return {part, biased ? uint32_t(samples) : 0, uint32_t(pilot)};
}

void CommonModeError::add(double deviation, double own_part) {
    const double clamped = std::clamp(deviation, -1.0, 1.0);
    ++count_;
    sum_ += clamped;
    squares_ += clamped * clamped;
    // Of an error that falls as n^(-g / 2), this part is visible in a comparison with control samples.
    visible_ += 1 - std::pow(own_part, 0.5 * stratified_gain);
}

double CommonModeError::unseen() const {
    if (count_ < 2) return 0;
    const double mean = sum_ / count_, variance = (squares_ - sum_ * mean) / (count_ - 1), visible = visible_ / count_;
    // The mean of deviations to either side is not 0 either: its own variance is subtracted.
    return std::max(mean * mean - variance / count_, 0.0) * (1 / (visible * visible) - 1);
}

void BiasEstimate::add(double square, double estimated) {
    squares_.push_back(square);
    estimated_.push_back(std::min(estimated, largest_square));
}

BiasEstimate::Bias BiasEstimate::beyond(double noise) const {
    if (estimated_.empty()) return {};
    const double estimated = std::accumulate(estimated_.begin(), estimated_.end(), 0.0);
    if (!(estimated > 0)) return {std::max(std::accumulate(squares_.begin(), squares_.end(), 0.0) / double(squares_.size()) - noise, 0.0), 0};
    const double ratio = std::accumulate(squares_.begin(), squares_.end(), 0.0) / estimated;
    double variance = 0;  // of the ratio
    for (size_t i = 0; i < estimated_.size(); ++i) variance += (1 - part_) * std::pow((squares_[i] - ratio * estimated_[i]) / estimated, 2);
    // A ratio further from 1 than its standard error tells that such ratios were to be expected, as where a small source was missed.
    const double surprise = std::max(std::abs(ratio - 1) - std::sqrt(variance), 0.0);
    const double expected = expected_uncertainty * expected_uncertainty + surprise * surprise, weight = expected / (expected + variance);
    return {noise * std::max(weight * (ratio - 1), least_bias_ratio - 1), noise * std::sqrt(weight * variance)};
}

double BiasEstimate::error() const {
    if (estimated_.empty()) return 0;
    const double estimated = std::accumulate(estimated_.begin(), estimated_.end(), 0.0) / double(estimated_.size());
    return estimated + beyond(estimated).mean;
}

}  // namespace lightband
