#include "frame/estimate.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "picture/constants.h"
#include "picture/decision.h"

namespace lightband {
namespace {

double luminance_at(const RoundPixels& pixels, size_t at) {
    const float* rgb = &pixels.radiance[4 * at];
    return luminance(Vec3(rgb[0], rgb[1], rgb[2]));
}

// What a shaded pixel displays is (1 - p) times its own value and p times the interpolated one, p being neighbour_part:
// so are its spread and, with squared weights, its variance.
double displayed_luminance(const RoundPixels& pixels, size_t at) {
    return luminance_at(pixels, at) +
           (pixels.combined ? 0 : neighbour_part(pixels, at) * double(pixels.spread[4 * at + 1]));
}
double displayed_spread(const RoundPixels& pixels, size_t at) {
    return pixels.spread[4 * at] + neighbour_part(pixels, at) * double(pixels.spread[4 * at + 2]);
}
double displayed_variance(const RoundPixels& pixels, size_t at) {
    const double part = neighbour_part(pixels, at), own = variance_of_mean(pixels, at);
    return part > 0 ? (1 - part) * (1 - part) * own + part * part * std::abs(double(pixels.spread[4 * at + 3])) : own;
}

// Squared errors of interpolation of the validation pixels of one slot.
struct ValidationSums {
    double sum = 0, squares = 0;
};

// A pixel of the control set compared with its control samples; squared and relative.
struct Comparison {
    size_t at;
    double scale;
    bool outgrown;     // the pixel has too many samples itself: its spread is taken for its error
    double deviation;  // of the pixel's own samples: not squared
    double own_part;   // its samples in one frame over the control samples, as frames share their light cuts; 0: these
                       // have no bias
    double sampled;    // error of the pixel's own samples
    double displayed;  // of what it displays: the same, or a mean of it and the interpolated value
    double interpolated;  // of the interpolated value, at a validation pixel

