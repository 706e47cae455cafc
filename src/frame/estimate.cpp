#include "frame/estimate.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "picture/decision.h"

namespace lightband {
namespace {

double luminance_at(const RoundPixels& pixels, size_t at) {
    const float* rgb = &pixels.radiance[4 * at];
    return luminance(Vec3(rgb[0], rgb[1], rgb[2]));
}

// What a shaded pixel shows is (1 - p) times its own value and p times the interpolated one, p being neighbour_part: so are its spread and,
// with squared weights, its variance.
double shown_luminance(const RoundPixels& pixels, size_t at) {
    return luminance_at(pixels, at) + (pixels.combined ? 0 : neighbour_part(pixels, at) * double(pixels.spread[4 * at + 1]));
}
double shown_spread(const RoundPixels& pixels, size_t at) {
    return pixels.spread[4 * at] + neighbour_part(pixels, at) * double(pixels.spread[4 * at + 2]);
}
double shown_variance(const RoundPixels& pixels, size_t at) {
    const double part = neighbour_part(pixels, at), own = variance_of_mean(pixels, at);
    return part > 0 ? (1 - part) * (1 - part) * own + part * part * std::abs(double(pixels.spread[4 * at + 3])) : own;
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
// mean to better than that; but where they found no lamp, not so well as many samples that did: what a pixel shows less three of its
// standard deviations is believed.
constexpr double least_expected = 0.5, most_expected = 1.5, sure_deviations = 3;

// A pixel that an audit looked at, held against it; squared and relative.
struct Audited {
    size_t at;
    double scale;
    bool overtaken;       // by its own samples: its spreads are believed
    double deviation;     // of what was drawn there: not squared
    double own_part;      // its samples in one frame, in parts of the audit's: frames share their cuts; 0: the audit has no bias
    double drawn;         // what was drawn there
    double shown;         // what the pixel shows: the same, or a mean of it and the interpolated value
    double interpolated;  // what interpolation would show, at a witness

    void add_to(AuditSum* sum, double square, double told) const { overtaken ? sum->add_believed(told) : sum->add(square, told); }
};

// frames: over which the picture is a mean.
std::vector<Audited> held_against(const RoundPixels& pixels, const Audit& audit, uint32_t frames, double mean) {
    std::vector<Audited> result;
    for (const Audit::Pixel& seen : audit.pixels) {
        const size_t i = seen.at;
        const double scale = scale_of(pixels, i, mean), samples = double(pixels.sample_count[i]) * frames;
        const double known = scale_of(seen, mean);
        if (!(scale > 0) || !(known > 0) || samples == 0) continue;
        const double shown = luminance_at(pixels, i), drawn = audit.square(seen, shown, known, samples);
        const bool witness = is_witness(pixels.decision[i]);
        const double part = neighbour_part(pixels, i), left = pixels.combined ? 1 - part : 1;  // of the deviation, beyond `shown`
        result.push_back({i, scale, !audit.tells_of(seen, samples), (shown - double(seen.mean)) / known,
                          seen.biased ? double(pixels.sample_count[i]) / audit.samples : 0, drawn,
                          part > 0 ? audit.square_of_other(seen, shown_luminance(pixels, i), known, drawn, samples) : drawn,
                          witness ? audit.square_of_other(seen, shown + left * pixels.spread[4 * i + 1], known, drawn, samples) : 0});
    }
    return result;
}

// The part of the covered pixels that is audited.
double part_of(const RoundPixels& pixels, const std::vector<Audited>& audited) {
    const auto unseen = std::count(pixels.material.begin(), pixels.material.end(), uint8_t(0));
    return double(audited.size()) / std::max(double(pixels.material.size()) - double(unseen), 1.0);
}

double truth_of_spreads(const RoundPixels& pixels, const std::vector<Audited>& audited) {
    AuditSum sum(part_of(pixels, audited));
    for (const Audited& pixel : audited) pixel.add_to(&sum, pixel.drawn, std::pow(pixels.spread[4 * pixel.at] / pixel.scale, 2));
    return 1 + std::min(sum.beyond(1).mean, 0.0);
}

// The part of interpolation in what a pixel shows.
double interpolated_part(const RoundPixels& pixels, size_t at) {
    return is_interpolated(pixels.decision[at]) ? 1 : neighbour_part(pixels, at);
}

// Squared error of interpolation at a witness. The square of its deviation holds the noise of both values; what the replicates tell
// of that is taken off, as far as it is true.
double witnessed(const RoundPixels& pixels, size_t at, double scale, double truth) {
    const double deviation = pixels.spread[4 * at + 1] / scale, difference = pixels.spread[4 * at + 2] / scale;
    return std::clamp(deviation * deviation - truth * difference * difference, -AuditSum::largest_square, AuditSum::largest_square);
}

double hidden_of(const std::vector<Audited>& audited) {
    SharedError shared;
    for (const Audited& pixel : audited)
        if (!pixel.overtaken && pixel.own_part > 0) shared.add(pixel.deviation, pixel.own_part);
    return shared.hidden();
}

// Of the pixels that might be interpolated, of which audited ones are witnesses, the part that is. Others show what was drawn there when
// they were witnesses of this round or a former one.
double interpolated_part(const RoundPixels& pixels, const std::vector<Audited>& audited, const ErrorEstimate& estimate) {
    double covered = 0, interpolated = 0, witnesses = 0;
    for (const ErrorEstimate::Slot& slot : estimate.slots) {
        covered += double(slot.covered);
        interpolated += double(slot.interpolated);
    }
    for (const Audited& pixel : audited) witnesses += is_witness(pixels.decision[pixel.at]);
    return witnesses > 0 ? std::min(interpolated / covered / (witnesses / double(audited.size())), 1.0) : 0;
}

// Unbiased samples of all pixels share the directions that were drawn from the map, and err alike by about so much (sampling/map_sampler,
// docs/decisions/0006).
constexpr double error_of_directions = 0.002;

// What all pixels may err by alike without that unbiased samples show it: the squared standard error of the mean deviation from them, and
// what they err by alike themselves.
double below_notice(const std::vector<Audited>& audited) {
    double count = 0, sum = 0, squares = 0;
    for (const Audited& pixel : audited) {
        if (pixel.own_part > 0) return 0;
        ++count;
        sum += pixel.deviation;
        squares += pixel.deviation * pixel.deviation;
    }
    if (count < 2) return 0;
    return std::max(squares - sum * sum / count, 0.0) / (count - 1) / count + error_of_directions * error_of_directions;
}

// Audited witnesses stand for the pixels that might be interpolated, whether they are or not.
void add_bias(const RoundPixels& pixels, const std::vector<Audited>& audited, double truth, ErrorEstimate* estimate) {
    AuditSum sum(part_of(pixels, audited));
    const double part = interpolated_part(pixels, audited, *estimate), hidden = hidden_of(audited);
    for (const Audited& pixel : audited) {
        const double per_scale = estimate->stratification / (pixel.scale * pixel.scale);
        const double own_part = neighbour_part(pixels, pixel.at);
        double square = pixel.shown, told = per_scale * shown_variance(pixels, pixel.at);
        if (own_part > 0) told += own_part * own_part * witnessed(pixels, pixel.at, pixel.scale, truth);
        if (is_witness(pixels.decision[pixel.at])) {
            square += part * (pixel.interpolated - square);
            told += part * (per_scale * pixels.spread[4 * pixel.at + 3] + witnessed(pixels, pixel.at, pixel.scale, truth) - told);
        }
        pixel.add_to(&sum, square + (pixel.own_part > 0 ? hidden : 0), told);
    }
    const AuditSum::Bias bias = sum.beyond(estimate->noise + estimate->interpolation);
    estimate->bias = std::max(bias.mean, (AuditSum::least_true - 1) * estimate->noise) + below_notice(audited);
    estimate->bias_deviation = bias.deviation;
}

// Squares relative to each pixel's scale, summed over the covered pixels: of the replicates' spreads, of the means' variances, and of
// those variances.
struct NoiseSums {
    double covered = 0, spreads = 0, variances = 0, squares = 0;

    NoiseSums(const RoundPixels& pixels, double mean_luminance) {
        for (size_t i = 0; i < pixels.material.size(); ++i) {
            if (pixels.material[i] == 0) continue;
            ++covered;
            const double scale = scale_of(pixels, i, mean_luminance);
            if (!(scale > 0)) continue;  // a frame without light has no error
            const double spread = shown_spread(pixels, i) / scale, variance = shown_variance(pixels, i) / (scale * scale);
            spreads += spread * spread;
            variances += variance;
            squares += variance * variance;
        }
    }

    void tell(ErrorEstimate* estimate) const {
        estimate->noise = estimate->stratification * variances / covered;
        estimate->noise_deviation = estimate->stratification * std::sqrt(squares) / covered;
    }
};

}  // namespace

double scale_of(double shown, double expected, double mean_luminance) {
    if (expected > 0) shown = std::clamp(shown, least_expected * expected, most_expected * expected);
    return shown + dark_part * mean_luminance;
}

double scale_of(const RoundPixels& pixels, size_t at, double mean_luminance) {
    const double shown = shown_luminance(pixels, at), sure = shown - sure_deviations * std::sqrt(shown_variance(pixels, at));
    const double scale = scale_of(shown, pixels.expected.empty() ? 0 : pixels.expected[at], mean_luminance);
    return std::max(scale, sure + dark_part * mean_luminance);
}

double scale_of(const Audit::Pixel& seen, double mean_luminance) { return seen.mean + dark_part * mean_luminance; }

double ErrorEstimate::error() const { return std::sqrt(noise + interpolation + bias); }

double neighbour_part(const RoundPixels& pixels, size_t at) {
    return pixels.neighbour_part.empty() ? 0 : pixels.neighbour_part[at] / 255.0;
}

double mean_luminance(const RoundPixels& pixels) {
    double sum = 0, covered = 0;
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        if (pixels.material[i] == 0) continue;
        sum += shown_luminance(pixels, i);
        ++covered;
    }
    return covered > 0 ? sum / covered : 0;
}

double truth_of_spreads(const RoundPixels& pixels, const Audit& audit, double mean_luminance) {
    return truth_of_spreads(pixels, held_against(pixels, audit, 1, mean_luminance));
}

double variance_of_mean(const RoundPixels& pixels, size_t at) {
    const double square = pixels.radiance[4 * at + 3], mean = luminance_at(pixels, at);
    const uint32_t n = pixels.sample_count[at];
    if (n == 0) return square;
    return n > 1 ? std::max(square - mean * mean, 0.0) / (n - 1) : mean * mean;
}

ErrorEstimate estimate_error(const RoundPixels& pixels, const std::vector<uint32_t>& slot_of, size_t slots,
                             const Audit& audit, const Tiles& tiles) {
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
        const double prior = prior_pixels * sums.variances / sums.covered;
        result.stratification = (sums.spreads + prior) / (sums.variances + prior);
    }
    sums.tell(&result);
    const std::vector<Audited> audited = held_against(pixels, audit, 1, result.mean_luminance);
    const double truth = truth_of_spreads(pixels, audited);
    std::vector<WitnessSums> witnesses(slots);
    for (size_t i = 0; i < pixels.material.size(); ++i) {
        const double part = neighbour_part(pixels, i);
        if (pixels.material[i] == 0 || !(is_witness(pixels.decision[i]) || part > 0)) continue;
        const double scale = scale_of(pixels, i, result.mean_luminance);
        if (!(scale > 0)) continue;
        const uint32_t slot = slot_of[pixels.material[i] - 1u];
        result.slots[slot].combined += part * part * witnessed(pixels, i, scale, truth);
        if (!is_witness(pixels.decision[i])) continue;
        ++result.slots[slot].witnesses;
        const double square = witnessed(pixels, i, scale, truth);
        witnesses[slot].sum += square;
        witnesses[slot].squares += square * square;
        ErrorEstimate::Tile& tile = result.tiles[tiles.of[i]];
        ++tile.witnesses;
        tile.sum += square;
        tile.squares += square * square;
    }
    for (size_t slot = 0; slot < slots; ++slot) {
        ErrorEstimate::Slot& own = result.slots[slot];
        own.interpolation = std::max(own.combined, 0.0) / std::max(double(own.covered), 1.0);
        result.interpolation += own.interpolation * double(own.covered) / sums.covered;
        if (own.witnesses == 0) continue;
        const double count = double(own.witnesses), mean = witnesses[slot].sum / count;
        const double part = double(own.interpolated) / double(own.covered);
        const double interpolated = std::max(mean, 0.0) * part;
        own.interpolation += interpolated;
        own.interpolation_deviation = std::sqrt(std::max(witnesses[slot].squares / count - mean * mean, 0.0) / count) * part;
        result.interpolation += interpolated * double(own.covered) / sums.covered;
        result.interpolation_deviation =
            std::hypot(result.interpolation_deviation, own.interpolation_deviation * double(own.covered) / sums.covered);
    }
    add_bias(pixels, audited, truth, &result);
    return result;
}

