#include "sampling/pilots.h"

#include <algorithm>
#include <cmath>

#include "sampling/sequence.h"

namespace lightband {

std::vector<Pilot> pilots(const Brdf& brdf, const LobeSampler& sampler, const LobeBandwidth& bandwidth,
                          uint32_t count) {
    // No pilot stands for more than the hemisphere.
    const double widest = std::log2(2 * pi);
    std::vector<Pilot> result(size_t(LobeTable::views) * count);
    for (int view = 0; view < LobeTable::views; ++view) {
        const double theta = (view + 0.5) / LobeTable::views * pi / 2;
        const Vec3 wo(std::sin(theta), 0, std::cos(theta));
        for (uint32_t i = 0; i < count; ++i) {
            const Vec2 u = centred_lattice_point(i, count);
            Pilot& pilot = result[size_t(view) * count + i];
            const LobeSample sample = sampler.sample(wo, glm::min(u, Vec2(1 - 0x1p-24)));
            pilot = {{float(sample.half.x), float(sample.half.y), float(sample.half.z)}, 0, 0, 0, float(widest), 0};
            if (sample.pdf <= 0) continue;
            const double f = luminance(evaluate(brdf, sample.wi, wo));
            pilot.pdf = float(sample.pdf);
            pilot.weight = float(f * sample.wi.z / sample.pdf);
            pilot.square = float(f * f / (2 * pi * sample.pdf));
            pilot.lobe_bandwidth = float(bandwidth.at(sample.wi, wo));
            pilot.footprint = float(std::min(-std::log2(count * sample.pdf), widest));
        }
    }
    return result;
}

}  // namespace lightband
