// Error control: turns what the user asked for (samples, an error, a time) into rounds of shading. The first round is
// planned by what was predicted, each further one by what the rounds before it measured (docs/decisions/0007).
#pragma once

#include <vector>

#include "frame/estimate.h"
#include "picture/budget.h"
#include "picture/forecast.h"
#include "picture/settings.h"

namespace lightband {

// What a round cost.
struct RoundCost {
    uint64_t pixels = 0, samples = 0;  // that it shaded
    double shading_milliseconds = 0;
    double other_milliseconds = 0;    // lists, interpolation, measurement
    double elapsed_milliseconds = 0;  // since the frame began
    bool made_programs = false;       // which no later round pays for
};

// A model of how fast a device shades, updated from round to round and from frame to frame.
struct Throughput {
    double samples_per_millisecond = 5000;  // the fixed cost of pixels counted as samples (constants::pixel_samples); a
                                            // guess, until a frame has measured it
    bool known = false;                     // whether one has
    double of_first_round =
        0;  // the same of the first of two rounds, whose few samples each cost otherwise; 0: not measured
    double round_milliseconds = 0;  // of a round beside its shading

    void update(const RoundCost& cost, bool first_of_two);
};

class ErrorControl {
public:
    // tiles: of the frame (frame/estimate.h); throughput: as last measured; elapsed: milliseconds since the frame
    // began.
    ErrorControl(const Settings& settings, const Forecast& forecast, size_t tiles, const Throughput& throughput,
                 double elapsed);

    const Scales& scales() const { return scales_; }
    // The part of the pixels that are validation pixels: shaded although they might be interpolated, to measure the
    // error of interpolation.
    double validation_part() const { return validation_part_; }
    // By how much, relatively, the predicted luminance of a pixel may differ from that interpolated from its coarser
    // neighbours.
    double tolerance() const;
    const Throughput& throughput() const { return throughput_; }
    // Whether pixels may be interpolated: not where shading all of them costs less, or where rounds have not found
    // levels for it.
    bool interpolates() const { return interpolates_; }
    // Before the first round: chooses coarser levels, where the time that is left does not suffice for so many pixels;
    // or no interpolation, where that costs more. True: pixels are to be classified again.
    bool replan(const Histogram& histogram, double elapsed);
    // Samples of each bin in the first round; elapsed: milliseconds since the frame began.
    const Budget& plan(const Histogram& histogram, double elapsed);
    // And in a further round. sampled: pixels that rounds before it have shaded; new_pixels: those that it is the first
    // to shade.
    const Budget& plan_further(const std::vector<SampledGroup>& sampled, const Histogram& new_pixels, double elapsed);
    const Budget& budget() const { return budget_; }
    // Part of the noise that the next round is to leave; 0: as little as time lets.
    double wanted_part() const { return wanted_part_; }
    // Whether another round is needed after what the last one gave.
    bool needs_another_round(const ErrorEstimate& estimate, const RoundCost& cost);

private:
    double affordable(double elapsed) const;
    bool refine_levels(const ErrorEstimate& estimate, double allowed, double standard_errors);
    void choose_validation_part(const ErrorEstimate& estimate);
    bool out_of_time(const RoundCost& cost);
    double goal() const;  // mean squared errors over the covered pixels: of the frame, of its noise, of the noise of
                          // the first round
    double share_of_interpolation() const;
    double noise_allowed() const;
    double first_noise(double share) const;
    double predicted_goal(const Histogram& histogram) const;
    double first_cost(double pixels, double share) const;
    bool interpolation_saves_samples(double shaded) const;
    bool interpolation_saves_time(double shaded, double affordable) const;
    bool coarsen(double shaded, double affordable);
    double time_to_shade(double elapsed);
    double first_scale(double elapsed);

    const Settings& settings_;
    const Forecast forecast_;
    // The error that is asked for; 0: none, or one that is not known to be reached in the time that is asked for as
    // well.
    double target_;
    Scales scales_;
    double validation_part_;
    bool interpolates_;
    double shaded_ = 0;  // pixels
    Budget budget_;
    double wanted_part_ = 0;     // of its noise that the next round is to leave
    double expected_noise_ = 0;  // of a frame that asks for no error
    Throughput throughput_;
    double allowed_interpolation_ = 0;  // error of the first round
    uint32_t round_ = 0;
    bool first_of_two_ = false;  // rounds of a frame with a time budget
};

}  // namespace lightband