void average_error(const RoundPixels& pixels, const Audit& audit, uint32_t frames, ErrorEstimate* estimate) {
    estimate->stratification /= frames;
    estimate->mean_luminance = mean_luminance(pixels);
    if (const NoiseSums sums(pixels, estimate->mean_luminance); sums.covered > 0) sums.tell(estimate);
    const std::vector<Audited> audited = held_against(pixels, audit, frames, estimate->mean_luminance);
    add_bias(pixels, audited, truth_of_spreads(pixels, audited), estimate);
}

std::vector<float> pixel_errors(const RoundPixels& pixels, const ErrorEstimate& estimate, const std::vector<uint32_t>& slot_of,
                                const std::vector<float>& shape) {
    std::vector<double> shape_sums(estimate.slots.size());
    for (size_t i = 0; i < pixels.material.size(); ++i)
        if (const double part = interpolated_part(pixels, i); part > 0)
            shape_sums[slot_of[pixels.material[i] - 1u]] += part * part * shape[i];
    // Where an audit found less than the spreads tell, every pixel's noise is less in that proportion.
    const double known_better =
        estimate.bias < 0 ? estimate.stratification * estimate.shading() / estimate.noise : estimate.stratification;
    std::vector<float> errors(pixels.material.size());
    for (size_t i = 0; i < errors.size(); ++i) {
        if (pixels.material[i] == 0) continue;
        const double scale = scale_of(pixels, i, estimate.mean_luminance);
        if (!(scale > 0)) continue;
        double square = known_better * shown_variance(pixels, i) / (scale * scale) + std::max(estimate.bias, 0.0);
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
