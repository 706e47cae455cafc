// Every constant of error control, in one table: the name, the value, and in the comment before it the unit in
// brackets, what it is, and where it was derived or measured. docs/error-control-constants.md is written from this
// file, with what happens to time and error when a constant is halved or doubled (bench/constants.py, in a build with
// LIGHTBAND_STUDY, in which constants can be changed while it runs).
#pragma once

#if defined(LIGHTBAND_STUDY)
#include "picture/constant_study.h"
#else
#define LIGHTBAND_CONSTANT(name, value) constexpr double name = value
#endif

namespace lightband::constants {

// ---- Interpolation ----

// [relative error] Error of interpolation that a frame of given samples assumes where levels follow the bandwidth
// unscaled. Measured on scanned meshes it lies between 0.01 (a matte fabric) and 0.1 (a clear coat under a light
// probe).
LIGHTBAND_CONSTANT(unmeasured_interpolation_error, 0.08);
// [relative error] The same for a frame that is asked for an error and corrects itself. It begins below the least that
// was measured, since levels can be refined later and never coarsened.
LIGHTBAND_CONSTANT(expected_interpolation_error, 0.005);
// [exponent] The error of interpolation falls with the scale on the bandwidth to this power: linear interpolation of a
// smooth function.
LIGHTBAND_CONSTANT(interpolation_error_power, 2);
// [exponent] A tile's scale grows by its squared error of interpolation over what is allowed, to this power. For a
// smooth picture scales would have to grow by the fourth root; near edges, where most of the error comes from, it falls
// more slowly. The twelve spheres of docs/trade.md took 0.89 of the time at equal error at 2 %, 0.97 at 1 %, that a
// power of 1/2 and at most 4 times took.
LIGHTBAND_CONSTANT(scale_growth_power, 0.75);
// [factor] A scale that would grow by less is left as it is, since a new classification costs more.
LIGHTBAND_CONSTANT(least_scale_growth, 1.1);
// [factor] A scale grows by no more than this in one round.
LIGHTBAND_CONSTANT(most_scale_growth, 8);
// [errors asked for] Tolerance of the contrast test (shaders/contrast.glsl).
LIGHTBAND_CONSTANT(contrast_tolerance, 1.2);
// [relative error] It is no less than this, as predictions of neighbouring pixels differ by so much by themselves.
LIGHTBAND_CONSTANT(least_contrast_tolerance, 0.03);
// [relative error] And no more than this, nor less in frames that ask for no error.
LIGHTBAND_CONSTANT(most_contrast_tolerance, 0.5);
// [part of the covered pixels] Validation pixels, where many pixels are interpolated: it costs little.
LIGHTBAND_CONSTANT(least_validation_part, 1.0 / 16);
// [pixels] Validation pixels that measure the error of interpolation, where fewer pixels are.
LIGHTBAND_CONSTANT(enough_validation_pixels, 256);
// [pixels] A tile's few validation pixels are joined by so many that have the frame's mean.
LIGHTBAND_CONSTANT(prior_validation_pixels, 4);
// [part of the squared error] Share of interpolation, as planned. The number of shaded pixels grows about as the scale,
// the square of the error of interpolation falls as its fourth power, that of noise as the number of samples: time is
// least at some quarter of the whole.
LIGHTBAND_CONSTANT(interpolation_share, 0.3);
// [part of the squared error] Share that interpolation may keep in a further round.
LIGHTBAND_CONSTANT(most_interpolation_share, 0.5);
// [rounds] After so many that have not found levels for it, nothing is interpolated.
LIGHTBAND_CONSTANT(most_refinements, 5);
// [times the allowed noise] Up to this noise validation pixels are taken into account.
LIGHTBAND_CONSTANT(trusted_noise, 3);
// [times the allowed noise] Up to this noise they are, without subtracting their standard error.
LIGHTBAND_CONSTANT(certain_noise, 1.25);

// ---- Rounds that an error asks for ----

// [part of the error asked for] Rounds aim at this, below what was asked by what the estimate may miss.
LIGHTBAND_CONSTANT(aim, 0.8);
// [part of the error asked for] The last round is one whose estimate is at most this.
LIGHTBAND_CONSTANT(near_enough, 0.85);
// [part of the error asked for] Or at most this, with all its standard errors added.
LIGHTBAND_CONSTANT(good_enough, 0.93);
// [standard errors] So many are added to an estimate.
LIGHTBAND_CONSTANT(added_standard_errors, 1);
// [rounds] A frame takes no more.
LIGHTBAND_CONSTANT(most_rounds, 8);
// [part of the allowed noise] The noise that a first round plans for. The pixels that others are interpolated from pass
// their noise on to many: first rounds were seen to leave between half and twice of what pilot samples predicted, and a
// second costs more than some samples.
LIGHTBAND_CONSTANT(first_round_noise, 0.55);
// [part of the noise] A further round leaves at most this part of the noise.
LIGHTBAND_CONSTANT(least_progress, 0.9);
// [part of the noise] And no less than this, as the noise of few samples is known badly, and often estimated far too
// high.
LIGHTBAND_CONSTANT(most_progress, 0.25);

// ---- Rounds that a time asks for ----

// [part of the time] What the first of two rounds may take.
LIGHTBAND_CONSTANT(first_round_time, 0.15);
// [part of the time] What must be left for another round to be worth its overhead.
LIGHTBAND_CONSTANT(worthwhile_time, 0.1);
// [samples] Of each pixel where no time is left: the fixed cost of a pixel is higher than theirs.
LIGHTBAND_CONSTANT(fewest_samples_in_time, 6);
// [factor] Levels are made coarser by no more than this, where time does not suffice for all pixels that would be
// shaded.
LIGHTBAND_CONSTANT(most_coarsening, 0.1);
// [part of the shaded pixels] A round that shades fewer is not taken as a measure of throughput.
LIGHTBAND_CONSTANT(representative_part, 0.25);
// [part] Of what a round takes beside shading, what comes after it.
LIGHTBAND_CONSTANT(overhead_after_shading, 0.6);
// [samples] Fixed cost of a shaded pixel: the selection probabilities of the map's clusters, or the initial light cut.
LIGHTBAND_CONSTANT(pixel_samples, 30);

// ---- Control set ----

// [pixels] Squared errors differ by orders of magnitude from pixel to pixel, and their mean over a few hundred is known
// to a quarter or so; its ratio to what the spreads estimate, to a tenth or so. More pixels cost more than they save
// (docs/decisions/0010).
LIGHTBAND_CONSTANT(control_pixels, 288);
// [part of the covered pixels] Pixels of the set besides those.
LIGHTBAND_CONSTANT(control_part_beyond, 1.0 / 192);
// [part of the covered pixels] The set of a larger frame is at most this.
LIGHTBAND_CONSTANT(most_control_part, 1.0 / 32);
// [part of the covered pixels] The set of a small frame is at most this, or nothing would be interpolated.
LIGHTBAND_CONSTANT(most_small_control_part, 0.5);
// [pixels] In a frame of so few, nothing is interpolated and all pixels are in the set.
LIGHTBAND_CONSTANT(few_covered_pixels, 64);
// [samples] Fewest control samples of a pixel.
LIGHTBAND_CONSTANT(fewest_control_samples, 64);
// [samples] Most control samples of a pixel.
LIGHTBAND_CONSTANT(most_control_samples, 1 << 16);
// [control samples for each sample of a pixel] A pixel of N samples of a light cut differs from one of 4 N by 1.04 of
// its own squared error (0.87 to 1.16 by scene of docs/trade.md), from one of 8 N by 1.01 (docs/decisions/0010).
LIGHTBAND_CONSTANT(control_gain, 4);
// [part of the squared error] Of the control samples' own error, what is visible in that comparison.
LIGHTBAND_CONSTANT(visible_control_error, 0.3);
// [control samples for each sample of a pixel] With fewer, they tell more of their own error than of the pixel's.
LIGHTBAND_CONSTANT(least_control_gain, 1.8);
// [factor on n^g] A pixel of n samples of a light cut errs by 0.2 to 0.4 of n^(-g / 2); one sampled by the map's
// clusters by 0.5 to 1 over the square root of its samples: as much, with so many times n^g.
LIGHTBAND_CONSTANT(unbiased_share, 5);
// [relative error] Of a pixel of one sample of a light cut, by which the number of pilot samples is chosen.
LIGHTBAND_CONSTANT(expected_sample_error, 0.3);
// [samples] Fewest pilot samples of a pixel.
LIGHTBAND_CONSTANT(least_pilot_samples, 16);
// [samples] Most pilot samples of a pixel.
LIGHTBAND_CONSTANT(most_pilot_samples, 512);
// [part of the samples that there is time for] What the control set of a frame with a time budget may take.
LIGHTBAND_CONSTANT(control_part_of_time, 0.06);
// [pixels] Where it does not suffice for so many, there is no control set.
LIGHTBAND_CONSTANT(fewest_control_pixels, 64);
// [relative] Pixels err by as much as their variances estimate, give or take this, before any control sample is drawn
// (0010).
LIGHTBAND_CONSTANT(expected_uncertainty, 0.5);
// [squared relative error] A squared error counts at most as the square of what the pixel displays: those of few
// samples go far beyond, and one of them would outweigh all others.
LIGHTBAND_CONSTANT(largest_square, 1);
// [part] The noise is not taken to be less than this part of what the spreads estimate.
LIGHTBAND_CONSTANT(least_bias_ratio, 0.1);

// ---- Recheck without bias ----

// [pixels] Every so many-th pixel of the control set is rechecked.
LIGHTBAND_CONSTANT(recheck_stride, 4);
// [pixels] Of so few, all are.
LIGHTBAND_CONSTANT(fewest_rechecked, 64);
// [part of the control set] Besides, those pixels where pilot and control samples differ most.
LIGHTBAND_CONSTANT(differing_part, 0.05);
// [part of the frame's error] A bias that is harmless: a half of the error adds an eighth to the whole.
LIGHTBAND_CONSTANT(harmless_part, 0.5);
// [relative error] A bias that is harmless: the directions of the map that all pixels of an unbiased frame share leave
// as much (0006).
LIGHTBAND_CONSTANT(least_difference, 0.003);
// [standard deviations] Of unbiased samples, which chance may reach: for a few dozen pixels, one in a thousand each.
LIGHTBAND_CONSTANT(sure_unbiased_deviations, 3);
// [standard errors] A larger difference is no chance. Over the 60 scenes of docs/trade.md at 5, 2 and 1 %, differences
// were -3.6 to 2.4 of them: of some dozen pixels they are skewed, since unbiased samples meet small bright sources
// rarely.
LIGHTBAND_CONSTANT(sure_difference_errors, 4);
// [standard errors] By which a cut must err more than as many unbiased samples to be given up for that alone.
LIGHTBAND_CONSTANT(worse_errors, 3);
// [pixels] Fewer do not know their own standard error; they are taken to be no better than independent samples.
LIGHTBAND_CONSTANT(few_rechecked, 16);

// ---- Estimate ----

// [pixels] The spread of a single pair of replicates has one degree of freedom: so many pixels with the noise of
// independent samples are added, or a tiny frame might be estimated to be free of noise by chance.
LIGHTBAND_CONSTANT(prior_noise_pixels, 8);
// [part of the predicted luminance] The luminance that an error is relative to is no less: a few samples that miss the
// light would make any error look large.
LIGHTBAND_CONSTANT(least_expected, 0.5);
// [part of the predicted luminance] And no more: a sample that is far too bright would raise the luminance that its own
// error is divided by.
LIGHTBAND_CONSTANT(most_expected, 1.5);
// [standard deviations] Unless the displayed value less so many is more: prediction may miss a small source that many
// samples find.
LIGHTBAND_CONSTANT(sure_pixel_deviations, 3);
// [relative error] Unbiased samples of all pixels share the directions of the map, so that about so much of their error
// is common (0006).
LIGHTBAND_CONSTANT(error_of_directions, 0.002);

// ---- Combined pixels ----

// [pixels] A tile's sums are joined by so many pixels that have the frame's means, as a few pixels know a variance
// badly.
LIGHTBAND_CONSTANT(prior_combined_pixels, 8);
// [standard deviations] A pixel that differs from the interpolated value by more is an edge, and keeps its own value.
// With 3, the error of the blob of bench/speckle.py at 5 % was 1.1 times what it is without combining.
LIGHTBAND_CONSTANT(edge_deviations, 4);
// [standard deviations] The same where something speaks against interpolation. With 2.5 for both, 3.8 pixels in 1,000
// of the sphere at 2 % stand out, with these 2.7.
LIGHTBAND_CONSTANT(doubtful_edge_deviations, 2.6);
// [factor] Across twice the distance the squared error of interpolation is at least so many times as large: beside an
// edge; 16 times where the picture is smooth.
LIGHTBAND_CONSTANT(least_interpolation_growth, 2);

// ---- Samples ----

// [exponent] Noise falls as the number of samples to this power: 1 for independent ones; 1.15 to 1.35 were measured.
LIGHTBAND_CONSTANT(stratified_gain, 1.2);
// [samples] So many measure a pixel's variance as well as the mean variance of all pixels stands for it: with a
// kurtosis of this much, the variance measured by n = kurtosis samples is off by as much as itself, and pixels differ
// from each other by about as much.
LIGHTBAND_CONSTANT(prior_samples, 16);

}  // namespace lightband::constants
