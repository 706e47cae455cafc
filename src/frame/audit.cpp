#include "frame/audit.h"

#include <algorithm>
#include <cmath>

#include "frame/control.h"

namespace lightband {
namespace {

// Pixels of an audit: squared errors differ by orders of magnitude from pixel to pixel, and their mean over a few hundred is known to
// a quarter or so.
constexpr double least_pixels = 384, part_beyond = 1.0 / 128, most_part = 1.0 / 32;
// Sampled by the map's clusters, a pixel errs by 0.5 to 1 over the square root of its samples: by about the target, with so many parts
// of its inverse square. At a given total, fewer samples of more pixels would know the mean square worse.
constexpr double wanted_share = 0.5;
constexpr double fewest = 64, most = 8192;
// Of a small frame this part at most, or nothing would be interpolated.
constexpr double most_covered = 0.5;
// A frame without target looks as closely as cut light pays: at equal error an unbiased sampler takes several times the samples.
constexpr double samples_for_each = 4;
// Part of a frame's time.
constexpr double part_of_time = 0.06;

// What the spreads do not tell of a squared error, before any audit: nothing, give or take as much as they tell.
constexpr double expected_bias_doubt = 1;

uint32_t hash(uint32_t value) {
    const uint32_t state = value * 747796405u + 2891336453u, word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

}  // namespace

bool is_drawn(uint32_t x, uint32_t y, uint32_t seed, double part) {
    return hash((y << 16 | x) ^ hash(seed)) < part * 0x1p32;
}

Audit::Effort Audit::effort(const Settings& settings, double covered_pixels, double samples_per_millisecond) {
    const bool biased = settings.sampler() == Sampler::cut || settings.sampler() == Sampler::filtered;
    const bool planned = settings.method() == Method::adaptive && settings.target_error() > 0;
    if (covered_pixels == 0 || !(biased || planned)) return {};
    double pixels = std::min(least_pixels + part_beyond * covered_pixels, std::max(most_part * covered_pixels, least_pixels));
    double samples = samples_for_each * settings.samples();
    const double target = settings.target_error();
    if (target > 0) samples = wanted_share / (target * target);
    if (settings.time_budget() > 0) {
        const double affordable = part_of_time * settings.time_budget() * samples_per_millisecond;
        if (!(target > 0)) samples = most;
        samples = std::min(samples, affordable / pixels - Pace::pixel_samples);
        pixels = std::min(pixels, affordable / (fewest + Pace::pixel_samples));
    }
    return {std::min(pixels / covered_pixels, most_covered), biased ? uint32_t(std::clamp(samples, fewest, most)) : 0,
            planned ? probe_samples : 0};
}

void BiasSum::add(double deviation, double own_spread, double other_spread) {
    const double square =
        std::clamp(deviation * deviation - own_spread * own_spread - other_spread * other_spread, -largest_square, largest_square);
    sum_ += square;
    squares_ += square * square;
    ++count_;
}

BiasSum::Bias BiasSum::beyond(double noise) const {
    if (count_ == 0) return {};
    const double seen = sum_ / count_, seen_doubt = std::max((squares_ / count_ - seen * seen) / count_, 0.0);
    const double expected_doubt = std::pow(expected_bias_doubt * noise, 2);
    if (!(seen_doubt + expected_doubt > 0)) return {};
    const double weight = expected_doubt / (seen_doubt + expected_doubt);
    return {std::max(weight * seen, (least_true - 1) * noise), std::sqrt(weight * seen_doubt)};
}

double probed_error(const std::vector<Probed>& pixels, bool audited) {
    double seen = 0;
    BiasSum bias;
    for (const Probed& pixel : pixels) {
        seen += std::min(pixel.spread * pixel.spread, BiasSum::largest_square) / double(pixels.size());
        if (audited) bias.add(pixel.deviation, pixel.spread, pixel.audit_spread);
    }
    return seen + bias.beyond(seen).mean;
}

}  // namespace lightband
