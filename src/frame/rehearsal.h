// How far interpolation over directions errs by what a frame's audited pixels show, over what it errs by what their pilots expect:
// interpolated from each other, the same pixels say both.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"

namespace lightband {

struct RehearsedPixel {
    Vec3 normal, direction;  // of a mirror
    uint32_t slot;           // only pixels of one are interpolated from each other
    double shown, expected;  // luminance
};

// Ratio of the mean squared relative errors, the root of which is what pilots are to be multiplied by; 1 where too few pixels tell.
// dark: part of the mean luminance that is added to what an error is relative to.
double rehearse(const std::vector<RehearsedPixel>& pixels, double dark);

}  // namespace lightband
