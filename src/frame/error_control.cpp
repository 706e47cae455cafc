#include "frame/error_control.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "picture/constants.h"

namespace lightband {
namespace {

// The part of its noise that must be planned for, by a model in which it falls as the samples, so that it becomes
// `part` of what it is.
double reached_by_more(double part) {
    return std::pow(part, 1 / constants::stratified_gain);
}

double total(const Histogram& histogram) {
    return double(std::accumulate(histogram.begin(), histogram.end(), uint64_t(0)));
}

}  // namespace

void Throughput::update(const RoundCost& cost, bool first_of_two) {
    round_milliseconds = cost.other_milliseconds;
    if (!(cost.shading_milliseconds > 0) || cost.samples == 0) return;
    const double seen =
        (double(cost.samples) + constants::pixel_samples * double(cost.pixels)) / cost.shading_milliseconds;
    if (!first_of_two || !known) samples_per_millisecond = seen;
    // The throughput of later rounds is known from the frames before, up to how fast the device is now, for which a
    // short round stands by half.
    else if (of_first_round > 0)
        samples_per_millisecond *= std::sqrt(seen / of_first_round);
    if (first_of_two) of_first_round = seen;
    known = true;
}

ErrorControl::ErrorControl(const Settings& settings, const Forecast& forecast, size_t tiles,
                           const Throughput& throughput, double elapsed)
    : settings_(settings), forecast_(forecast), target_(settings.target_error()), throughput_(throughput) {
    interpolates_ = settings.coarsest_level() > 0;
    const bool known = forecast.pilot_error > 0;
    if (settings.time_budget() > 0 && !(known && first_cost(forecast.covered, 0) <= affordable(elapsed))) target_ = 0;
    // Half of the pixels at most, or small frames would not be interpolated.
    validation_part_ = std::clamp(constants::enough_validation_pixels / std::max(forecast.covered, 1.0),
                                  constants::least_validation_part, 0.5);
    scales_.first = float(first_scale(elapsed));
    scales_.of.assign(tiles, scales_.first);
}

double ErrorControl::first_scale(double elapsed) {
    if (settings_.bandwidth_scale() > 0) return settings_.bandwidth_scale();
    double expected = constants::expected_interpolation_error;
    if (target_ > 0) {
        allowed_interpolation_ = std::sqrt(constants::interpolation_share) * constants::aim * target_;
    } else {
        // With samples shared for least error, the noise of a frame is the mean deviation over the root of the mean
        // count.
        double samples = settings_.samples();
        if (settings_.time_budget() > 0) {
            // A tenth of the time at least: where there is none left, the coarsest levels serve best.
            const double least = 0.1 * settings_.time_budget() * throughput_.samples_per_millisecond;
            samples = std::max(
                std::max(affordable(elapsed), least) / std::max(forecast_.covered, 1.0) - constants::pixel_samples,
                constants::fewest_samples_in_time);
        } else {
            expected = constants::unmeasured_interpolation_error;
        }
        allowed_interpolation_ = expected_noise_ = forecast_.relative_deviation / std::sqrt(samples);
    }
    const double most = Settings::largest_bandwidth_scale;
    return allowed_interpolation_ > 0
               ? std::min(most, std::pow(expected / allowed_interpolation_, 1 / constants::interpolation_error_power))
               : most;
}

double ErrorControl::tolerance() const {
    if (target_ > 0)
        return std::clamp(constants::contrast_tolerance * target_, constants::least_contrast_tolerance,
                          constants::most_contrast_tolerance);
    return std::max(constants::most_contrast_tolerance, expected_noise_);
}

// Samples that there is time for, the fixed cost of pixels included.
double ErrorControl::affordable(double elapsed) const {
    return std::max(settings_.time_budget() - elapsed - throughput_.round_milliseconds, 0.0) *
           throughput_.samples_per_millisecond;
}

double ErrorControl::goal() const {
    return std::pow(constants::aim * target_, 2);
}
double ErrorControl::share_of_interpolation() const {
    return interpolates_ ? constants::interpolation_share : 0;
}
double ErrorControl::noise_allowed() const {
    return (1 - share_of_interpolation()) * goal();
}

double ErrorControl::first_noise(double share) const {
    return share > 0 ? constants::first_round_noise * (1 - share) * goal() : goal();
}

// The predicted noise is scaled so that it agrees with the pilot samples where every pixel has as many samples as they
// are; from there more samples lead to the goal.
double ErrorControl::predicted_goal(const Histogram& histogram) const {
    const double predicted =
        predicted_noise(histogram, Budget(budget_bins, forecast_.pilot_samples), settings_.allocation());
    if (!(forecast_.pilot_error > 0) || !(predicted > 0)) return noise_allowed() * forecast_.covered;
    return predicted * reached_by_more(first_noise(share_of_interpolation()) / forecast_.pilot_error);
}

// The cost of so many pixels in a first round, in samples, as pilot samples predict it.
double ErrorControl::first_cost(double pixels, double share) const {
    const double noise = forecast_.pilot_error / first_noise(share);
    return pixels *
           (constants::pixel_samples +
            std::max(forecast_.pilot_samples * std::pow(noise, 1 / constants::stratified_gain), double(least_samples)));
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

// Interpolation takes a share of the error, so that each shaded pixel needs more samples: it must save more pixels than
// that.
bool ErrorControl::interpolation_saves_samples(double shaded) const {
    if (!(forecast_.pilot_error > 0)) return true;
    return first_cost(shaded, constants::interpolation_share) < first_cost(forecast_.covered, 0);
}

bool ErrorControl::interpolation_saves_time(double shaded, double affordable) const {
    const double each = affordable / std::max(shaded, 1.0) - constants::pixel_samples,
                 of_all = affordable / forecast_.covered - constants::pixel_samples;
    return of_all < least_samples ||
           each * reached_by_more(constants::first_round_noise * (1 - constants::interpolation_share)) > of_all;
}

bool ErrorControl::coarsen(double shaded, double affordable) {
    const double part =
        affordable / (constants::pixel_samples + constants::fewest_samples_in_time) / std::max(shaded, 1.0);
    if (part >= 1) return false;
    // Pixels shaded grow about as the scale.
    scales_.first *= float(std::max(part, constants::most_coarsening));
    scales_.of.assign(scales_.of.size(), scales_.first);
    return true;
}

const Budget& ErrorControl::plan(const Histogram& histogram, double elapsed) {
    ++round_;
    const double pixels = shaded_ = std::max(total(histogram), 1.0);
    if (target_ > 0) {
        budget_ = plan_noise(histogram, predicted_goal(histogram), settings_.max_samples(), settings_.allocation());
    } else if (settings_.time_budget() > 0) {
        const double mean =
            time_to_shade(elapsed) * throughput_.samples_per_millisecond / pixels - constants::pixel_samples;
        budget_ = plan_mean(histogram, std::max(mean, constants::fewest_samples_in_time), settings_.max_samples());
    } else if (settings_.method() == Method::reference) {
        budget_.assign(budget_bins, settings_.samples());
    } else {
        budget_ = plan_mean(histogram, settings_.samples(), settings_.max_samples());
    }
    return budget_;
}

const Budget& ErrorControl::plan_further(const std::vector<SampledGroup>& sampled, const Histogram& new_pixels,
                                         double elapsed) {
    ++round_;
    shaded_ = total(new_pixels);
    for (const SampledGroup& group : sampled) shaded_ += group.pixels;
    if (!(settings_.time_budget() > 0)) return budget_;
    // As many samples as there is time for, or as the error needs, where those are fewer.
    const double most = time_to_shade(elapsed) * throughput_.samples_per_millisecond;
    const RoundSamples needed = round_samples(sampled, new_pixels, budget_);
    if (!(target_ > 0) || needed.samples + constants::pixel_samples * needed.pixels > most)
        budget_ = replan_cost(sampled, new_pixels, most, constants::pixel_samples, settings_.max_samples());
    return budget_;
}

// Milliseconds that this round may shade. The first of two rounds measures; where the overhead of a second would be
// more than its shading, the first has all the time.
double ErrorControl::time_to_shade(double elapsed) {
    const double left = std::max(
        settings_.time_budget() - elapsed - constants::overhead_after_shading * throughput_.round_milliseconds, 0.0);
    first_of_two_ = round_ == 1 && left > 4 * throughput_.round_milliseconds;
    return first_of_two_ ? constants::first_round_time * left : left;
}

bool ErrorControl::out_of_time(const RoundCost& cost) {
    // The throughput of a round of few pixels is not that of others.
    if (!cost.made_programs && double(cost.pixels) >= constants::representative_part * shaded_)
        throughput_.update(cost, first_of_two_);
    if (settings_.time_budget() <= 0) return false;
    const double left = settings_.time_budget() - cost.elapsed_milliseconds - throughput_.round_milliseconds;
    return left < std::max(constants::worthwhile_time * settings_.time_budget(), throughput_.round_milliseconds);
}

namespace {

// A tile's mean squared error of interpolation, less so many of its standard errors.
double error_in(const ErrorEstimate::Tile& tile, double frame_mean, double standard_errors) {
    const double count = tile.validation, mean = (tile.sum + constants::prior_validation_pixels * frame_mean) /
                                                 (count + constants::prior_validation_pixels);
    const double deviation = std::sqrt(std::max(tile.squares, 0.0)) / (count + constants::prior_validation_pixels);
    return std::max(mean - standard_errors * deviation, 0.0);
}

}  // namespace

// Scales each tile's bandwidth by the error that its validation pixels have measured, less so many standard errors, so
// that the frame's mean squared error of interpolation becomes what is allowed. True: some scale has grown.
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
    for (const ErrorEstimate::Tile& tile : estimate.tiles)
        errors.push_back(error_in(tile, frame_mean, standard_errors));
    // Tiles above a common error are brought down to it: to that which leaves the frame what is allowed.
    const auto left = [&](double most) {
        double all = 0;
        for (size_t i = 0; i < errors.size(); ++i) all += estimate.tiles[i].interpolated * std::min(errors[i], most);
        return all;
    };
    double common = 0, too_much = constants::largest_square;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (common + too_much);
        (left(middle) <= allowed * forecast_.covered ? common : too_much) = middle;
    }
    bool grown = false;
    for (size_t i = 0; i < errors.size(); ++i) {
        if (estimate.tiles[i].interpolated == 0 || !(errors[i] > 0)) continue;
        const double factor = common > 0 ? std::min(std::pow(errors[i] / common, constants::scale_growth_power),
                                                    constants::most_scale_growth)
                                         : constants::most_scale_growth;
        if (!(factor > constants::least_scale_growth)) continue;
        scales_.of[i] = float(std::min(scales_.of[i] * factor, Settings::largest_bandwidth_scale));
        grown = true;
    }
    return grown;
}

