#include "frame/error_control.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightband {
namespace {

// ---- Interpolation --------------------------------------------------------------------------------------

// Error of interpolation in a frame whose levels follow its bandwidth unscaled: as a frame of given samples assumes it, which does not
// correct itself, and as one does that corrects itself. It falls with the scale to this power. Measured on scanned meshes the error lies
// between 0.01 (a matte fabric) and 0.1 (a clear coat under a light probe). A frame that corrects itself begins below the lower, since
// levels can be refined later and never coarsened.
constexpr double unmeasured_error = 0.08, expected_error = 0.005, error_power = 2;
// A tile's scale grows by the squared error of interpolation over what is allowed to this power. For a smooth picture scales would have to
// grow by the fourth root; near edges, where most of the error comes from, it falls more slowly, and a further round costs more than some
// pixels too many: the twelve spheres of docs/trade.md took 0.89 of the time at equal error at 2 %, 0.97 at 1 %, that a power of 1/2 and
// at most 4 times took; a power of 1 as much at 2 % and more at 1 %.
constexpr double growth_power = 0.75;
// A tile's scale grows by less than the lower factor not at all, as a new classification would cost more; and by no more than the upper.
constexpr double least_growth = 1.1, most_growth = 8;
// Tolerance of the contrast test, in parts of the error that is asked for. It is no less than the differences that predictions of
// neighbouring pixels have by themselves, and no more than in frames that ask for no error.
constexpr double tolerance_part = 1.2, least_tolerance = 0.03, most_tolerance = 0.5;
// Validation pixels, in parts of the covered pixels: a part that costs little, or as many pixels as measure the error of interpolation.
constexpr double least_validation_part = 1.0 / 16, enough_validation_pixels = 256;
// A tile's few validation pixels are joined by so many that have the frame's mean.
constexpr double prior_validation_pixels = 4;
// Share of interpolation in the squared error, as planned, and at most. The number of shaded pixels grows about as the scale, the square
// of the error of interpolation falls as its fourth power, that of noise as the number of samples: time is least where the former is some
// quarter of the whole.
constexpr double interpolation_share = 0.3, most_interpolation = 0.5;
// After so many rounds that have not found levels for it, nothing is interpolated.
constexpr uint32_t most_refinements = 5;
// Noise, in parts of what is allowed, up to which validation pixels are taken into account; and up to which without subtracting their
// standard error.
constexpr double trusted_noise = 3, certain_noise = 1.25;

// ---- Rounds that an error asks for ----------------------------------------------------------------------

// Rounds aim below what was asked, by what the estimate may miss. The last is one that is estimated to come this near, or, with all its
// standard errors added, that near.
constexpr double aim = 0.8, near_enough = 0.85, good_enough = 0.93;
// Standard errors of an estimate that are added.
constexpr double caution = 1;
constexpr uint32_t most_rounds = 8;
// The part of the allowed noise that a first round plans for. The pixels that others are interpolated from pass their noise on to many:
// first rounds were seen to leave between half and twice of what pilot samples predicted, and a second costs more than some samples.
constexpr double held_by_first = 0.55;
// A round that did not suffice, though levels were fine enough, is followed by one that leaves at most this part of its noise; and no less
// than that other part, as the noise of few samples is known badly, and often estimated far too high.
constexpr double least_progress = 0.9, most_progress = 0.25;

// ---- Rounds that a time asks for ------------------------------------------------------------------------

// Part of the time that the first of two rounds may take, and the least part for which another is worth its overhead.
constexpr double first_part = 0.15, worthwhile_part = 0.1;
// The samples of a pixel where no time is left: its fixed cost is higher than theirs.
constexpr double fewest_in_time = 6;
// Levels are made coarser by this factor at most, where time does not suffice for all pixels that would be shaded.
constexpr double least_part = 0.1;
// Part of the shaded pixels that a round must shade for its throughput to be taken over.
constexpr double representative_part = 0.25;
// Of what a round takes beside shading, the part that comes after it.
constexpr double after_shading = 0.6;

// The part of its noise that must be planned for, by a model in which it falls as the samples, so that it becomes `part` of what it is.
double reached_by_more(double part) { return std::pow(part, 1 / stratified_gain); }

double total(const Histogram& histogram) { return double(std::accumulate(histogram.begin(), histogram.end(), uint64_t(0))); }

}  // namespace

