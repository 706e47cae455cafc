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
    // The sum of what probed pixels were seen to vary by, squared and relative, less what few of them stand out by.
    static double bulk(std::vector<double> squares);
    // samples_per_millisecond: of the device, for frames that must not take long.
    static Effort effort(const Settings& settings, double covered_pixels, double samples_per_millisecond);
};

}  // namespace lightband
