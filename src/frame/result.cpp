#include "frame/result.h"

#include <algorithm>
#include <cmath>

#include "gl/read_back.h"
#include "picture/decision.h"

namespace lightband {

RoundPixels FrameResult::read_round() const {
    const size_t count = pixels();
    RoundPixels round;
    round.radiance = accumulated.empty() ? read_floats(shading.radiance, GL_RGBA, count, 4) : accumulated;
    round.spread = read_floats(shading.spread, GL_RGBA, count, 4);
    if (prediction) round.expected = read_floats(prediction->prediction, GL_GREEN, count, 1);
    round.sample_count = read_words(shading.sample_count, count);
    round.decision = read_bytes(shading.decision, count);
    round.material = material;
    round.neighbour_part = neighbour_part;
    round.combined = !neighbour_part.empty();
    return round;
}

// A pixel of a lattice stands for those nearer to it than to others of the lattice, or of its own spacing.
std::vector<float> FrameResult::areas() const {
    if (!prediction || !prediction->pyramids) return {};
    std::vector<float> areas(pixels(), 1);
    const std::vector<uint8_t> levels =
        read_bytes(prediction->pyramids->levels, size_t(width) * prediction->pyramids->height);
    for (size_t i = 0; i < areas.size(); ++i) {
        const uint32_t x = uint32_t(i % width), y = uint32_t(i / width);
        areas[i] =
            std::ldexp(1.0f, 2 * int(std::min(lattice_level(x, y, settings.coarsest_level()), uint32_t(levels[i]))));
    }
    return areas;
}

}  // namespace lightband
