// What a frame's spreads do not tell of its error: a few pixels, drawn by chance, are also shaded with more samples, and the picture is
// held against them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "picture/settings.h"

namespace lightband {

// Whether a pixel is among those drawn by chance, `part` of all; who is among few is among more. shaders/witnesses.glsl draws alike.
bool is_drawn(uint32_t x, uint32_t y, uint32_t seed, double part);

struct Audit {
    // Luminance; half the difference of its two replicates; its standard deviation, as if its samples were independent; and what was
    // predicted of it (0: nothing was).
    struct Pixel {
        uint32_t at;  // y * width + x
        float mean, spread, deviation, expected;
        bool biased;  // whether by the frame's own sampler, which errs as it does, but less
    };
    std::vector<Pixel> pixels;
    uint32_t samples = 0;  // of those that are biased

    // The squared error of a pixel that shows so much, relative to `scale`.
    double square(const Pixel& pixel, double shown, double scale, double own_samples) const;
    // The same of what does not err as the audit does. drawn: the square of what was drawn there.
    double square_of_other(const Pixel& pixel, double shown, double scale, double drawn, double own_samples) const;
    // Whether it knows better than a pixel of so many samples.
    bool tells_of(const Pixel& pixel, double own_samples) const { return own_samples > 0 && (!pixel.biased || knows_better(own_samples)); }
    bool knows_better(double own_samples) const;

    // Which part of the pixels is looked at; with how many samples each; and with how many to know how much they vary (0 where nothing
    // is asked for that this would help to plan).
    struct Effort {
        double part = 0;
        uint32_t samples = 0, probe = 0;
    };
    // light: samples that a frame with a time budget has time for, those included that a pixel costs before its first one.
    static Effort effort(const Settings& settings, double covered_pixels, double light);
    // Samples that an audit draws for each of a pixel's own.
    static constexpr double gain = 4;
    // Of an audit by a cut, every so many-th pixel is rechecked by a sampler without bias (src/frame/recheck), of few all; and besides this
    // part of them, where pilot pass and audit differ most. So many samples err less than a pilot pass.
    static constexpr size_t recheck_stride = 4, fewest_rechecked = 64;
    static constexpr double doubted_part = 0.05;
    // Of the frame's error, what it may err by to one side unseen: a half adds an eighth. Directions drawn from the map for a frame's
    // samples without bias leave a quarter of a percent themselves (docs/decisions/0006).
    static constexpr double harmless_part = 0.5, least_difference = 0.003;
    static uint32_t unbiased_samples(double probe);
    // Whether what a cut saw of a pixel is refuted by what was seen there without bias. A cut does not invent light: that few samples
    // of another kind have not met a lamp proves nothing.
    static bool refutes(const Pixel& unbiased, const Pixel& cut);
};

// What audited pixels err by alike, to the same side, as a cut of few parts does on an even surface. Their audit errs to that side too,
// only less, and shows the less of it.
class SharedError {
public:
    // What a pixel shows beside its audit, relatively; own_part: its samples, in parts of the audit's.
    void add(double deviation, double own_part);
    // Mean square that does not show.
    double hidden() const;

private:
    double count_ = 0, sum_ = 0, squares_ = 0, shown_ = 0;
};

// What audited pixels err by over what their spreads tell.
class AuditSum {
public:
    // part: of all pixels, that are audited. What is known of all of them is not in doubt.
    explicit AuditSum(double part = 0) : part_(part) {}

    // Squared and relative to what the pixel shows: what it errs by, and what its spread tells.
    void add(double square, double told);
    // Of a pixel that now knows better than its audit. Without it, those that disagreed most, which are audited best, would be left
    // to speak for all.
    void add_believed(double told) { add(std::min(told, largest_square), told); }

    // Of a mean squared error what is beyond `noise`, which the spreads tell of, weighed by its doubt; negative where they tell of more
    // than there is.
    struct Bias {
        double mean = 0, deviation = 0;
    };
    Bias beyond(double noise) const;
    // The mean squared error of the pixels themselves.
    double error() const;

    // A pixel is believed up to an error of as much as it shows: squares of few samples' noise go far beyond, and one of them
    // would drown the others.
    static constexpr double largest_square = 1;

    // Nor may an audit say that there is less than this part of what the spreads tell.
    static constexpr double least_true = 0.1;

private:
    double part_;
    std::vector<double> squares_, told_;
};

}  // namespace lightband
