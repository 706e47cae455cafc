#include "frame/combine.h"

#include <algorithm>
#include <cmath>

#include "picture/constants.h"
#include "picture/decision.h"

namespace lightband {
namespace {

// Sums over comparable pixels of squares relative to their scales. With own value y, spread s, and interpolated value
// z, spread t:
struct Sums {
    double count = 0;
    double own = 0;        // s (s - t): variance of y less its covariance with z
    double noise = 0;      // (t - s)^2: variance of z - y
    double deviation = 0;  // (z - y)^2: the same and the squared error of interpolation

    void add(const Sums& other, double times) {
        count += times * other.count;
        own += times * other.own;
        noise += times * other.noise;
        deviation += times * other.deviation;
    }
};

// A pixel that is shaded and was compared with what interpolation would give.
bool is_comparable(const RoundPixels& pixels, size_t at) {
    return pixels.material[at] != 0 && is_shaded(pixels.decision[at]) && pixels.spread[4 * at + 3] != 0;
}

// A squared error counts up to 1, as those of control and of validation pixels do.
double clamped_square(double square) {
    return std::clamp(square, -constants::largest_square, constants::largest_square);
}

Sums sums_of(const RoundPixels& pixels, size_t at, double mean) {
    const double scale = scale_of(pixels, at, mean);
    if (!(scale > 0)) return {};
    const float* spread = &pixels.spread[4 * at];
    const double own = spread[0] / scale, deviation = spread[1] / scale, difference = spread[2] / scale;
    return {1, clamped_square(-own * difference), clamped_square(difference * difference),
            clamped_square(deviation * deviation)};
}

// Mean squared error of interpolation of pixels on one lattice, as seen of them and of those on the next coarser one.
// The mean squared deviations are D = N + I here and D' = N' + I' there, N being noise and I the error of
// interpolation. Spreads tell of N but may miss a part of it; then D - N is too much. Across twice the distance the
// squared error of interpolation is at least twice as large (beside an edge; 16 times where the picture is smooth),
// while noise falls as the spreads do: so D' - (N' / N) D >= (2 - N' / N) I as well.
double interpolation_of(const Sums& here, const Sums& coarser, double calibration) {
    const double most = std::max(here.deviation - calibration * here.noise, 0.0) / here.count;
    if (!(coarser.count > 0) || !(here.noise > 0)) return most;
    const double fall = std::min(coarser.noise / coarser.count / (here.noise / here.count), 1.0);
    const double grown = std::max(coarser.deviation / coarser.count - fall * here.deviation / here.count, 0.0);
    return std::min(most, grown / (constants::least_interpolation_growth - fall));
}

// What a mean squared deviation is made of.
struct Split {
    double interpolation = 0, noise = 0;
};
Split split(const Sums& here, const Sums& coarser, double calibration) {
    const double interpolation = interpolation_of(here, coarser, calibration);
    return {interpolation,
            std::max(here.deviation / here.count - interpolation, calibration * here.noise / here.count)};
}

// (1 - p) y + p z errs least at p = (var y - cov(y, z)) / (var(z - y) + squared error of interpolation).
double best_part(const Sums& here, const Split& squares, uint32_t frames) {
    const double noise = squares.noise / frames, all = squares.interpolation + noise;
    return all > 0 ? std::clamp(here.own / here.noise * noise / all, 0.0, 1.0) : 0;
}

// Sums in each tile, and over all of them, of pixels of one kind: of the finest lattice; of that, where something
// speaks against interpolation (doubtful: shaders/lattice.glsl); of the next coarser lattice; and all others.
class Pools {
public:
    enum Kind { finest, finest_doubtful, coarser, other, kinds };

    Pools(const RoundPixels& pixels, const Tiles& tiles, uint32_t width, uint32_t coarsest, double mean)
        : pixels_(pixels),
          tiles_(tiles),
          width_(width),
          coarsest_(coarsest),
          mean_(mean),
          of_all_(kinds),
          of_tile_(tiles.count * kinds) {
        for (size_t i = 0; i < pixels.material.size(); ++i) {
            if (!is_comparable(pixels, i)) continue;
            const Sums own = sums_of(pixels, i, mean);
            of_all_[kind_of(i)].add(own, 1);
            of_tile_[tiles.of[i] * kinds + kind_of(i)].add(own, 1);
        }
    }

    Kind kind_of(size_t at) const {
        const bool doubtful = pixels_.spread[4 * at + 3] < 0;
        switch (lattice_level(uint32_t(at % width_), uint32_t(at / width_), coarsest_)) {
            case 0:
                return doubtful ? finest_doubtful : finest;
            case 1:
                return doubtful ? other : coarser;
            default:
                return other;
        }
    }

    Sums of(size_t at) const { return sums_of(pixels_, at, mean_); }

    // Of the pixels of its kind around that one, without it.
    Sums around(size_t at) const {
        const Kind kind = kind_of(at);
        Sums result = of_tile_[tiles_.of[at] * kinds + kind];
        const double prior = constants::prior_combined_pixels / of_all_[kind].count;
        result.add(of_all_[kind], prior);
        result.add(sums_of(pixels_, at, mean_), -1 - prior);
        return result;
    }

    // Those of the coarser lattice around one of the finest. They are few in a tile: it is taken to err by as much more
    // or less than the frame as it does on the finest lattice.
    Sums coarser_around(size_t at, const Sums& around) const {
        const Sums &of_coarser = of_all_[coarser], &of_finest = of_all_[finest];
        if (!(of_coarser.count > 0) || !(of_finest.deviation > 0)) return {};
        Sums prior = of_coarser;
        const double scale = around.deviation / around.count / (of_finest.deviation / of_finest.count);
        prior.noise *= scale;
        prior.deviation *= scale;
        Sums result = of_tile_[tiles_.of[at] * kinds + coarser];
        result.add(prior, constants::prior_combined_pixels / prior.count);
        return result;
    }

private:
    const RoundPixels& pixels_;
    const Tiles& tiles_;
    const uint32_t width_, coarsest_;
    const double mean_;
    std::vector<Sums> of_all_, of_tile_;
};

}  // namespace

// A pixel's own values are not among those that choose its part: else what it shows would lean to whatever its noise
// made look good, and its spread would no longer tell the error of that.
std::vector<uint8_t> neighbour_parts(const RoundPixels& pixels, const ControlSet& control, const Tiles& tiles,
                                     uint32_t width, uint32_t coarsest, uint32_t frames) {
    if (tiles.count == 0) return {};
    const double mean = mean_luminance(pixels), calibration = spread_calibration(pixels, control, mean);
    const Pools pools(pixels, tiles, width, coarsest, mean);
    std::vector<uint8_t> parts(pixels.material.size());
    for (size_t i = 0; i < parts.size(); ++i) {
        if (!is_comparable(pixels, i)) continue;
        const Pools::Kind kind = pools.kind_of(i);
        if (kind != Pools::finest && kind != Pools::finest_doubtful) continue;
        const Sums around = pools.around(i);
        if (!(around.count > 0) || !(around.noise > 0)) continue;
        const Split squares =
            split(around, kind == Pools::finest ? pools.coarser_around(i, around) : Sums(), calibration);
        const double most = kind == Pools::finest ? constants::edge_deviations : constants::doubtful_edge_deviations;
        if (pools.of(i).deviation > most * most * squares.noise) continue;
        parts[i] = uint8_t(std::lround(255 * best_part(around, squares, frames)));
    }
    return parts;
}

}  // namespace lightband
