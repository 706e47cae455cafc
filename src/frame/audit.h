// What a biased sampler gets wrong, by its own frame: a few pixels, evenly spread, are also shaded without bias, twice, and the
// picture is held against both. The product of the two deviations is an unbiased estimate of the squared error; the definition of a
// frame's error (docs/conventions.md) uses two references in the same way.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/settings.h"

namespace lightband {

// Whether a pixel is among those drawn by chance, `part` of all; who is among few is among more. shaders/classify.glsl draws alike.
bool is_drawn(uint32_t x, uint32_t y, uint32_t seed, double part);

struct Audit {
    std::vector<uint32_t> at;   // y * width + x
    std::vector<float> mean;    // luminance, without bias
    std::vector<float> spread;  // half the difference of its two replicates

    // Which part of the pixels is looked at; with how many unbiased samples each (0 where the sampler has no bias); and with how
    // many of its own, to know how much they vary (0 where nothing is asked for that this would help to plan).
    struct Effort {
        double part = 0;
        uint32_t samples = 0, probe = 0;
    };
    static constexpr uint32_t probe_samples = 64;
    // samples_per_millisecond: of the device, for frames that must not take long.
    static Effort effort(const Settings& settings, double covered_pixels, double samples_per_millisecond);
};

// Of a picture's two replicates and an audit's two, either of one against either of the other: the mean over pixels of the products
// of their deviations has the noise of neither.
class BiasSum {
public:
    // The picture's deviation from the audit, and half the differences of the replicates of both; relative to what the pixel shows.
    void add(double deviation, double own_spread, double other_spread);

    // What an audit saw of a mean squared error beyond `noise`, which the spreads tell of, each weighed by its doubt; negative where
    // they tell of more than there is.
    struct Bias {
        double mean = 0, deviation = 0;
    };
    Bias beyond(double noise) const;

    // A pixel is believed up to an error of as much as it shows: products of few samples' noise go far beyond in both directions,
    // and one of them would drown the others.
    static constexpr double largest_square = 1;
    // Nor may an audit say that there is less than this part of what the spreads tell.
    static constexpr double least_true = 0.3;

private:
    double sum_ = 0, squares_ = 0, count_ = 0;
};

// A pixel that was also drawn as the frame will be. Relative to what it shows.
struct Probed {
    double spread;
    double deviation, audit_spread;  // from the audit; 0 where there is none
};

// The mean squared error of probed pixels; 0 where there are none.
double probed_error(const std::vector<Probed>& pixels, bool audited);

}  // namespace lightband
