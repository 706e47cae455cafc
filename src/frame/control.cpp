#include "frame/control.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightband {
namespace {

// What is known of interpolation. Error of a frame whose levels follow its bandwidth unscaled: as a frame of given samples, which does not
// measure, takes it to be, and as one does that asks for an error and corrects itself. It falls with the scale to this power. Measured on
// scanned meshes the error lies between 0.01 (a matte fabric) and 0.1 (a clear coat under a probe). A frame that corrects itself begins
// below the lower, since levels can be refined later and never coarsened.
constexpr double unmeasured_error = 0.08, expected_error = 0.005, error_power = 2;
// A tile's scale grows by the squared error of interpolation over what is allowed to this power. For a smooth picture scales would have to
// grow by the fourth root; near edges, where most of the error comes from, it falls more slowly, and a further round costs more than some
// pixels too many: the twelve spheres of docs/trade.md took 0.89 of the time at equal error at 2 %, 0.97 at 1 %, that a power of 1/2 and
// at most 4 times took; a power of 1 as much at 2 % and more at 1 %.
constexpr double growth_power = 0.75;
// What the pilots may say against interpolation, relatively, in parts of the error asked for.
constexpr double tolerance_part = 1.2;
// A part of the pixels to be witnesses that costs little.
constexpr double cheap_witnesses = 1.0 / 16;
// The part of the allowed noise that a first round plans for. What pixels are interpolated from passes its noise on to many: first rounds
// were seen to leave between half and twice of what a probe foretold for them, and a second costs more than some samples.
constexpr double held_by_first = 0.55;

// The least that pilots may say against interpolation is what they disagree about among themselves, from view to view; the most is for
// frames that ask for no error.
constexpr double least_tolerance = 0.03, most_tolerance = 0.5;

// Share of interpolation in the squared error. Pixels shaded grow about as the scale, the square of interpolation's error falls
// as its fourth power, that of noise as the samples: time is least where the former is some quarter of the whole.
constexpr double interpolation_share = 0.3, most_interpolation = 0.5;
// Rounds aim below what was asked, by what the estimate may miss. The last is one that is thought to come this near, or, with all
// that is in doubt, that near.
constexpr double aim = 0.8, near_enough = 0.85, good_enough = 0.93;
// Standard errors of an estimate that are added before a round is called good enough.
constexpr double caution = 1;
constexpr uint32_t most_rounds = 8;
// What so many rounds have not found levels for is not interpolated.
constexpr uint32_t most_refinements = 5;
// Steps of a tile's scale below the least would not be worth a new classification.
constexpr double least_growth = 1.1, most_growth = 8;
// Witnesses are heard where noise is at most so many times what is allowed, and believed without doubt up to the other.
constexpr double trusted_noise = 3, blameless_noise = 1.25;
// A tile's few witnesses are joined by so many that saw the frame's mean.
constexpr double prior_witnesses = 4;
// A round that did not suffice, though no level was at fault, is followed by one of at most this part of its noise.
// And of no less than that other part: the noise of few samples is itself known badly, often far too high.
constexpr double least_progress = 0.9, most_progress = 0.25;
// Witnesses that tell; a part of the pixels, as above, costs little.
constexpr double telling_witnesses = 256;
// Part of the time that the first of two rounds may take, and the least part for which another is worth its lists.
constexpr double first_part = 0.15, worthwhile_part = 0.1;
// So few samples are drawn even where no time is left: a pixel costs more before its first one.
constexpr double fewest_in_time = 6;
// Levels are made coarser by this part at most, where time does not last for all pixels that they would shade.
constexpr double least_part = 0.1;
// Part of the shaded pixels that a round must draw for its pace to be learnt from.
constexpr double telling_part = 0.25;
// Of what a round spends beside shading, the part that comes after it.
constexpr double after_shading = 0.6;

// The part of its noise that must be planned for, by a model in which it falls as the samples, so that it becomes `part` of what it is.
double reached_by_more(double part) { return std::pow(part, 1 / stratified_gain); }

double total(const Histogram& histogram) { return double(std::accumulate(histogram.begin(), histogram.end(), uint64_t(0))); }

}  // namespace