void Throughput::update(const RoundCost& cost, bool first_of_two) {
    round_milliseconds = cost.other_milliseconds;
    if (!(cost.shading_milliseconds > 0) || cost.samples == 0) return;
    const double seen = (double(cost.samples) + pixel_samples * double(cost.pixels)) / cost.shading_milliseconds;
    if (!first_of_two || !known) samples_per_millisecond = seen;
    // The throughput of later rounds is known from the frames before, up to how fast the device is now, for which a short round stands by
    // half.
    else if (of_first_round > 0) samples_per_millisecond *= std::sqrt(seen / of_first_round);
    if (first_of_two) of_first_round = seen;
    known = true;
}

ErrorControl::ErrorControl(const Settings& settings, const Forecast& forecast, size_t tiles, const Throughput& throughput, double elapsed)
    : settings_(settings), forecast_(forecast), target_(settings.target_error()), throughput_(throughput) {
    interpolates_ = settings.coarsest_level() > 0;
    const bool known = forecast.pilot_error > 0;
    if (settings.time_budget() > 0 && !(known && first_cost(forecast.covered, 0) <= affordable(elapsed))) target_ = 0;
    // Half of the pixels at most, or small frames would not be interpolated.
    validation_part_ = std::clamp(enough_validation_pixels / std::max(forecast.covered, 1.0), least_validation_part, 0.5);
    scales_.first = float(first_scale(elapsed));
    scales_.of.assign(tiles, scales_.first);
}

double ErrorControl::first_scale(double elapsed) {
    if (settings_.bandwidth_scale() > 0) return settings_.bandwidth_scale();
    double expected = expected_error;
    if (target_ > 0) {
        allowed_interpolation_ = std::sqrt(interpolation_share) * aim * target_;
    } else {
        // With samples shared for least error, the noise of a frame is the mean deviation over the root of the mean count.
        double samples = settings_.samples();
        if (settings_.time_budget() > 0) {
            // A tenth of the time at least: where there is none left, the coarsest levels serve best.
            const double least = 0.1 * settings_.time_budget() * throughput_.samples_per_millisecond;
            samples = std::max(std::max(affordable(elapsed), least) / std::max(forecast_.covered, 1.0) - Throughput::pixel_samples, fewest_in_time);
        } else {
            expected = unmeasured_error;
        }
        allowed_interpolation_ = expected_noise_ = forecast_.relative_deviation / std::sqrt(samples);
    }
    const double most = Settings::largest_bandwidth_scale;
    return allowed_interpolation_ > 0 ? std::min(most, std::pow(expected / allowed_interpolation_, 1 / error_power)) : most;
}

double ErrorControl::tolerance() const {
    if (target_ > 0) return std::clamp(tolerance_part * target_, least_tolerance, most_tolerance);
    return std::max(most_tolerance, expected_noise_);
}

// Samples that there is time for, the fixed cost of pixels included.
double ErrorControl::affordable(double elapsed) const {
    return std::max(settings_.time_budget() - elapsed - throughput_.round_milliseconds, 0.0) * throughput_.samples_per_millisecond;
}

double ErrorControl::goal() const { return std::pow(aim * target_, 2); }
double ErrorControl::share_of_interpolation() const { return interpolates_ ? interpolation_share : 0; }
double ErrorControl::noise_allowed() const { return (1 - share_of_interpolation()) * goal(); }

double ErrorControl::first_noise(double share) const {
    return share > 0 ? held_by_first * (1 - share) * goal() : goal();
}

// The predicted noise is scaled so that it agrees with the pilot samples where every pixel has as many samples as they are; from there
// more samples lead to the goal.
double ErrorControl::predicted_goal(const Histogram& histogram) const {
    const double predicted = predicted_noise(histogram, Budget(budget_bins, forecast_.pilot_samples), settings_.allocation());
    if (!(forecast_.pilot_error > 0) || !(predicted > 0)) return noise_allowed() * forecast_.covered;
    return predicted * reached_by_more(first_noise(share_of_interpolation()) / forecast_.pilot_error);
}

// The cost of so many pixels in a first round, in samples, as pilot samples predict it.
double ErrorControl::first_cost(double pixels, double share) const {
    const double noise = forecast_.pilot_error / first_noise(share);
    return pixels * (Throughput::pixel_samples + std::max(forecast_.pilot_samples * std::pow(noise, 1 / stratified_gain), double(least_samples)));
}

bool ErrorControl::replan(const Histogram& histogram, double elapsed) {
    if (round_ > 0 || settings_.bandwidth_scale() > 0) return false;
    const double shaded = total(histogram);
    const bool interpolated = interpolates_;
    if (target_ > 0) {
        interpolates_ = interpolated && interpolation_saves_samples(shaded);
    } else if (settings_.time_budget() > 0) {
        if (coarsen(shaded, affordable(elapsed))) return true;
        interpolates_ = interpolated && interpolation_saves_time(shaded, affordable(elapsed));
    }
    return interpolated != interpolates_;
}

