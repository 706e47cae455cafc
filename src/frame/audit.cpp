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

// The pixels beyond this part, by what they vary, count as the last within it: few that vary far more than foreseen are for a second
// round to find, where only they get more samples.
constexpr double usual_part = 0.995;

uint32_t hash(uint32_t value) {
    const uint32_t state = value * 747796405u + 2891336453u, word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

}  // namespace

bool is_drawn(uint32_t x, uint32_t y, uint32_t seed, double part) {
    return hash((y << 16 | x) ^ hash(seed)) < part * 0x1p32;
}

double Audit::bulk(std::vector<double> squares) {
    if (squares.empty()) return 0;
    std::sort(squares.begin(), squares.end());
    const double most = squares[size_t(double(squares.size() - 1) * usual_part)];
    double sum = 0;
    for (const double square : squares) sum += std::min(square, most);
    return sum;
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

}  // namespace lightband
