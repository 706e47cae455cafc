// Whether a light cut converges as its validation assumes. Four times the samples of a biased sampler may miss the same light; so some
// of the validation pixels are also shaded by a sampler without bias, and the two are compared.
#pragma once

#include <cstdint>
#include <vector>

namespace lightband {

// What one pixel shows, relative to its radiance.
struct RecheckedPixel {
    double few, many;  // by the light cut, with the samples of the pilot pass and of the validation
    double unbiased;   // by a sampler without bias
    double spread;     // half the difference of that one's two replicates
    double deviation;  // its standard error, as if its samples were independent
};

struct RecheckSamples {
    double few, many, unbiased;  // of each pixel
};

struct Recheck {
    // Mean of what the cut converges to, by its two numbers of samples, less what was seen without bias; and the standard error of it.
    double difference = 0, difference_error = 0;
    // Mean squared errors with the samples of the validation: of the cut, with its standard error; of the sampler without bias.
    double cut = 0, cut_error = 0, unbiased = 0;

    // harmless: a difference that the frame's error would not show.
    bool contradicts(double harmless) const;
};

// pixels: chosen by chance, not by how much they differ.
Recheck recheck(const std::vector<RecheckedPixel>& pixels, const RecheckSamples& samples);

}  // namespace lightband
