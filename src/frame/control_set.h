// The control set: a few pixels, chosen by chance, that are also shaded with more samples than the frame gives them.
// What the picture shows there is compared with these control samples, which see errors that the spread of a pixel's
// own samples does not (0010).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "picture/constants.h"
#include "picture/settings.h"

namespace lightband {

// Whether a pixel is among those chosen by chance, `part` of all. Whoever is chosen for a small part is chosen for a
// larger one, too. shaders/chosen_pixels.glsl chooses the same pixels.
bool is_chosen_by(uint32_t x, uint32_t y, uint32_t seed, double part);

struct ControlSet {
    // Luminance; half the difference of its two replicates; its standard deviation, as if its samples were independent;
    // and the luminance that was predicted (0: none was).
    struct Pixel {
        uint32_t at;  // y * width + x
        float mean, spread, deviation, expected;
        bool biased;  // whether by the frame's own sampler, which has the frame's bias, but less of it
    };
    std::vector<Pixel> pixels;
    uint32_t samples = 0;  // of those that are biased

    // The squared error of a pixel that displays this luminance, relative to `scale`.
    double square(const Pixel& pixel, double displayed, double scale, double own_samples) const;
    // The same of a value whose bias is not the control samples', as an interpolated one. sampled: squared error of the
    // pixel's own samples.
    double squared_error_of_other(const Pixel& pixel, double displayed, double scale, double sampled,
                                  double own_samples) const;
    // Whether it has so many more samples than the pixel that its own error does not matter.
    bool is_better_than(const Pixel& pixel, double own_samples) const {
        return own_samples > 0 && (!pixel.biased || has_enough_samples_for(own_samples));
    }
    bool has_enough_samples_for(double own_samples) const;

    // The part of the covered pixels in the set; samples of each; and pilot samples of each, which tell how much
    // samples vary (0 where nothing is asked for that this would help to plan).
    struct Effort {
        double part = 0;
        uint32_t samples = 0, pilot = 0;
    };
    // affordable: samples that a frame with a time budget has time for, the fixed cost of its pixels included
    // (constants::pixel_samples).
    static Effort effort(const Settings& settings, double covered_pixels, double affordable);
    // So many samples without bias err less than that many pilot samples of a light cut.
    static uint32_t unbiased_samples(double pilot);
    // Whether samples without bias have found light that the cut has missed. They may miss a small source themselves:
    // that they saw less proves nothing.
    static bool sees_more_than(const Pixel& unbiased, const Pixel& cut);
};

// An error that all pixels have in common, to the same side, as a light cut of few parts has on an even surface.
// Control samples err to that side too, only less, so that a part of the error does not show in a comparison with them.
class CommonModeError {
public:
    // A pixel's relative deviation from its control samples; own_part: its number of samples over theirs.
    void add(double deviation, double own_part);
    // Mean squared error that does not show.
    double unseen() const;

private:
    double count_ = 0, sum_ = 0, squares_ = 0, visible_ = 0;
};

// By how much the pixels of the control set err more than their spreads estimate.
class BiasEstimate {
public:
    // part: of the covered pixels, in the control set. Of a frame that is in it entirely there is no sampling error.
    explicit BiasEstimate(double part = 0) : part_(part) {}

    // Squared and relative: a pixel's error as the control samples see it, and as its spread estimates it.
    void add(double square, double estimated);
    // Of a pixel that has outgrown its control samples, whose spread is taken for its error. Without these, the pixels
    // that got more samples because they err most would drop out, and the others would stand for all.
    void add_clamped(double estimated) { add(std::min(estimated, constants::largest_square), estimated); }

    // What a mean squared error is beyond `noise`, which the spreads estimate, weighted by its certainty; negative
    // where the spreads estimate more than there is.
    struct Bias {
        double mean = 0, deviation = 0;
    };
    Bias beyond(double noise) const;
    // The mean squared error of the pixels themselves.
    double error() const;

private:
    double part_;
    std::vector<double> squares_, estimated_;
};

}  // namespace lightband
