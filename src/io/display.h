// From radiance to the eight bits of a PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lightband::io {

enum class ToneCurve { none, filmic };

struct Display {
    double exposure = 0;  // radiance is multiplied by 2^exposure first
    ToneCurve tone_curve = ToneCurve::none;
    bool opaque = false;  // alpha is 1, not the coverage
};

// A curve of film that rises from 0 towards 1 and reaches it at no finite radiance: the curve of Hable, "Uncharted 2: HDR
// Lighting" (GDC 2010), with its white at infinity, and scaled so that mid-grey, 0.18, stays where it is.
double filmic(double radiance);

// sRGB (IEC 61966-2-1) of rgba, radiance and coverage; straight alpha: where the coverage is between 0 and 1, the colour,
// which holds the covered part's light alone, is divided by it.
std::vector<uint8_t> to_srgb(const float* rgba, size_t pixels, const Display& display);

}  // namespace lightband::io
