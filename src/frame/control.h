// From what the user asked (samples, an error, a time) to rounds: prediction plans the first, measurement corrects the next.
#pragma once

#include <vector>

#include "frame/estimate.h"
#include "picture/budget.h"
#include "picture/forecast.h"
#include "picture/settings.h"

namespace lightband {

// What a round cost.
struct RoundCost {
    uint64_t pixels = 0, samples = 0;  // that it drew
    double shading_milliseconds = 0;
    double other_milliseconds = 0;    // lists, interpolation, measurement
    double elapsed_milliseconds = 0;  // since the frame began
    bool made_programs = false;       // which no later round pays for
};

// How fast a device shades: learnt from round to round and from frame to frame.
struct Pace {
    // A pixel costs as much as so many samples before its first one: the odds of the map's clusters, or the trunk of a cut.
    static constexpr double pixel_samples = 30;
    double samples_per_millisecond = 5000;  // those included; a guess, until a frame has measured it
    bool known = false;                     // whether one has
    double of_first_round = 0;              // of the first of two, whose few samples cost otherwise than many; 0: none was measured
    double round_milliseconds = 0;          // of a round beside its shading

    void learn(const RoundCost& cost, bool first_of_two);
};

class Control {
public:
    // tiles: of the frame (frame/estimate.h); pace: what the device was last seen to do; elapsed: milliseconds since the frame began.
    Control(const Settings& settings, const Forecast& forecast, size_t tiles, const Pace& pace, double elapsed);

    const Scales& scales() const { return scales_; }
    // The part of pixels that are shaded although they might be interpolated, to measure what interpolation costs.
    double witnesses() const { return witnesses_; }
    // By how much, relatively, what the pilots expect of a pixel may differ from interpolation of what they expect of its parents.
    double tolerance() const;
    // What was learnt of the device.
    const Pace& pace() const { return pace_; }
    // Whether pixels may be interpolated; no longer, where it does not pay or rounds have not found levels for it.
    bool interpolates() const { return interpolates_; }
    // Before the first round: coarser levels, where the time that is left does not last for so many pixels; no interpolation, where it
    // does not pay. True: pixels are to be classified anew.
    bool reconsider(const Histogram& histogram, double elapsed);
    // Samples of each bin in the first round; elapsed: milliseconds since the frame began.
    const Budget& plan(const Histogram& histogram, double elapsed);
    // And in a further one. drawn: what former rounds drew; fresh: pixels that this is the first to draw.
    const Budget& plan_further(const std::vector<DrawnGroup>& drawn, const Histogram& fresh, double elapsed);
    const Budget& budget() const { return budget_; }
    // Part of the noise that the next round is to leave; 0: as much as time lets.
    double wanted_part() const { return wanted_part_; }
    // Whether another round is needed after what the last one gave.
    bool again(const ErrorEstimate& estimate, const RoundCost& cost);

private:
    double light(double elapsed) const;
    bool improve_levels(const ErrorEstimate& estimate, double allowed, double doubt);
    void choose_witnesses(const ErrorEstimate& estimate);
    bool out_of_time(const RoundCost& cost);
    double goal() const;  // mean squares over the covered pixels: of the frame, of its noise, of what a first round plans for
    double share_of_interpolation() const;
    double noise_allowed() const;
    double first_noise(double share) const;
    double predicted_goal(const Histogram& histogram) const;
    double first_cost(double pixels, double share) const;
    bool pays(double shaded) const;
    bool pays_in_time(double shaded, double light) const;
    bool coarsen(double shaded, double light);
    double time_to_shade(double elapsed);
    double first_scale(double elapsed);

    const Settings& settings_;
    const Forecast forecast_;
    // The error that is asked for; 0: time governs, where none is, or none that shading every pixel is known to reach in time.
    double target_;
    Scales scales_;
    double witnesses_;
    bool interpolates_;
    double shaded_ = 0;          // pixels
    Budget budget_;
    double wanted_part_ = 0;     // of its noise that the next round is to leave
    double expected_noise_ = 0;  // of a frame that asks for no error
    Pace pace_;
    double allowed_interpolation_ = 0;  // error of the first round
    uint32_t round_ = 0;
    bool first_of_two_ = false;  // rounds of a frame with a time budget
};

}  // namespace lightband