// Interpolation takes a share of the error, so that each shaded pixel needs more samples: it must save more pixels than that.
bool ErrorControl::interpolation_saves_samples(double shaded) const {
    if (!(forecast_.pilot_error > 0)) return true;
    return first_cost(shaded, interpolation_share) < first_cost(forecast_.covered, 0);
}

bool ErrorControl::interpolation_saves_time(double shaded, double affordable) const {
    const double each = affordable / std::max(shaded, 1.0) - Throughput::pixel_samples, of_all = affordable / forecast_.covered - Throughput::pixel_samples;
    return of_all < least_samples || each * reached_by_more(held_by_first * (1 - interpolation_share)) > of_all;
}

bool ErrorControl::coarsen(double shaded, double affordable) {
    const double part = affordable / (Throughput::pixel_samples + fewest_in_time) / std::max(shaded, 1.0);
    if (part >= 1) return false;
    // Pixels shaded grow about as the scale.
    scales_.first *= float(std::max(part, least_part));
    scales_.of.assign(scales_.of.size(), scales_.first);
    return true;
}

const Budget& ErrorControl::plan(const Histogram& histogram, double elapsed) {
    ++round_;
    const double pixels = shaded_ = std::max(total(histogram), 1.0);
    if (target_ > 0) {
        budget_ = plan_noise(histogram, predicted_goal(histogram), settings_.max_samples(), settings_.allocation());
    } else if (settings_.time_budget() > 0) {
        const double mean = time_to_shade(elapsed) * throughput_.samples_per_millisecond / pixels - Throughput::pixel_samples;
        budget_ = plan_mean(histogram, std::max(mean, fewest_in_time), settings_.max_samples());
    } else if (settings_.method() == Method::reference) {
        budget_.assign(budget_bins, settings_.samples());
    } else {
        budget_ = plan_mean(histogram, settings_.samples(), settings_.max_samples());
    }
    return budget_;
}

const Budget& ErrorControl::plan_further(const std::vector<SampledGroup>& sampled, const Histogram& new_pixels, double elapsed) {
    ++round_;
    shaded_ = total(new_pixels);
    for (const SampledGroup& group : sampled) shaded_ += group.pixels;
    if (!(settings_.time_budget() > 0)) return budget_;
    // As many samples as there is time for, or as the error needs, where those are fewer.
    const double most = time_to_shade(elapsed) * throughput_.samples_per_millisecond;
    const RoundSamples needed = round_samples(sampled, new_pixels, budget_);
    if (!(target_ > 0) || needed.samples + Throughput::pixel_samples * needed.pixels > most)
        budget_ = replan_cost(sampled, new_pixels, most, Throughput::pixel_samples, settings_.max_samples());
    return budget_;
}

// Milliseconds that this round may shade. The first of two rounds measures; where the overhead of a second would be more than its shading,
// the first has all the time.
double ErrorControl::time_to_shade(double elapsed) {
    const double left = std::max(settings_.time_budget() - elapsed - after_shading * throughput_.round_milliseconds, 0.0);
    first_of_two_ = round_ == 1 && left > 4 * throughput_.round_milliseconds;
    return first_of_two_ ? first_part * left : left;
}

bool ErrorControl::out_of_time(const RoundCost& cost) {
    // The throughput of a round of few pixels is not that of others.
    if (!cost.made_programs && double(cost.pixels) >= representative_part * shaded_) throughput_.update(cost, first_of_two_);
    if (settings_.time_budget() <= 0) return false;
    const double left = settings_.time_budget() - cost.elapsed_milliseconds - throughput_.round_milliseconds;
    return left < std::max(worthwhile_part * settings_.time_budget(), throughput_.round_milliseconds);
}

namespace {

// A tile's mean squared error of interpolation, less so many of its standard errors.
double error_in(const ErrorEstimate::Tile& tile, double frame_mean, double standard_errors) {
    const double count = tile.validation, mean = (tile.sum + prior_validation_pixels * frame_mean) / (count + prior_validation_pixels);
    const double deviation = std::sqrt(std::max(tile.squares, 0.0)) / (count + prior_validation_pixels);
    return std::max(mean - standard_errors * deviation, 0.0);
}

}  // namespace