    void add_to(BiasEstimate* sum, double square, double estimated) const {
        outgrown ? sum->add_clamped(estimated) : sum->add(square, estimated);
    }
};

// frames: over which the picture is a mean.
std::vector<Comparison> compare(const RoundPixels& pixels, const ControlSet& control, uint32_t frames, double mean) {
    std::vector<Comparison> result;
    for (const ControlSet::Pixel& seen : control.pixels) {
        const size_t i = seen.at;
        const double scale = scale_of(pixels, i, mean), samples = double(pixels.sample_count[i]) * frames;
        const double known = scale_of(seen, mean);
        if (!(scale > 0) || !(known > 0) || samples == 0) continue;
        const double own = luminance_at(pixels, i), sampled = control.square(seen, own, known, samples);
        const bool validation = is_validation(pixels.decision[i]);
        const double part = neighbour_part(pixels, i),
                     left = pixels.combined ? 1 - part : 1;  // of the deviation of the interpolated value, beyond `own`
        result.push_back(
            {i, scale, !control.is_better_than(seen, samples), (own - double(seen.mean)) / known,
             seen.biased ? double(pixels.sample_count[i]) / control.samples : 0, sampled,
             part > 0 ? control.squared_error_of_other(seen, displayed_luminance(pixels, i), known, sampled, samples)
                      : sampled,
             validation
                 ? control.squared_error_of_other(seen, own + left * pixels.spread[4 * i + 1], known, sampled, samples)
                 : 0});
    }
    return result;
}

// The part of the covered pixels that is in the control set.
double part_of(const RoundPixels& pixels, const std::vector<Comparison>& compared) {
    const auto unseen = std::count(pixels.material.begin(), pixels.material.end(), uint8_t(0));
    return double(compared.size()) / std::max(double(pixels.material.size()) - double(unseen), 1.0);
}

double spread_calibration(const RoundPixels& pixels, const std::vector<Comparison>& compared) {
    BiasEstimate sum(part_of(pixels, compared));
    for (const Comparison& pixel : compared)
        pixel.add_to(&sum, pixel.sampled, std::pow(pixels.spread[4 * pixel.at] / pixel.scale, 2));
    return 1 + std::min(sum.beyond(1).mean, 0.0);
}

// The part of interpolation in what a pixel shows.
double interpolated_part(const RoundPixels& pixels, size_t at) {
    return is_interpolated(pixels.decision[at]) ? 1 : neighbour_part(pixels, at);
}

// Squared error of interpolation at a shaded pixel that was compared with it. The squared deviation contains the noise
// of both values: what the replicates estimate of that, times their calibration, is subtracted.
double interpolation_square(const RoundPixels& pixels, size_t at, double scale, double calibration) {
    const double deviation = pixels.spread[4 * at + 1] / scale, difference = pixels.spread[4 * at + 2] / scale;
    return std::clamp(deviation * deviation - calibration * difference * difference, -constants::largest_square,
                      constants::largest_square);
}

double common_mode_of(const std::vector<Comparison>& compared) {
    CommonModeError shared;
    for (const Comparison& pixel : compared)
        if (!pixel.outgrown && pixel.own_part > 0) shared.add(pixel.deviation, pixel.own_part);
    return shared.unseen();
}

// Control pixels that might be interpolated are validation pixels. Of the pixels that might be, this part is
// interpolated; the others display samples that this round or one before drew there.
double interpolated_part(const RoundPixels& pixels, const std::vector<Comparison>& compared,
                         const ErrorEstimate& estimate) {
    double covered = 0, interpolated = 0, validation = 0;
    for (const ErrorEstimate::Slot& slot : estimate.slots) {
        covered += double(slot.covered);
        interpolated += double(slot.interpolated);
    }
    for (const Comparison& pixel : compared) validation += is_validation(pixels.decision[pixel.at]);
    return validation > 0 ? std::min(interpolated / covered / (validation / double(compared.size())), 1.0) : 0;
}

// A common error of all pixels that a comparison with unbiased samples does not show: the squared standard error of the
// mean deviation from them, and their own common error.
double unseen_by_unbiased(const std::vector<Comparison>& compared) {
    double count = 0, sum = 0, squares = 0;
    for (const Comparison& pixel : compared) {
        if (pixel.own_part > 0) return 0;
        ++count;
        sum += pixel.deviation;
        squares += pixel.deviation * pixel.deviation;
    }
    if (count < 2) return 0;
    return std::max(squares - sum * sum / count, 0.0) / (count - 1) / count +
           constants::error_of_directions * constants::error_of_directions;
}

// Validation pixels of the control set stand for the pixels that might be interpolated, whether they are or not.
void add_bias(const RoundPixels& pixels, const std::vector<Comparison>& compared, double calibration,
              ErrorEstimate* estimate) {
    BiasEstimate sum(part_of(pixels, compared));
    const double part = interpolated_part(pixels, compared, *estimate), common = common_mode_of(compared);
    for (const Comparison& pixel : compared) {
        const double per_scale = estimate->stratification / (pixel.scale * pixel.scale);
        const double own_part = neighbour_part(pixels, pixel.at);
        double square = pixel.displayed, estimated = per_scale * displayed_variance(pixels, pixel.at);
        if (own_part > 0)
            estimated += own_part * own_part * interpolation_square(pixels, pixel.at, pixel.scale, calibration);
        if (is_validation(pixels.decision[pixel.at])) {
            square += part * (pixel.interpolated - square);
            estimated += part * (per_scale * pixels.spread[4 * pixel.at + 3] +
                                 interpolation_square(pixels, pixel.at, pixel.scale, calibration) - estimated);
        }
        pixel.add_to(&sum, square + (pixel.own_part > 0 ? common : 0), estimated);
    }
    const BiasEstimate::Bias bias = sum.beyond(estimate->noise + estimate->interpolation);
    estimate->bias =
        std::max(bias.mean, (constants::least_bias_ratio - 1) * estimate->noise) + unseen_by_unbiased(compared);
    estimate->bias_deviation = bias.deviation;
}

// Squares relative to each pixel's scale, summed over the covered pixels: of the replicates' spreads, of the means'
// variances, and of those variances.
struct NoiseSums {
    double covered = 0, spreads = 0, variances = 0, squares = 0;

