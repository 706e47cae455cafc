#include "frame/control_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/hash.h"
#include "picture/budget.h"
#include "picture/constants.h"

namespace lightband {
namespace {

double clamped_square_of(double value) {
    return std::min(value * value, constants::largest_square);
}

}  // namespace

bool is_chosen_by(uint32_t x, uint32_t y, uint32_t seed, double part) {
    return hash((y << 16 | x) ^ hash(seed)) < part * 0x1p32;
}

bool ControlSet::has_enough_samples_for(double own_samples) const {
    return samples >= constants::least_control_gain * own_samples;
}

double ControlSet::square(const Pixel& pixel, double displayed, double scale, double own_samples) const {
    const double square = clamped_square_of((displayed - pixel.mean) / scale);
    if (!pixel.biased) return square - clamped_square_of(pixel.spread / scale);
    return square /
           (1 + constants::visible_control_error * std::pow(own_samples / samples, constants::stratified_gain));
}

double ControlSet::squared_error_of_other(const Pixel& pixel, double displayed, double scale, double sampled,
                                          double own_samples) const {
    const double square = clamped_square_of((displayed - pixel.mean) / scale);
    return square - (pixel.biased ? sampled * std::pow(own_samples / samples, constants::stratified_gain)
                                  : clamped_square_of(pixel.spread / scale));
}

bool ControlSet::sees_more_than(const Pixel& unbiased, const Pixel& cut) {
    return unbiased.mean - constants::sure_unbiased_deviations * unbiased.deviation > cut.mean;
}

uint32_t ControlSet::unbiased_samples(double pilot) {
    return uint32_t(std::clamp(constants::unbiased_share * std::pow(pilot, constants::stratified_gain),
                               constants::fewest_control_samples, constants::most_control_samples));
}

ControlSet::Effort ControlSet::effort(const Settings& settings, double covered_pixels, double affordable) {
    const bool cut = settings.sampler() == Sampler::cut, biased = cut || settings.sampler() == Sampler::filtered;
    const double target = settings.target_error();
    const bool planned = settings.method() == Method::adaptive && target > 0;
    if (covered_pixels == 0 || !(biased || planned)) return {};
    double pixels = std::min(constants::control_pixels + constants::control_part_beyond * covered_pixels,
                             std::max(constants::most_control_part * covered_pixels, constants::control_pixels));
    double pilot = double(settings.samples()) * settings.accumulate(), samples = constants::control_gain * pilot;
    if (target > 0) {
        pilot = std::clamp(std::pow(constants::expected_sample_error / target, 2 / constants::stratified_gain),
                           constants::least_pilot_samples, constants::most_pilot_samples);
        samples = constants::control_gain * pilot;
    }
    if (!cut) samples = unbiased_samples(pilot);
    if (settings.time_budget() > 0) {
        const double own = constants::control_part_of_time * affordable;
        if (!(target > 0)) samples = constants::most_control_samples;
        samples = std::min(samples, own / pixels - constants::pixel_samples);
        pixels = std::min(pixels, own / (constants::fewest_control_samples + constants::pixel_samples));
        if (pixels < constants::fewest_control_pixels) return {};
    }
    samples = std::clamp(samples, constants::fewest_control_samples, constants::most_control_samples);
    // Where time alone is asked for there are no pilot samples.
    pilot = !planned && (!cut || settings.time_budget() > 0) ? 0 : cut ? samples / constants::control_gain : pilot;
    const double part = covered_pixels > constants::few_covered_pixels
                            ? std::min(pixels / covered_pixels, constants::most_small_control_part)
                            : 1;
    return {part, biased ? uint32_t(samples) : 0, uint32_t(pilot)};
}

void CommonModeError::add(double deviation, double own_part) {
    const double clamped = std::clamp(deviation, -1.0, 1.0);
    ++count_;
    sum_ += clamped;
    squares_ += clamped * clamped;
    // Of an error that falls as n^(-g / 2), this part is visible in a comparison with control samples.
    visible_ += 1 - std::pow(own_part, 0.5 * constants::stratified_gain);
}

double CommonModeError::unseen() const {
    if (count_ < 2) return 0;
    const double mean = sum_ / count_, variance = (squares_ - sum_ * mean) / (count_ - 1), visible = visible_ / count_;
    // The mean of deviations to either side is not 0 either: its own variance is subtracted.
    return std::max(mean * mean - variance / count_, 0.0) * (1 / (visible * visible) - 1);
}

void BiasEstimate::add(double square, double estimated) {
    squares_.push_back(square);
    estimated_.push_back(std::min(estimated, constants::largest_square));
}

BiasEstimate::Bias BiasEstimate::beyond(double noise) const {
    if (estimated_.empty()) return {};
    const double estimated = std::accumulate(estimated_.begin(), estimated_.end(), 0.0);
    if (!(estimated > 0))
        return {std::max(std::accumulate(squares_.begin(), squares_.end(), 0.0) / double(squares_.size()) - noise, 0.0),
                0};
    const double ratio = std::accumulate(squares_.begin(), squares_.end(), 0.0) / estimated;
    double variance = 0;  // of the ratio
    for (size_t i = 0; i < estimated_.size(); ++i)
        variance += (1 - part_) * std::pow((squares_[i] - ratio * estimated_[i]) / estimated, 2);
    // A ratio further from 1 than its standard error tells that such ratios were to be expected, as where a small
    // source was missed.
    const double surprise = std::max(std::abs(ratio - 1) - std::sqrt(variance), 0.0);
    const double expected = constants::expected_uncertainty * constants::expected_uncertainty + surprise * surprise,
                 weight = expected / (expected + variance);
    return {noise * std::max(weight * (ratio - 1), constants::least_bias_ratio - 1),
            noise * std::sqrt(weight * variance)};
}

double BiasEstimate::error() const {
    if (estimated_.empty()) return 0;
    const double estimated = std::accumulate(estimated_.begin(), estimated_.end(), 0.0) / double(estimated_.size());
    return estimated + beyond(estimated).mean;
}

}  // namespace lightband
