#include "frame/recheck.h"

#include <algorithm>
#include <cmath>

#include "frame/control_set.h"
#include "picture/budget.h"

namespace lightband {
namespace {

// Standard errors beyond which a difference is no chance. Over the 60 scenes of docs/trade.md at 5, 2 and 1 %, differences were -3.6 to
// 2.4 of them (docs/decisions/0015): of some dozen pixels they are skewed, since unbiased samples meet small bright sources rarely.
constexpr double sure_errors = 4;
// Standard errors by which a cut must err more than unbiased samples would, as many, to be given up for that alone.
constexpr double worse_errors = 3;
// Fewer pixels than this do not know their own standard error; they are taken to be no better than independent samples.
constexpr double few_pixels = 16;

struct Mean {
    double count = 0, sum = 0, squares = 0;
    void add(double value) {
        ++count;
        sum += value;
        squares += value * value;
    }
    double mean() const { return sum / count; }
    double error() const { return std::sqrt(std::max(squares / count - mean() * mean(), 0.0) / std::max(count - 1, 1.0)); }
    double error_at_least(double of_one) const { return count < few_pixels ? std::max(error(), of_one / std::sqrt(count)) : error(); }
};

double clamped(double difference) { return std::clamp(difference, -1.0, 1.0); }

}  // namespace

Recheck recheck(const std::vector<RecheckedPixel>& pixels, const RecheckSamples& samples) {
    if (pixels.empty()) return {};
    // A cut's error falls as n^(-g / 2): so much of the difference between its two numbers of samples is left at the larger one.
    const double part = std::pow(samples.few / samples.many, 0.5 * stratified_gain), left = part / (1 - part);
    Mean differences, cut, unbiased, independent;
    for (const RecheckedPixel& pixel : pixels) {
        const double converged = pixel.many + left * clamped(pixel.many - pixel.few);
        differences.add(clamped(converged - pixel.unbiased));
        const double spread = double(pixels.size()) < few_pixels ? std::max(std::abs(pixel.spread), pixel.deviation) : pixel.spread;
        const double square = std::min(spread * spread, BiasEstimate::largest_square);
        cut.add(std::pow(clamped(pixel.many - pixel.unbiased), 2) - square);
        unbiased.add(square);
        independent.add(pixel.deviation * pixel.deviation);
    }
    // As of independent samples: stratified ones gain more by their number, so that fewer err by more than this.
    const double of_one = std::sqrt(independent.mean());
    return {differences.mean(), differences.error_at_least(of_one), cut.mean(), cut.error_at_least(independent.mean()),
            unbiased.mean() * samples.unbiased / samples.many};
}

bool Recheck::contradicts(double harmless) const {
    return std::abs(difference) > std::max(sure_errors * difference_error, harmless) || cut - worse_errors * cut_error > unbiased;
}

}  // namespace lightband
