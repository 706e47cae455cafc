#include "frame/audit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "frame/control.h"

namespace lightband {
namespace {

// Pixels of an audit: squared errors differ by orders of magnitude from pixel to pixel, and their mean over a few hundred is known to
// a quarter or so; their ratio to what the spreads tell to a tenth or so. More of them cost more than they save
// (docs/decisions/0010).
constexpr double least_pixels = 288, part_beyond = 1.0 / 192, most_part = 1.0 / 32;
// Of a small frame this part at most, or nothing would be interpolated; of so few pixels nothing is, and all are looked at.
constexpr double most_covered = 0.5, few_covered = 64;
constexpr double fewest = 64, most = 1 << 16;

// A biased sampler's cut and footprints shrink with its samples, and so does their error. Over the scenes of docs/trade.md a pixel of N
// samples differs from one of 4 N by 1.04 of its own squared error (0.87 to 1.16 by scene), from one of 8 N by 1.01
// (docs/decisions/0010): of the other's error, which falls as N^-g, so much shows at most.
constexpr double shown_of_audit = 0.3;
// Below so many times a pixel's own samples, an audit says more of itself.
constexpr double least_gain = 1.8;

// A pixel of n samples of a cut errs by 0.2 to 0.4 of n^(-g / 2): a probe has about as many as will be planned. Sampled by the map's
// clusters it errs by 0.5 to 1 over the square root of its samples: as much, with so many times n^g.
constexpr double unbiased_share = 5;
constexpr double expected_error = 0.3, least_probe = 16, most_probe = 512;
// Part of what there is time for; nothing where it would not do for as many pixels as tell anything.
constexpr double part_of_light = 0.06, fewest_pixels = 64;

// What pixels err by over what their variances tell, before any audit: as much, give or take half of that
// (docs/decisions/0010).
constexpr double expected_doubt = 0.5;

// Standard deviations of an unbiased look that chance may reach: at a few dozen pixels, one in a thousand each.
constexpr double refuting_deviations = 3;

double believed_square(double value) { return std::min(value * value, AuditSum::largest_square); }

uint32_t hash(uint32_t value) {
    const uint32_t state = value * 747796405u + 2891336453u, word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

}  // namespace

bool is_drawn(uint32_t x, uint32_t y, uint32_t seed, double part) {
    return hash((y << 16 | x) ^ hash(seed)) < part * 0x1p32;
}

bool Audit::knows_better(double own_samples) const { return samples >= least_gain * own_samples; }

double Audit::square(const Pixel& pixel, double shown, double scale, double own_samples) const {
    const double square = believed_square((shown - pixel.mean) / scale);
    if (!pixel.biased) return square - believed_square(pixel.spread / scale);
    return square / (1 + shown_of_audit * std::pow(own_samples / samples, stratified_gain));
}

double Audit::square_of_other(const Pixel& pixel, double shown, double scale, double drawn, double own_samples) const {
    const double square = believed_square((shown - pixel.mean) / scale);
    return square - (pixel.biased ? drawn * std::pow(own_samples / samples, stratified_gain) : believed_square(pixel.spread / scale));
}

bool Audit::refutes(const Pixel& unbiased, const Pixel& cut) {
    return unbiased.mean - refuting_deviations * unbiased.deviation > cut.mean;
}

uint32_t Audit::unbiased_samples(double probe) {
    return uint32_t(std::clamp(unbiased_share * std::pow(probe, stratified_gain), fewest, most));
}

Audit::Effort Audit::effort(const Settings& settings, double covered_pixels, double light) {
    const bool cut = settings.sampler() == Sampler::cut, biased = cut || settings.sampler() == Sampler::filtered;
    const double target = settings.target_error();
    const bool planned = settings.method() == Method::adaptive && target > 0;
    if (covered_pixels == 0 || !(biased || planned)) return {};
    double pixels = std::min(least_pixels + part_beyond * covered_pixels, std::max(most_part * covered_pixels, least_pixels));
    double probe = double(settings.samples()) * settings.accumulate(), samples = gain * probe;
    if (target > 0) {
        probe = std::clamp(std::pow(expected_error / target, 2 / stratified_gain), least_probe, most_probe);
        samples = gain * probe;
    }
    if (!cut) samples = unbiased_samples(probe);
    if (settings.time_budget() > 0) {
        const double affordable = part_of_light * light;
        if (!(target > 0)) samples = most;
        samples = std::min(samples, affordable / pixels - Pace::pixel_samples);
        pixels = std::min(pixels, affordable / (fewest + Pace::pixel_samples));
        if (pixels < fewest_pixels) return {};
    }
    samples = std::clamp(samples, fewest, most);
    // Where time alone is asked for there is none for a probe.
    probe = !planned && (!cut || settings.time_budget() > 0) ? 0 : cut ? samples / gain : probe;
    const double part = covered_pixels > few_covered ? std::min(pixels / covered_pixels, most_covered) : 1;
    return {part, biased ? uint32_t(samples) : 0, uint32_t(probe)};
}

void SharedError::add(double deviation, double own_part) {
    const double believed = std::clamp(deviation, -1.0, 1.0);
    ++count_;
    sum_ += believed;
    squares_ += believed * believed;
    // An error that falls as n^(-g / 2) shows so much against that of an audit.
    shown_ += 1 - std::pow(own_part, 0.5 * stratified_gain);
}

double SharedError::hidden() const {
    if (count_ < 2) return 0;
    const double mean = sum_ / count_, variance = (squares_ - sum_ * mean) / (count_ - 1), shown = shown_ / count_;
    // A mean of deviations to either side is not 0 either.
    return std::max(mean * mean - variance / count_, 0.0) * (1 / (shown * shown) - 1);
}

void AuditSum::add(double square, double told) {
    squares_.push_back(square);
    told_.push_back(std::min(told, largest_square));
}

AuditSum::Bias AuditSum::beyond(double noise) const {
    if (told_.empty()) return {};
    const double told = std::accumulate(told_.begin(), told_.end(), 0.0);
    if (!(told > 0)) return {std::max(std::accumulate(squares_.begin(), squares_.end(), 0.0) / double(squares_.size()) - noise, 0.0), 0};
    const double ratio = std::accumulate(squares_.begin(), squares_.end(), 0.0) / told;
    double doubt = 0;  // the ratio's variance
    for (size_t i = 0; i < told_.size(); ++i) doubt += (1 - part_) * std::pow((squares_[i] - ratio * told_[i]) / told, 2);
    // What was seen beyond its own doubt may also be what was to be expected, if only one had known: a lamp that was missed.
    const double surprise = std::max(std::abs(ratio - 1) - std::sqrt(doubt), 0.0);
    const double expected = expected_doubt * expected_doubt + surprise * surprise, weight = expected / (expected + doubt);
    return {noise * std::max(weight * (ratio - 1), least_true - 1), noise * std::sqrt(weight * doubt)};
}

double AuditSum::error() const {
    if (told_.empty()) return 0;
    const double told = std::accumulate(told_.begin(), told_.end(), 0.0) / double(told_.size());
    return told + beyond(told).mean;
}

}  // namespace lightband