    NoiseSums(const RoundPixels& pixels, double mean_luminance) {
        for (size_t i = 0; i < pixels.material.size(); ++i) {
            if (pixels.material[i] == 0) continue;
            ++covered;
            const double scale = scale_of(pixels, i, mean_luminance);
            if (!(scale > 0)) continue;  // a frame without light has no error
            const double spread = displayed_spread(pixels, i) / scale,
                         variance = displayed_variance(pixels, i) / (scale * scale);
            spreads += spread * spread;
            variances += variance;
            squares += variance * variance;
        }
    }

    void write(ErrorEstimate* estimate) const {
        estimate->noise = estimate->stratification * variances / covered;
        estimate->noise_deviation = estimate->stratification * std::sqrt(squares) / covered;
    }
};

}  // namespace

double scale_of(double displayed, double expected, double mean_luminance) {
    if (expected > 0)
        displayed = std::clamp(displayed, constants::least_expected * expected, constants::most_expected * expected);
    return displayed + dark_part * mean_luminance;
}

double scale_of(const RoundPixels& pixels, size_t at, double mean_luminance) {
    const double displayed = displayed_luminance(pixels, at),
                 sure = displayed - constants::sure_pixel_deviations * std::sqrt(displayed_variance(pixels, at));
    const double scale = scale_of(displayed, pixels.expected.empty() ? 0 : pixels.expected[at], mean_luminance);
    return std::max(scale, sure + dark_part * mean_luminance);
}

double scale_of(const ControlSet::Pixel& seen, double mean_luminance) {
    return seen.mean + dark_part * mean_luminance;
}

double ErrorEstimate::error() const {
    return std::sqrt(noise + interpolation + bias);
}

double neighbour_part(const RoundPixels& pixels, size_t at) {
    return pixels.neighbour_part.empty() ? 0 : pixels.neighbour_part[at] / 255.0;
}

double mean_luminance(const RoundPixels& pixels) {
    double sum = 0, covered = 0;
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        if (pixels.material[i] == 0) continue;
        sum += displayed_luminance(pixels, i);
        ++covered;
    }
    return covered > 0 ? sum / covered : 0;
}

double spread_calibration(const RoundPixels& pixels, const ControlSet& control, double mean_luminance) {
    return spread_calibration(pixels, compare(pixels, control, 1, mean_luminance));
}

double variance_of_mean(const RoundPixels& pixels, size_t at) {
    const double square = pixels.radiance[4 * at + 3], mean = luminance_at(pixels, at);
    const uint32_t n = pixels.sample_count[at];
    if (n == 0) return square;
    return n > 1 ? std::max(square - mean * mean, 0.0) / (n - 1) : mean * mean;
}

