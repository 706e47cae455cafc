#include "frame/recheck.h"

#include <algorithm>
#include <cmath>

#include "picture/constants.h"

namespace lightband {
namespace {

struct Mean {
    double count = 0, sum = 0, squares = 0;
    void add(double value) {
        ++count;
        sum += value;
        squares += value * value;
    }
    double mean() const { return sum / count; }
    double error() const {
        return std::sqrt(std::max(squares / count - mean() * mean(), 0.0) / std::max(count - 1, 1.0));
    }
    double error_at_least(double of_one) const {
        return count < constants::few_rechecked ? std::max(error(), of_one / std::sqrt(count)) : error();
    }
};

double clamped(double difference) {
    return std::clamp(difference, -1.0, 1.0);
}

}  // namespace

Recheck recheck(const std::vector<RecheckedPixel>& pixels, const RecheckSamples& samples) {
    if (pixels.empty()) return {};
    // A cut's error falls as n^(-g / 2): so much of the difference between its two numbers of samples is left at the
    // larger one.
    const double part = std::pow(samples.few / samples.many, 0.5 * constants::stratified_gain),
                 left = part / (1 - part);
    Mean differences, cut, unbiased, independent;
    for (const RecheckedPixel& pixel : pixels) {
        const double converged = pixel.many + left * clamped(pixel.many - pixel.few);
        differences.add(clamped(converged - pixel.unbiased));
        const double spread = double(pixels.size()) < constants::few_rechecked
                                  ? std::max(std::abs(pixel.spread), pixel.deviation)
                                  : pixel.spread;
        const double square = std::min(spread * spread, constants::largest_square);
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
    return std::abs(difference) > std::max(constants::sure_difference_errors * difference_error, harmless) ||
           cut - constants::worse_errors * cut_error > unbiased;
}

}  // namespace lightband
