// The error of a finished round: noise from the spread of two replicates, interpolation from validation pixels, bias
// from the control set.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "frame/control_set.h"
#include "picture/tiles.h"

namespace lightband {

// Relative errors are taken of L + dark_part * mean L (docs/conventions.md, error of a frame).
constexpr double dark_part = 0.01;

// What a pixel's error is relative to. expected: as predicted; 0 where nothing was.
double scale_of(double displayed, double expected, double mean_luminance);
struct RoundPixels;
double scale_of(const RoundPixels& pixels, size_t at, double mean_luminance);
// Control samples know better than the prediction what a pixel should show.
double scale_of(const ControlSet::Pixel& pixel, double mean_luminance);

// A round's pixels as read back; all arrays of one length, but radiance and spread (four each) interleaved: targets.h.
struct RoundPixels {
    std::vector<float> radiance, spread;
    std::vector<float> expected;  // luminance, as predicted; empty where nothing was
    std::vector<uint32_t> sample_count;
    std::vector<uint8_t> decision, material;
    // Of the interpolated value in what a shaded pixel shows, in 255ths (frame/combine.h); empty: none. combined:
    // whether radiance is that mean already, rather than the pixel's own value.
    std::vector<uint8_t> neighbour_part;
    bool combined = false;
};

// Mean squares over the covered pixels.
struct ErrorEstimate {
    struct Slot {
        uint64_t covered = 0, interpolated = 0, validation = 0;
        double interpolation = 0;            // over this slot's covered pixels
        double combined = 0;                 // squared errors of interpolation in what its shaded pixels show, summed
        double interpolation_deviation = 0;  // standard error of it
    };
    // Validation pixels of a tile: their squared errors of interpolation, and the squares of these, summed.
    struct Tile {
        uint32_t interpolated = 0, validation = 0;
        double sum = 0, squares = 0;
    };
    double mean_luminance = 0;
    double noise = 0;
    // Standard error of it: where one sample dominates a pixel, that pixel's squared error is as uncertain as it is
    // large.
    double noise_deviation = 0;
    // Noise over that of independent samples of the same variance: stratified samples have less.
    double stratification = 1;
    double interpolation = 0, interpolation_deviation = 0;  // the second: standard error of the first
    // Error that control samples see beyond noise and interpolation; negative where the spreads estimate more than
    // there is.
    double bias = 0, bias_deviation = 0;
    std::vector<Slot> slots;
    std::vector<Tile> tiles;

    double error() const;
    // Its parts, relative: where control samples see less error than the spreads estimate, there is less noise and no
    // bias.
    double noise_error() const { return std::sqrt(noise + std::min(bias, 0.0)); }
    double interpolation_error() const { return std::sqrt(interpolation); }
    double bias_error() const { return std::sqrt(std::max(bias, 0.0)); }
    double shading() const { return noise + bias; }  // what more samples reduce
};

// slot_of: BRDF slot of each instance, at its number. tiles: none where nothing is interpolated.
ErrorEstimate estimate_error(const RoundPixels& pixels, const std::vector<uint32_t>& slot_of, size_t slots,
                             const ControlSet& control, const Tiles& tiles);

// The same of the mean of several frames, from the estimate of the first. pixels: those of one frame, but for the
// radiance.
void average_error(const RoundPixels& pixels, const ControlSet& control, uint32_t frames, ErrorEstimate* estimate);

// The relative error to be expected of each pixel; 0 where nothing is seen. shape: how the squared error of
// interpolation is distributed over a slot's interpolated pixels, up to a factor. The root mean square over the covered
// pixels is error().
std::vector<float> pixel_errors(const RoundPixels& pixels, const ErrorEstimate& estimate,
                                const std::vector<uint32_t>& slot_of, const std::vector<float>& shape);

// Variance of the luminance that a pixel's own samples give, or that an interpolated one shows, as if samples were
// independent.
double variance_of_mean(const RoundPixels& pixels, size_t at);
// The part of the interpolated value in what a shaded pixel shows.
double neighbour_part(const RoundPixels& pixels, size_t at);

// Mean luminance of the covered pixels.
double mean_luminance(const RoundPixels& pixels);
// Squared noise over what the spreads of the replicates estimate, at most 1, by the control pixels' own values. Error
// beyond the spreads is no noise by which two neighbours would differ.
double spread_calibration(const RoundPixels& pixels, const ControlSet& control, double mean_luminance);

}  // namespace lightband
