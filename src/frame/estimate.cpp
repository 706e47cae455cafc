#include "frame/estimate.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "frame/decision.h"

namespace lightband {
namespace {

double luminance_at(const RoundPixels& pixels, size_t at) {
    const float* rgb = &pixels.radiance[4 * at];
    return luminance(Vec3(rgb[0], rgb[1], rgb[2]));
}

double mean_luminance(const RoundPixels& pixels) {
    double sum = 0, covered = 0;
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        if (pixels.material[i] == 0) continue;
        sum += luminance_at(pixels, i);
        ++covered;
    }
    return covered > 0 ? sum / covered : 0;
}

// The spread of a single pair of replicates has one degree of freedom; as many pixels as this say "independent samples" first, so
// that a tiny frame is not believed to be free of noise by luck.
constexpr double prior_pixels = 8;

// Squared errors of the witnesses of one slot.
struct WitnessSums {
    double sum = 0, squares = 0;
};

// A pixel shows between these parts of what the prediction expects: a sample that is far too bright would else raise the mean that
// its own error is measured by, and hide in it; a few that miss the light would make any error look large. Sixteen pilots know the
// mean to better than that.
constexpr double least_expected = 0.5, most_expected = 1.5;

double scale_at(const RoundPixels& pixels, size_t at, double mean_luminance) {
    return scale_of(luminance_at(pixels, at), pixels.expected.empty() ? 0 : pixels.expected[at], mean_luminance);
}

void add_bias(const RoundPixels& pixels, const Audit& audit, uint32_t frames, ErrorEstimate* estimate) {
    BiasSum sum;
    for (size_t k = 0; k < audit.at.size(); ++k) {
        const size_t i = audit.at[k];
        const double scale = scale_at(pixels, i, estimate->mean_luminance);
        if (!(scale > 0)) continue;
        sum.add((luminance_at(pixels, i) - audit.mean[k]) / scale, pixels.spread[2 * i] / std::sqrt(frames) / scale,
                audit.spread[k] / scale);
    }
    const BiasSum::Bias bias = sum.beyond(estimate->noise);
    estimate->bias = bias.mean;
    estimate->bias_deviation = bias.deviation;
}

}  // namespace

double scale_of(double shown, double expected, double mean_luminance) {
    if (expected > 0) shown = std::clamp(shown, least_expected * expected, most_expected * expected);
    return shown + dark_part * mean_luminance;
}

double ErrorEstimate::error() const { return std::sqrt(noise + interpolation + bias); }

double variance_of_mean(const RoundPixels& pixels, size_t at) {
    const double square = pixels.radiance[4 * at + 3], mean = luminance_at(pixels, at);
    const uint32_t n = pixels.sample_count[at];
    if (n == 0) return square;
    return n > 1 ? std::max(square - mean * mean, 0.0) / (n - 1) : mean * mean;
}

ErrorEstimate estimate_error(const RoundPixels& pixels, const std::vector<uint32_t>& slot_of, size_t slots,
                             const Audit& audit) {
    ErrorEstimate result;
    result.slots.resize(slots);
    result.mean_luminance = mean_luminance(pixels);
    std::vector<WitnessSums> witnesses(slots);
    const size_t tiles = tiles_along(pixels.width), rows = pixels.material.size() / pixels.width;
    result.tiles.resize(tiles * tiles_along(uint32_t(rows)));
    double spreads = 0, variances = 0, covered = 0;
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        if (pixels.material[i] == 0) continue;
        const uint32_t slot = slot_of[pixels.material[i] - 1u];
        ErrorEstimate::Slot& own = result.slots[slot];
        ++own.covered;
        ++covered;
        const double scale = scale_at(pixels, i, result.mean_luminance);
        if (!(scale > 0)) continue;  // a frame without light has no error
        const double spread = pixels.spread[2 * i] / scale;
        spreads += spread * spread;
        variances += variance_of_mean(pixels, i) / (scale * scale);
        ErrorEstimate::Tile& tile = result.tiles[i / pixels.width / tile_side * tiles + i % pixels.width / tile_side];
        if (is_interpolated(pixels.decision[i])) {
            ++own.interpolated;
            ++tile.interpolated;
        }
        if (!is_witness(pixels.decision[i])) continue;
        ++own.witnesses;
        const double square =
            std::clamp(pixels.spread[2 * i + 1] / (scale * scale), -BiasSum::largest_square, BiasSum::largest_square);
        witnesses[slot].sum += square;
        witnesses[slot].squares += square * square;
        ++tile.witnesses;
        tile.sum += square;
        tile.squares += square * square;
    }
    if (covered == 0) return result;
    if (variances > 0) {
        const double prior = prior_pixels * variances / covered;
        result.stratification = (spreads + prior) / (variances + prior);
    }
    result.noise = result.stratification * variances / covered;
    for (size_t slot = 0; slot < slots; ++slot) {
        ErrorEstimate::Slot& own = result.slots[slot];
        if (own.witnesses == 0) continue;
        const double count = double(own.witnesses), mean = witnesses[slot].sum / count;
        const double part = double(own.interpolated) / double(own.covered);
        own.interpolation = std::max(mean, 0.0) * part;
        own.interpolation_deviation = std::sqrt(std::max(witnesses[slot].squares / count - mean * mean, 0.0) / count) * part;
        result.interpolation += own.interpolation * double(own.covered) / covered;
        result.interpolation_deviation =
            std::hypot(result.interpolation_deviation, own.interpolation_deviation * double(own.covered) / covered);
    }
    add_bias(pixels, audit, 1, &result);
    return result;
}

void average_error(const RoundPixels& pixels, const Audit& audit, uint32_t frames, ErrorEstimate* estimate) {
    add_bias(pixels, audit, frames, estimate);
    estimate->noise /= frames;
    estimate->stratification /= frames;
    estimate->bias = std::max(estimate->bias, (BiasSum::least_true - 1) * estimate->noise);
}

std::vector<float> pixel_errors(const RoundPixels& pixels, const ErrorEstimate& estimate, const std::vector<uint32_t>& slot_of,
                                const std::vector<float>& shape) {
    std::vector<double> shape_sums(estimate.slots.size());
    for (size_t i = 0; i < pixels.material.size(); ++i)
        if (is_interpolated(pixels.decision[i])) shape_sums[slot_of[pixels.material[i] - 1u]] += shape[i];
    // Where an audit found less than the spreads tell, every pixel's noise is less in that proportion.
    const double known_better =
        estimate.bias < 0 ? estimate.stratification * estimate.shading() / estimate.noise : estimate.stratification;
    std::vector<float> errors(pixels.material.size());
    for (size_t i = 0; i < errors.size(); ++i) {
        if (pixels.material[i] == 0) continue;
        const double scale = scale_at(pixels, i, estimate.mean_luminance);
        if (!(scale > 0)) continue;
        double square = known_better * variance_of_mean(pixels, i) / (scale * scale) + std::max(estimate.bias, 0.0);
        if (is_interpolated(pixels.decision[i])) {
            const uint32_t slot = slot_of[pixels.material[i] - 1u];
            const ErrorEstimate::Slot& own = estimate.slots[slot];
            const double all = own.interpolation * double(own.covered);  // summed over the slot's pixels
            square += shape_sums[slot] > 0 ? all * shape[i] / shape_sums[slot] : all / double(own.interpolated);
        }
        errors[i] = float(std::sqrt(square));
    }
    return errors;
}

}  // namespace lightband