ErrorEstimate estimate_error(const RoundPixels& pixels, const std::vector<uint32_t>& slot_of, size_t slots,
                             const ControlSet& control, const Tiles& tiles) {
    ErrorEstimate result;
    result.slots.resize(slots);
    result.mean_luminance = mean_luminance(pixels);
    result.tiles.resize(tiles.count);
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        if (pixels.material[i] == 0) continue;
        ErrorEstimate::Slot& own = result.slots[slot_of[pixels.material[i] - 1u]];
        ++own.covered;
        if (!is_interpolated(pixels.decision[i])) continue;
        ++own.interpolated;
        ++result.tiles[tiles.of[i]].interpolated;
    }
    const NoiseSums sums(pixels, result.mean_luminance);
    if (sums.covered == 0) return result;
    if (sums.variances > 0) {
        const double prior = constants::prior_noise_pixels * sums.variances / sums.covered;
        result.stratification = (sums.spreads + prior) / (sums.variances + prior);
    }
    sums.write(&result);
    const std::vector<Comparison> compared = compare(pixels, control, 1, result.mean_luminance);
    const double calibration = spread_calibration(pixels, compared);
    std::vector<ValidationSums> validation(slots);
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        const double part = neighbour_part(pixels, i);
        if (pixels.material[i] == 0 || !(is_validation(pixels.decision[i]) || part > 0)) continue;
        const double scale = scale_of(pixels, i, result.mean_luminance);
        if (!(scale > 0)) continue;
        const uint32_t slot = slot_of[pixels.material[i] - 1u];
        result.slots[slot].combined += part * part * interpolation_square(pixels, i, scale, calibration);
        if (!is_validation(pixels.decision[i])) continue;
        ++result.slots[slot].validation;
        const double square = interpolation_square(pixels, i, scale, calibration);
        validation[slot].sum += square;
        validation[slot].squares += square * square;
        ErrorEstimate::Tile& tile = result.tiles[tiles.of[i]];
        ++tile.validation;
        tile.sum += square;
        tile.squares += square * square;
    }
    for (size_t slot = 0; slot < slots; ++slot) {
        ErrorEstimate::Slot& own = result.slots[slot];
        own.interpolation = std::max(own.combined, 0.0) / std::max(double(own.covered), 1.0);
        result.interpolation += own.interpolation * double(own.covered) / sums.covered;
        if (own.validation == 0) continue;
        const double count = double(own.validation), mean = validation[slot].sum / count;
        const double part = double(own.interpolated) / double(own.covered);
        const double interpolated = std::max(mean, 0.0) * part;
        own.interpolation += interpolated;
        own.interpolation_deviation =
            std::sqrt(std::max(validation[slot].squares / count - mean * mean, 0.0) / count) * part;
        result.interpolation += interpolated * double(own.covered) / sums.covered;
        result.interpolation_deviation = std::hypot(result.interpolation_deviation,
                                                    own.interpolation_deviation * double(own.covered) / sums.covered);
    }
    add_bias(pixels, compared, calibration, &result);
    return result;
}

void average_error(const RoundPixels& pixels, const ControlSet& control, uint32_t frames, ErrorEstimate* estimate) {
    estimate->stratification /= frames;
    estimate->mean_luminance = mean_luminance(pixels);
    if (const NoiseSums sums(pixels, estimate->mean_luminance); sums.covered > 0) sums.write(estimate);
    const std::vector<Comparison> compared = compare(pixels, control, frames, estimate->mean_luminance);
    add_bias(pixels, compared, spread_calibration(pixels, compared), estimate);
}

std::vector<float> pixel_errors(const RoundPixels& pixels, const ErrorEstimate& estimate,
                                const std::vector<uint32_t>& slot_of, const std::vector<float>& shape) {
    std::vector<double> shape_sums(estimate.slots.size());
    for (size_t i = 0; i < pixels.material.size(); ++i)
        if (const double part = interpolated_part(pixels, i); part > 0)
            shape_sums[slot_of[pixels.material[i] - 1u]] += part * part * shape[i];
    // Where control samples see less error than the spreads estimate, every pixel's noise is less in that proportion.
    const double noise_factor =
        estimate.bias < 0 ? estimate.stratification * estimate.shading() / estimate.noise : estimate.stratification;
    std::vector<float> errors(pixels.material.size());
    for (size_t i = 0; i < errors.size(); ++i) {
        if (pixels.material[i] == 0) continue;
        const double scale = scale_of(pixels, i, estimate.mean_luminance);
        if (!(scale > 0)) continue;
        double square = noise_factor * displayed_variance(pixels, i) / (scale * scale) + std::max(estimate.bias, 0.0);
        if (const double part = interpolated_part(pixels, i); part > 0) {
            const uint32_t slot = slot_of[pixels.material[i] - 1u];
            const ErrorEstimate::Slot& own = estimate.slots[slot];
            const double all = own.interpolation * double(own.covered);  // summed over the slot's pixels
            square += shape_sums[slot] > 0 ? all * part * part * shape[i] / shape_sums[slot]
                                           : all / std::max(double(own.interpolated), 1.0);
        }
        errors[i] = float(std::sqrt(square));
    }
    return errors;
}

}  // namespace lightband