void Pace::learn(const RoundCost& cost, bool first_of_two) {
    round_milliseconds = cost.other_milliseconds;
    if (!(cost.shading_milliseconds > 0) || cost.samples == 0) return;
    const double seen = (double(cost.samples) + pixel_samples * double(cost.pixels)) / cost.shading_milliseconds;
    if (!first_of_two || !known) samples_per_millisecond = seen;
    // What later rounds do is known from the frames before, up to how fast the device is now; of which a short round says half.
    else if (of_first_round > 0) samples_per_millisecond *= std::sqrt(seen / of_first_round);
    if (first_of_two) of_first_round = seen;
    known = true;
}

Control::Control(const Settings& settings, const Forecast& forecast, size_t tiles, const Pace& pace, double elapsed)
    : settings_(settings), forecast_(forecast), target_(settings.target_error()), pace_(pace) {
    interpolates_ = settings.coarsest_level() > 0;
    const bool known = forecast.probed_error > 0;
    if (settings.time_budget() > 0 && !(known && first_cost(forecast.covered, 0) <= light(elapsed))) target_ = 0;
    // Half of the pixels at most, or small frames would not be interpolated.
    witnesses_ = std::clamp(telling_witnesses / std::max(forecast.covered, 1.0), cheap_witnesses, 0.5);
    scales_.first = float(first_scale(elapsed));
    scales_.of.assign(tiles, scales_.first);
}

double Control::first_scale(double elapsed) {
    if (settings_.bandwidth_scale() > 0) return settings_.bandwidth_scale();
    double expected = expected_error;
    if (target_ > 0) {
        allowed_interpolation_ = std::sqrt(interpolation_share) * aim * target_;
    } else {
        // With samples shared for least error, the noise of a frame is the mean deviation over the root of the mean count.
        double samples = settings_.samples();
        if (settings_.time_budget() > 0) {
            // A tenth of the time at least: where there is none left, the coarsest levels serve best.
            const double least = 0.1 * settings_.time_budget() * pace_.samples_per_millisecond;
            samples = std::max(std::max(light(elapsed), least) / std::max(forecast_.covered, 1.0) - Pace::pixel_samples, fewest_in_time);
        } else {
            expected = unmeasured_error;
        }
        allowed_interpolation_ = expected_noise_ = forecast_.relative_deviation / std::sqrt(samples);
    }
    const double most = Settings::largest_bandwidth_scale;
    return allowed_interpolation_ > 0 ? std::min(most, std::pow(expected / allowed_interpolation_, 1 / error_power)) : most;
}

double Control::tolerance() const {
    if (target_ > 0)
        return std::clamp(tolerance_part * target_, least_tolerance, most_tolerance);
    return std::max(most_tolerance, expected_noise_);
}

// Samples that there is time for, those included that a pixel costs before its first one.
double Control::light(double elapsed) const {
    return std::max(settings_.time_budget() - elapsed - pace_.round_milliseconds, 0.0) * pace_.samples_per_millisecond;
}

double Control::goal() const { return std::pow(aim * target_, 2); }
double Control::share_of_interpolation() const { return interpolates_ ? interpolation_share : 0; }
double Control::noise_allowed() const { return (1 - share_of_interpolation()) * goal(); }

double Control::first_noise(double share) const {
    return share > 0 ? held_by_first * (1 - share) * goal() : goal();
}

// What shares and samples foretell of the noise is made to agree with the probe where every pixel has as many samples as that; from
// there the goal is reached by more.
double Control::predicted_goal(const Histogram& histogram) const {
    const double foretold = predicted_noise(histogram, Budget(budget_bins, forecast_.probe_samples), settings_.allocation());
    if (!(forecast_.probed_error > 0) || !(foretold > 0)) return noise_allowed() * forecast_.covered;
    return foretold * reached_by_more(first_noise(share_of_interpolation()) / forecast_.probed_error);
}

// Samples of so many pixels that a first round takes, as a probe foretells, those included that a pixel costs before its first one.
double Control::first_cost(double pixels, double share) const {
    const double noise = forecast_.probed_error / first_noise(share);
    return pixels * (Pace::pixel_samples + std::max(forecast_.probe_samples * std::pow(noise, 1 / stratified_gain), double(least_samples)));
}