// Where few pixels are left to be interpolated, a larger part of them has to be validated, in the end all.
void ErrorControl::choose_validation_part(const ErrorEstimate& estimate) {
    double candidates = 1;
    for (const ErrorEstimate::Slot& slot : estimate.slots) candidates += double(slot.interpolated + slot.validation);
    validation_part_ = std::max(validation_part_, std::min(constants::enough_validation_pixels / candidates, 1.0));
}

bool ErrorControl::needs_another_round(const ErrorEstimate& estimate, const RoundCost& cost) {
    const double target = settings_.target_error();
    const bool late = out_of_time(cost);
    if (target <= 0 && settings_.time_budget() <= 0) return false;
    if (late || round_ == constants::most_rounds) return false;
    // A pixel whose value one bright sample dominates has an uncertain noise: its standard error is added, so that it
    // is sampled again.
    const double seen =
        estimate.shading() + estimate.interpolation + constants::added_standard_errors * estimate.noise_deviation;
    const double careful =
        seen + constants::added_standard_errors * std::hypot(estimate.interpolation_deviation, estimate.bias_deviation);
    if (std::sqrt(careful) <= constants::good_enough * target || std::sqrt(seen) <= constants::near_enough * target)
        return false;
    if (!(target_ > 0)) {
        if (round_ > 1) return false;
        refine_levels(estimate, constants::interpolation_share * constants::first_round_time * estimate.shading(),
                      1);  // of the noise that the rest of the time will leave
        return true;
    }
    choose_validation_part(estimate);
    // Not where the user has chosen the scale, nor where time would not suffice for all pixels.
    const bool gives_up = interpolates_ && round_ >= constants::most_refinements &&
                          estimate.interpolation > constants::interpolation_share * goal() &&
                          !(settings_.bandwidth_scale() > 0) && !(settings_.time_budget() > 0);
    if (gives_up) interpolates_ = false;
    const double goal = this->goal(), share = share_of_interpolation(), shading_allowed = noise_allowed();
    // While noise is large, a few bright samples look like errors of interpolation; and levels are never coarsened
    // again. Errors within their standard error are no reason to refine, unless little noise is left.
    bool grown = gives_up;
    if (interpolates_ && estimate.shading() <= constants::trusted_noise * shading_allowed)
        grown = refine_levels(estimate,
                              std::clamp(goal - estimate.shading(), share * goal,
                                         std::max(share, constants::most_interpolation_share) * goal),
                              estimate.shading() > constants::certain_noise * shading_allowed ? 1 : 0);
    if (!grown && estimate.shading() <= shading_allowed) {
        // Both are small enough: only standard errors are left.
        if (std::sqrt(seen) <= constants::good_enough * target) return false;
        grown = refine_levels(estimate, share * goal, 0);
    }
    const double kept = std::min(estimate.interpolation, share * goal);
    wanted_part_ =
        std::clamp((goal - kept) / estimate.shading(), constants::most_progress, grown ? 1 : constants::least_progress);
    const bool at_most =
        std::all_of(budget_.begin(), budget_.end(), [&](uint32_t n) { return n >= settings_.max_samples(); });
    return grown || !at_most;
}

}  // namespace lightband
