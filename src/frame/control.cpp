#include "frame/control.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightband {
namespace {

// Error of a frame whose levels follow its bandwidth unscaled, by interpolation alone; it falls with the square of the spacing.
// Measured on scanned meshes it lies between 0.01 (a matte fabric) and 0.1 (a clear coat under a probe). A frame of given
// samples does not measure and takes the upper end; one that corrects itself begins below the lower, since levels can be refined
// later and never coarsened.
constexpr double unmeasured_interpolation = 0.08, expected_interpolation = 0.005;

// Share of interpolation in the squared error. Pixels shaded grow about as the scale, the square of interpolation's error falls
// as its fourth power, that of noise as the samples: time is least where the former is some quarter of the whole.
constexpr double interpolation_share = 0.3;
// Rounds aim below what was asked, by what the estimate may miss; a round that comes this near is the last.
constexpr double aim = 0.88, good_enough = 0.96;
// Standard errors of interpolation's estimate that are added before a round is called good enough.
constexpr double caution = 1;
// Of the variance predicted, rounds were seen to leave a fifth to one and a half. The first draws what a smaller part would ask:
// samples drawn early are kept, samples drawn beyond need are lost.
constexpr double expected_correction = 0.15;
constexpr uint32_t most_rounds = 8;
// Noise falls as the samples to this power: 1 for independent ones; 1.15 to 1.35 were measured.
constexpr double stratified_gain = 1.25;
// The scale grows with the squared error of interpolation over what is allowed. For a smooth picture the fourth root would do; near
// edges, where most of it comes from, it falls more slowly. Steps below the least would not be worth a new classification.
constexpr double growth_power = 0.35, least_growth = 1.02, most_growth = 4;
// Witnesses are believed where noise is at most this many times the squared error that is aimed at.
constexpr double trusted_noise = 3;
// A round that did not suffice, though no level was at fault, is followed by one of at most this part of its noise.
// And of no less than that other part: the noise of few samples is itself known badly, often far too high.
constexpr double least_progress = 0.7, most_progress = 0.1;
// Witnesses that tell, and the part of pixels that cost little.
constexpr double telling_witnesses = 256, cheap_witnesses = 1.0 / 32;
// Part of the time that the first of two rounds may take, and the least part for which another is worth its lists.
constexpr double first_part = 0.3, worthwhile_part = 0.1;
// Of what a round spends beside shading, the part that comes after it.
constexpr double after_shading = 0.6;

double total(const Histogram& histogram) { return double(std::accumulate(histogram.begin(), histogram.end(), uint64_t(0))); }

}  // namespace

void Pace::learn(const RoundCost& cost) {
    round_milliseconds = cost.other_milliseconds;
    if (cost.shading_milliseconds > 0 && cost.samples > 0) samples_per_millisecond = double(cost.samples) / cost.shading_milliseconds;
}

Control::Control(const Settings& settings, const Forecast& forecast, size_t slots, const Pace& pace, double elapsed)
    : settings_(settings), forecast_(forecast), correction_(expected_correction), pace_(pace) {
    // Half of the pixels at most, or small frames would not be interpolated.
    witnesses_ = std::clamp(telling_witnesses / std::max(forecast.covered, 1.0), cheap_witnesses, 0.5);
    const double goal = aim * settings.target_error();
    noise_goal_ = (1 - interpolation_share) * goal * goal;
    scales_.assign(slots, float(first_scale(elapsed)));
}

double Control::first_scale(double elapsed) const {
    if (settings_.bandwidth_scale() > 0) return settings_.bandwidth_scale();
    const double most = Settings::largest_bandwidth_scale;
    if (settings_.target_error() > 0)
        return std::min(most, std::sqrt(expected_interpolation / (std::sqrt(interpolation_share) * aim * settings_.target_error())));
    // With samples shared for least error, the noise of a frame is the mean deviation over the root of the mean count.
    double samples = settings_.samples();
    if (settings_.time_budget() > 0) {
        // A tenth of the time at least: where there is none left, the coarsest levels serve best.
        const double left = std::max(settings_.time_budget() - elapsed - pace_.round_milliseconds, 0.1 * settings_.time_budget());
        samples = left * pace_.samples_per_millisecond / std::max(forecast_.covered, 1.0);
    }
    const double noise = forecast_.relative_deviation / std::sqrt(samples);
    const double interpolation = settings_.time_budget() > 0 ? expected_interpolation : unmeasured_interpolation;
    return noise > 0 ? std::min(std::sqrt(interpolation / noise), most) : most;
}