bool Control::reconsider(const Histogram& histogram, double elapsed) {
    if (round_ > 0 || settings_.bandwidth_scale() > 0) return false;
    const double shaded = total(histogram);
    const bool interpolated = interpolates_;
    if (target_ > 0) {
        interpolates_ = interpolated && pays(shaded);
    } else if (settings_.time_budget() > 0) {
        if (coarsen(shaded, light(elapsed))) return true;
        interpolates_ = interpolated && pays_in_time(shaded, light(elapsed));
    }
    return interpolated != interpolates_;
}

// Interpolation takes a share of the error, and so more samples of each pixel: it pays where it spares more pixels than that.
bool Control::pays(double shaded) const {
    if (!(forecast_.probed_error > 0)) return true;
    return first_cost(shaded, interpolation_share) < first_cost(forecast_.covered, 0);
}

bool Control::pays_in_time(double shaded, double light) const {
    const double each = light / std::max(shaded, 1.0) - Pace::pixel_samples, of_all = light / forecast_.covered - Pace::pixel_samples;
    return of_all < least_samples || each * reached_by_more(held_by_first * (1 - interpolation_share)) > of_all;
}

bool Control::coarsen(double shaded, double light) {
    const double part = light / (Pace::pixel_samples + fewest_in_time) / std::max(shaded, 1.0);
    if (part >= 1) return false;
    // Pixels shaded grow about as the scale.
    scales_.first *= float(std::max(part, least_part));
    scales_.of.assign(scales_.of.size(), scales_.first);
    return true;
}

const Budget& Control::plan(const Histogram& histogram, double elapsed) {
    ++round_;
    const double pixels = shaded_ = std::max(total(histogram), 1.0);
    if (target_ > 0) {
        budget_ = plan_noise(histogram, predicted_goal(histogram), settings_.max_samples(), settings_.allocation());
    } else if (settings_.time_budget() > 0) {
        const double mean = time_to_shade(elapsed) * pace_.samples_per_millisecond / pixels - Pace::pixel_samples;
        budget_ = plan_mean(histogram, std::max(mean, fewest_in_time), settings_.max_samples());
    } else if (settings_.method() == Method::reference) {
        budget_.assign(budget_bins, settings_.samples());
    } else {
        budget_ = plan_mean(histogram, settings_.samples(), settings_.max_samples());
    }
    return budget_;
}

const Budget& Control::plan_further(const std::vector<DrawnGroup>& drawn, const Histogram& fresh, double elapsed) {
    ++round_;
    shaded_ = total(fresh);
    for (const DrawnGroup& group : drawn) shaded_ += group.pixels;
    if (!(settings_.time_budget() > 0)) return budget_;
    // All that there is time for; or what the error needs, where that is less.
    const double most = time_to_shade(elapsed) * pace_.samples_per_millisecond;
    const Redrawing needed = redrawing(drawn, fresh, budget_);
    if (!(target_ > 0) || needed.samples + Pace::pixel_samples * needed.pixels > most)
        budget_ = replan_cost(drawn, fresh, most, Pace::pixel_samples, settings_.max_samples());
    return budget_;
}

// Milliseconds that this round may shade. The first of two measures; where a second would spend more on its lists than on light, the
// first has it all.
double Control::time_to_shade(double elapsed) {
    const double left = std::max(settings_.time_budget() - elapsed - after_shading * pace_.round_milliseconds, 0.0);
    first_of_two_ = round_ == 1 && left > 4 * pace_.round_milliseconds;
    return first_of_two_ ? first_part * left : left;
}

bool Control::out_of_time(const RoundCost& cost) {
    // A round of few new pixels says little of others.
    if (!cost.made_programs && double(cost.pixels) >= telling_part * shaded_) pace_.learn(cost, first_of_two_);
    if (settings_.time_budget() <= 0) return false;
    const double left = settings_.time_budget() - cost.elapsed_milliseconds - pace_.round_milliseconds;
    return left < std::max(worthwhile_part * settings_.time_budget(), pace_.round_milliseconds);
}

namespace {

// A tile's mean squared error by interpolation. doubt: standard errors that may be chance.
double seen_in(const ErrorEstimate::Tile& tile, double frame_mean, double doubt) {
    const double count = tile.witnesses, mean = (tile.sum + prior_witnesses * frame_mean) / (count + prior_witnesses);
    const double deviation = std::sqrt(std::max(tile.squares, 0.0)) / (count + prior_witnesses);
    return std::max(mean - doubt * deviation, 0.0);
}

}  // namespace