// Scales each tile's bandwidth by the error that its validation pixels have measured, less so many standard errors, so that the frame's
// mean squared error of interpolation becomes what is allowed. True: some scale has grown.
bool ErrorControl::refine_levels(const ErrorEstimate& estimate, double allowed, double standard_errors) {
    if (settings_.bandwidth_scale() > 0) return false;
    double validation = 0, sum = 0, interpolated = 0;
    for (const ErrorEstimate::Tile& tile : estimate.tiles) {
        validation += tile.validation;
        sum += tile.sum;
        interpolated += tile.interpolated;
    }
    if (validation == 0 || interpolated == 0) return false;
    const double frame_mean = std::max(sum / validation, 0.0);
    std::vector<double> errors;
    for (const ErrorEstimate::Tile& tile : estimate.tiles) errors.push_back(error_in(tile, frame_mean, standard_errors));
    // Tiles above a common error are brought down to it: to that which leaves the frame what is allowed.
    const auto left = [&](double most) {
        double all = 0;
        for (size_t i = 0; i < errors.size(); ++i) all += estimate.tiles[i].interpolated * std::min(errors[i], most);
        return all;
    };
    double common = 0, too_much = 1;  // BiasEstimate::largest_square
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (common + too_much);
        (left(middle) <= allowed * forecast_.covered ? common : too_much) = middle;
    }
    bool grown = false;
    for (size_t i = 0; i < errors.size(); ++i) {
        if (estimate.tiles[i].interpolated == 0 || !(errors[i] > 0)) continue;
        const double factor = common > 0 ? std::min(std::pow(errors[i] / common, growth_power), most_growth) : most_growth;
        if (!(factor > least_growth)) continue;
        scales_.of[i] = float(std::min(scales_.of[i] * factor, Settings::largest_bandwidth_scale));
        grown = true;
    }
    return grown;
}

// Where few pixels are left to be interpolated, a larger part of them has to be validated, in the end all.
void ErrorControl::choose_validation_part(const ErrorEstimate& estimate) {
    double candidates = 1;
    for (const ErrorEstimate::Slot& slot : estimate.slots) candidates += double(slot.interpolated + slot.validation);
    validation_part_ = std::max(validation_part_, std::min(enough_validation_pixels / candidates, 1.0));
}

bool ErrorControl::needs_another_round(const ErrorEstimate& estimate, const RoundCost& cost) {
    const double target = settings_.target_error();
    const bool late = out_of_time(cost);
    if (target <= 0 && settings_.time_budget() <= 0) return false;
    if (late || round_ == most_rounds) return false;
    // A pixel whose value one bright sample dominates has an uncertain noise: its standard error is added, so that it is sampled again.
    const double seen = estimate.shading() + estimate.interpolation + caution * estimate.noise_deviation;
    const double careful = seen + caution * std::hypot(estimate.interpolation_deviation, estimate.bias_deviation);
    if (std::sqrt(careful) <= good_enough * target || std::sqrt(seen) <= near_enough * target) return false;
    if (!(target_ > 0)) {
        if (round_ > 1) return false;
        refine_levels(estimate, interpolation_share * first_part * estimate.shading(), 1);  // of the noise that the rest of the time will leave
        return true;
    }
    choose_validation_part(estimate);
    // Not where the user has chosen the scale, nor where time would not suffice for all pixels.
    const bool gives_up = interpolates_ && round_ >= most_refinements && estimate.interpolation > interpolation_share * goal() &&
                          !(settings_.bandwidth_scale() > 0) && !(settings_.time_budget() > 0);
    if (gives_up) interpolates_ = false;
    const double goal = this->goal(), share = share_of_interpolation(), shading_allowed = noise_allowed();
    // While noise is large, a few bright samples look like errors of interpolation; and levels are never coarsened again. Errors within
    // their standard error are no reason to refine, unless little noise is left.
    bool grown = gives_up;
    if (interpolates_ && estimate.shading() <= trusted_noise * shading_allowed)
        grown = refine_levels(estimate, std::clamp(goal - estimate.shading(), share * goal, std::max(share, most_interpolation) * goal),
                               estimate.shading() > certain_noise * shading_allowed ? 1 : 0);
    if (!grown && estimate.shading() <= shading_allowed) {
        // Both are small enough: only standard errors are left.
        if (std::sqrt(seen) <= good_enough * target) return false;
        grown = refine_levels(estimate, share * goal, 0);
    }
    const double kept = std::min(estimate.interpolation, share * goal);
    wanted_part_ = std::clamp((goal - kept) / estimate.shading(), most_progress, grown ? 1 : least_progress);
    const bool at_most = std::all_of(budget_.begin(), budget_.end(), [&](uint32_t n) { return n >= settings_.max_samples(); });
    return grown || !at_most;
}

}  // namespace lightband