const Budget& Control::plan(const Histogram& histogram, double elapsed) {
    ++round_;
    histogram_ = histogram;
    const double pixels = std::max(total(histogram), 1.0);
    if (settings_.target_error() > 0) {
        budget_ = plan_noise(histogram, noise_goal_ * forecast_.covered / correction_, settings_.max_samples(), settings_.allocation());
    } else if (settings_.time_budget() > 0) {
        budget_ = plan_mean(histogram, (drawn_ + time_to_shade(elapsed) * pace_.samples_per_millisecond) / pixels,
                            settings_.max_samples());
    } else if (settings_.method() == Method::reference) {
        budget_.assign(budget_bins, settings_.samples());
    } else {
        budget_ = plan_mean(histogram, settings_.samples(), settings_.max_samples());
    }
    return budget_;
}

// Milliseconds that this round may shade. The first of two measures; where a second would spend more on its lists than on light, the
// first has it all.
double Control::time_to_shade(double elapsed) const {
    const double left = std::max(settings_.time_budget() - elapsed - after_shading * pace_.round_milliseconds, 0.0);
    const bool two = round_ == 1 && left > 4 * pace_.round_milliseconds;
    return two ? first_part * left : left;
}

bool Control::out_of_time(const RoundCost& cost) {
    drawn_ += double(cost.samples);
    pace_.learn(cost);
    if (settings_.time_budget() <= 0) return false;
    const double left = settings_.time_budget() - cost.elapsed_milliseconds - pace_.round_milliseconds;
    return left < std::max(worthwhile_part * settings_.time_budget(), pace_.round_milliseconds);
}

// Scales each slot's bandwidth by what its witnesses saw. True: some scale has grown.
bool Control::improve_levels(const ErrorEstimate& estimate) {
    if (settings_.bandwidth_scale() > 0) return false;
    const double target = aim * settings_.target_error();
    const double goal = target > 0 ? target * target : first_part * estimate.noise;  // what the rest of the time leaves
    const double allowed = interpolation_share * goal;
    // While noise is large, a few bright samples make witnesses that see ghosts; and levels never coarsen again.
    if (target > 0 && estimate.noise > trusted_noise * goal) return false;
    bool grown = false;
    for (size_t slot = 0; slot < scales_.size(); ++slot) {
        const ErrorEstimate::Slot& seen = estimate.slots[slot];
        // What the witnesses may have seen by chance is no reason to shade more, unless there is no noise left to blame.
        const double doubts = estimate.noise > noise_goal_ ? 2 : estimate.noise > (1 - interpolation_share) * goal ? 1 : 0;
        const double doubt = doubts * seen.interpolation_deviation;
        const double certain = std::max(seen.interpolation - doubt, 0.0);
        const double factor = std::pow(certain / allowed, growth_power);
        if (!(factor > least_growth)) continue;
        scales_[slot] = float(std::min(scales_[slot] * std::min(factor, most_growth), Settings::largest_bandwidth_scale));
        grown = true;
    }
    return grown;
}

// Where few pixels are left to be interpolated, more of them have to be looked at, in the end all.
void Control::choose_witnesses(const ErrorEstimate& estimate) {
    double candidates = 1;
    for (const ErrorEstimate::Slot& slot : estimate.slots) candidates += double(slot.interpolated + slot.witnesses);
    witnesses_ = std::max(witnesses_, std::min(telling_witnesses / candidates, 1.0));
}

bool Control::again(const ErrorEstimate& estimate, const RoundCost& cost) {
    const double target = settings_.target_error();
    const bool late = out_of_time(cost);
    if (target <= 0 && settings_.time_budget() <= 0) return false;
    if (late || round_ == most_rounds) return false;
    if (target <= 0) {
        improve_levels(estimate);
        return true;
    }
    const double careful = std::sqrt(estimate.noise + estimate.interpolation + caution * estimate.interpolation_deviation);
    if (careful <= good_enough * target) return false;
    choose_witnesses(estimate);
    const double predicted = predicted_noise(histogram_, budget_, settings_.allocation());
    if (predicted > 0) correction_ = std::max(estimate.noise * forecast_.covered / predicted, 1e-6);
    const bool grown = improve_levels(estimate);
    const double goal = aim * target, kept = std::min(estimate.interpolation, interpolation_share * goal * goal);
    // Stratified points gain more than independent ones from being more.
    const double wanted = std::clamp((goal * goal - kept) / estimate.noise, most_progress, grown ? 1 : least_progress);
    noise_goal_ = estimate.noise * std::pow(wanted, 1 / stratified_gain);
    const bool at_most = std::all_of(budget_.begin(), budget_.end(), [&](uint32_t n) { return n >= settings_.max_samples(); });
    return grown || !at_most;
}

}  // namespace lightband
