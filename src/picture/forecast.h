// What prediction amounts to, before a pixel is shaded.
#pragma once

#include <cstdint>

namespace lightband {

// Over a frame's covered pixels.
struct Forecast {
    double covered = 0;             // pixels
    double mean_radiance = 0;       // luminance
    double relative_deviation = 0;  // mean of one light sample's standard deviation over the pixel's radiance
    double pilot_error = 0;        // mean squared error that pilot samples leave; 0: there were none
    uint32_t pilot_samples = 0;     // of each
};

}  // namespace lightband
