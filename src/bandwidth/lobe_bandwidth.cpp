#include "bandwidth/lobe_bandwidth.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <thread>

#include "bandwidth/octahedral.h"

namespace lightband {
namespace {

constexpr int reduction = LobeBandwidth::analysis_side / LobeBandwidth::side;

// A peak that is narrower than two analysis texels may fall between them unseen. Tables cannot hold one (their own cells
// are resolved by the peak search below); of the analytic lobes only GGX can.
bool narrower_than_grid(const Brdf& brdf) {
    const auto* ggx = std::get_if<Ggx>(&brdf);
    const double texel = 0.5 * pi / (LobeBandwidth::analysis_side / 2.0);
    return ggx != nullptr && 2 * ggx->alpha < 2 * texel;
}

SquareImage lobe_image(const Brdf& brdf, const Vec3& wo) {
    constexpr int side = LobeBandwidth::analysis_side;
    SquareImage image(side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const Vec3 wi = HemiOctahedral::to_direction(Vec2((x + 0.5) / side, (y + 0.5) / side));
            image.at(x, y) = luminance(evaluate(brdf, wi, wo)) * wi.z;
        }
    return image;
}

// The wavelets of a level stand on a lattice, and a narrow peak may fall where one coarse coefficient takes nearly all of it.
// A second transform of the picture moved by a third of it (a third of the spacing, on every level's lattice) sees the peak
// elsewhere; the larger result holds. f cos(theta_i) vanishes along the whole edge, the horizon, so the picture is periodic.
std::vector<BandLimit> limits_of(const SquareImage& image, BandRule rule) {
    const int side = image.size, third = side / 3;
    std::vector<BandLimit> limits = local_band_limits(analyse(image, periodic_border), side, periodic_border, rule);
    SquareImage moved(side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) moved.at(x, y) = image.at((x + third) % side, (y + third) % side);
    const std::vector<BandLimit> others = local_band_limits(analyse(moved, periodic_border), side, periodic_border, rule);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const BandLimit& other = others[size_t(y * side + x)];
            BandLimit& limit = limits[size_t((y + third) % side * side + (x + third) % side)];
            limit = {std::max(limit.frequency, other.frequency), limit.open || other.open};
        }
    return limits;
}

void analyse_view(const Brdf& brdf, BandRule rule, int view, float* out) {
    constexpr int side = LobeBandwidth::analysis_side;
    const double cosine = (view + 0.5) / LobeBandwidth::views;
    const Vec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
    const std::vector<BandLimit> limits = limits_of(lobe_image(brdf, wo), rule);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const BandLimit limit = limits[size_t(y * side + x)];
            const Vec3 wi = HemiOctahedral::to_direction(Vec2((x + 0.5) / side, (y + 0.5) / side));
            const double value = limit.open ? unbounded_bandwidth : limit.frequency * side * stretch(HemiOctahedral{}, wi);
            float& cell = out[(y / reduction) * LobeBandwidth::side + x / reduction];
            cell = std::max(cell, float(value));
        }
}

}  // namespace

double LobeBandwidth::at(const Vec3& wi, const Vec3& wo) const {
    const Vec2 square = HemiOctahedral::to_square(wi);
    const int view = std::clamp(int(wo.z * views), 0, views - 1);
    const int x = std::clamp(int(square.x * side), 0, side - 1), y = std::clamp(int(square.y * side), 0, side - 1);
    return values[size_t((view * side + y) * side + x)];
}

LobeBandwidth lobe_bandwidth(const Brdf& brdf, BandRule rule) {
    LobeBandwidth result;
    constexpr size_t lobe = size_t(LobeBandwidth::side) * LobeBandwidth::side;
    result.values.assign(LobeBandwidth::views * lobe, narrower_than_grid(brdf) ? float(unbounded_bandwidth) : 0.0f);
    if (narrower_than_grid(brdf)) return result;
    const auto part = [&](int first, int step) {
        for (int view = first; view < LobeBandwidth::views; view += step)
            analyse_view(brdf, rule, view, &result.values[size_t(view) * lobe]);
    };
    const int threads = std::max(1, std::min(int(std::thread::hardware_concurrency()), LobeBandwidth::views));
    // What one throws, get() throws here; a thread that cannot be had is done without.
    std::vector<std::future<void>> others;
    for (int i = 1; i < threads; ++i) others.push_back(std::async(std::launch::async | std::launch::deferred, part, i, threads));
    part(0, threads);
    for (std::future<void>& other : others) other.get();
    return result;
}

}  // namespace lightband