// Scales each tile's bandwidth by what its witnesses saw, less as many standard errors as are doubted, so that the frame's mean square
// becomes what is allowed. True: some scale has grown.
bool Control::improve_levels(const ErrorEstimate& estimate, double allowed, double doubt) {
    if (settings_.bandwidth_scale() > 0) return false;
    double witnesses = 0, sum = 0, interpolated = 0;
    for (const ErrorEstimate::Tile& tile : estimate.tiles) {
        witnesses += tile.witnesses;
        sum += tile.sum;
        interpolated += tile.interpolated;
    }
    if (witnesses == 0 || interpolated == 0) return false;
    const double frame_mean = std::max(sum / witnesses, 0.0);
    std::vector<double> seen;
    for (const ErrorEstimate::Tile& tile : estimate.tiles) seen.push_back(seen_in(tile, frame_mean, doubt));
    // Tiles above a common error are brought down to it: to that which leaves the frame what is allowed.
    const auto left = [&](double most) {
        double all = 0;
        for (size_t i = 0; i < seen.size(); ++i) all += estimate.tiles[i].interpolated * std::min(seen[i], most);
        return all;
    };
    double common = 0, too_much = 1;  // a witness is believed up to 1
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (common + too_much);
        (left(middle) <= allowed * forecast_.covered ? common : too_much) = middle;
    }
    bool grown = false;
    for (size_t i = 0; i < seen.size(); ++i) {
        if (estimate.tiles[i].interpolated == 0 || !(seen[i] > 0)) continue;
        const double factor = common > 0 ? std::min(std::pow(seen[i] / common, growth_power), most_growth) : most_growth;
        if (!(factor > least_growth)) continue;
        scales_.of[i] = float(std::min(scales_.of[i] * factor, Settings::largest_bandwidth_scale));
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
    // A pixel that one bright sample made dominates what it is compared with: it is drawn anew rather than believed.
    const double seen = estimate.shading() + estimate.interpolation + caution * estimate.noise_deviation;
    const double careful = seen + caution * std::hypot(estimate.interpolation_deviation, estimate.bias_deviation);
    if (std::sqrt(careful) <= good_enough * target || std::sqrt(seen) <= near_enough * target) return false;
    if (!(target_ > 0)) {
        if (round_ > 1) return false;
        improve_levels(estimate, interpolation_share * first_part * estimate.shading(), 1);  // of what the rest of the time will leave
        return true;
    }
    choose_witnesses(estimate);
    // No user's scale is given up, nor is interpolation for more pixels than there is time for.
    const bool gives_up = interpolates_ && round_ >= most_refinements && estimate.interpolation > interpolation_share * goal() &&
                          !(settings_.bandwidth_scale() > 0) && !(settings_.time_budget() > 0);
    if (gives_up) interpolates_ = false;
    const double goal = this->goal(), share = share_of_interpolation(), shading_allowed = noise_allowed();
    // While noise is large, a few bright samples make witnesses that see ghosts; and levels never coarsen again. What they may have seen
    // by chance is no reason to shade more, unless there is no noise left to blame.
    bool grown = gives_up;
    if (interpolates_ && estimate.shading() <= trusted_noise * shading_allowed)
        grown = improve_levels(estimate, std::clamp(goal - estimate.shading(), share * goal, std::max(share, most_interpolation) * goal),
                               estimate.shading() > blameless_noise * shading_allowed ? 1 : 0);
    if (!grown && estimate.shading() <= shading_allowed) {
        // Neither is to blame: what is left is doubt.
        if (std::sqrt(seen) <= good_enough * target) return false;
        grown = improve_levels(estimate, share * goal, 0);
    }
    const double kept = std::min(estimate.interpolation, share * goal);
    wanted_part_ = std::clamp((goal - kept) / estimate.shading(), most_progress, grown ? 1 : least_progress);
    const bool at_most = std::all_of(budget_.begin(), budget_.end(), [&](uint32_t n) { return n >= settings_.max_samples(); });
    return grown || !at_most;
}

}  // namespace lightband
