// The estimate of a frame's error, and the control samples that the picture is compared with.
#include "frame/error_control.h"
#include "frame/estimate.h"
#include "numeric_testing.h"
#include "picture/decision.h"

namespace lightband {
namespace {

using namespace testing;

constexpr uint8_t interpolated = 1, shaded = 40, validation = shaded | validation_bit;

double normal(Random& random) {  // Box and Muller
    return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * pi * random.uniform());
}

// A grey frame of known noise: every pixel has `samples` samples of variance `variance` around the radiance 2, and the
// spread of two replicates of them. Every third pixel is interpolated with the error `bias`, every eighth is a
// validation pixel that measures it.
RoundPixels synthetic(Random& random, size_t count, double variance, double bias, uint32_t samples = 64) {
    RoundPixels pixels;
    for (size_t i = 0; i < count; ++i) {
        const double deviation = std::sqrt(variance / samples);
        const uint8_t decision = i % 8 == 0 ? validation : i % 3 == 0 ? interpolated : shaded;
        const double spread = deviation * normal(random), noise = deviation * normal(random);
        const double radiance = 2 + noise;
        pixels.radiance.insert(pixels.radiance.end(), {float(radiance), float(radiance), float(radiance), 0});
        const bool sampled = decision != interpolated;
        // The mean of squares whose unbiased variance is the given one; or the variance of the mean.
        pixels.radiance.back() =
            float(sampled ? radiance * radiance + variance * (samples - 1) / samples : variance / samples);
        // The value interpolated at a validation pixel has as much noise of its own, and the bias.
        if (decision == validation)
            pixels.spread.insert(pixels.spread.end(),
                                 {float(spread), float(bias + deviation * normal(random) - noise),
                                  float(deviation * normal(random) - spread), float(variance / samples)});
        else
            pixels.spread.insert(pixels.spread.end(), {float(spread), 0, 0, 0});
        pixels.sample_count.push_back(sampled ? samples : 0);
        pixels.decision.push_back(decision);
        pixels.material.push_back(1);
    }
    return pixels;
}

// Of a frame of one material and one tile.
ErrorEstimate estimated(const RoundPixels& pixels, const ControlSet& control = {}) {
    return estimate_error(pixels, {0}, 1, control, {1, std::vector<uint32_t>(pixels.material.size())});
}

// Over 40,000 pixels the mean of squared normals is known to sqrt(2 / 40000) = 0.7 %, of 5,000 products to a few
// percent; noise of 2.5 % in the denominator adds three times its square.
void noise_and_interpolation_error_are_estimated(void**) {
    Random random(11);
    const double variance = 0.16, bias = 0.1, scale = 2.02;
    const ErrorEstimate estimate = estimated(synthetic(random, 40000, variance, bias));
    const double noise = variance / 64 / (scale * scale);
    check_close("noise", estimate.noise / noise, 1, 0.03);
    check_close("stratification", estimate.stratification, 1, 0.03);
    const double part = double(estimate.slots[0].interpolated) / 40000;
    check_close("interpolation", estimate.interpolation / (bias * bias / (scale * scale) * part), 1, 0.1);
    check_close("error", estimate.error(), std::sqrt(estimate.noise + estimate.interpolation), 0);
}

void noise_is_not_taken_for_interpolation(void**) {
    Random random(12);
    const ErrorEstimate estimate = estimated(synthetic(random, 40000, 0.64, 0));
    // A mean of 5,000 products of independent normals is within four standard errors of 0.
    assert_true(estimate.slots[0].interpolation <= 4 * estimate.slots[0].interpolation_deviation);
}

void root_mean_square_of_pixel_errors_is_the_frames_error(void**) {
    Random random(13);
    const RoundPixels pixels = synthetic(random, 5000, 0.16, 0.1);
    const ErrorEstimate estimate = estimated(pixels);
    std::vector<float> shape(5000);
    for (float& value : shape) value = float(random.uniform());
    double sum = 0;
    for (float error : pixel_errors(pixels, estimate, {0}, shape)) sum += double(error) * error;
    check_close("root mean square", std::sqrt(sum / 5000) / estimate.error(), 1,
                1e-5);  // floats, summed in double precision
}

void a_frame_without_light_has_no_error(void**) {
    RoundPixels pixels;
    pixels.radiance.assign(40, 0);
    pixels.spread.assign(40, 0);
    pixels.sample_count.assign(10, 8);
    pixels.decision.assign(10, shaded);
    pixels.material.assign(10, 1);
    assert_true(estimated(pixels).error() == 0);
    pixels.material.assign(10, 0);
    assert_true(estimated(pixels).error() == 0);
}

void tiles_count_their_own_validation_pixels(void**) {
    Random random(14);
    // Of 40 pixels a row: three tiles, the last of 8 pixels, and two rows of them.
    const ErrorEstimate estimate =
        estimate_error(synthetic(random, 40 * 24, 0.16, 0.1), {0}, 1, {}, tiles_of_picture(40, 24));
    assert_int_equal(estimate.tiles.size(), 6);
    uint64_t validation_pixels = 0, interpolated_pixels = 0;
    for (const ErrorEstimate::Tile& tile : estimate.tiles) {
        validation_pixels += tile.validation;
        interpolated_pixels += tile.interpolated;
    }
    assert_int_equal(validation_pixels, estimate.slots[0].validation);
    assert_int_equal(interpolated_pixels, estimate.slots[0].interpolated);
    // Pixels whose number is a multiple of eight are validation pixels. Of 40 pixels a row, the tiles hold two, two and
    // one of them.
    assert_int_equal(estimate.tiles[0].validation, 16 * 2);
    assert_int_equal(estimate.tiles[2].validation, 16 * 1);
    assert_int_equal(estimate.tiles[5].validation, 8 * 1);
}

// Every pixel of the picture is wrong by the same amount, which the spread of replicates does not contain. The control
// samples have noise only.
void control_samples_see_a_bias_that_spreads_do_not(void**) {
    Random random(15);
    const double scale = 2.22, wrong = 0.2, deviation = 0.1;
    for (const double factor : {0.0, 1.0}) {
        const RoundPixels pixels = synthetic(random, 20000, 0.16, 0);
        ControlSet control;
        for (uint32_t i = 0; i < 20000; i += 8) {  // validation pixels, which are shaded
            const double a = deviation * normal(random), b = deviation * normal(random);
            control.pixels.push_back({i, float(2 + factor * wrong + 0.5 * (a + b)), float(0.5 * (a - b)), 0, 0, false});
        }
        const ErrorEstimate estimate = estimated(pixels, control);
        // 2,500 squares of deviations of 0.2: known to a few percent; and none is within three standard errors of 0.
        const double expected = std::pow(factor * wrong / scale, 2);
        if (factor > 0)
            check_close("bias", estimate.bias / expected, 1, 0.1);
        else
            check_at_most("bias", std::abs(estimate.bias), 3 * estimate.bias_deviation + 1e-12);
    }
}

// A control set of a synthetic frame, as if chosen by chance: each validation pixel, and two of the other shaded pixels
// for each, as twice as many pixels are shaded as are interpolated.
std::vector<uint32_t> control_places(uint32_t count) {
    std::vector<uint32_t> places;
    for (uint32_t i = 0; i + 8 <= count; i += 8) {
        places.push_back(i);
        for (uint32_t k = i + 1, found = 0; found < 2; ++k)
            if (k % 3 != 0) {
                places.push_back(k);
                ++found;
            }
    }
    return places;
}

// Interpolated pixels, their parents and validation pixels all have the same error. Validation does not see it; control
// samples do.
void control_samples_see_an_error_that_neighbours_share(void**) {
    Random random(18);
    const double shared = 0.2, scale = 2.22;
    RoundPixels pixels = synthetic(random, 20000, 1e-6, 0);
    ControlSet control;
    for (const uint32_t i : control_places(20000))
        control.pixels.push_back({i, float(pixels.radiance[4 * i] + shared), 0, 0, 0, false});
    const ErrorEstimate estimate = estimated(pixels, control);
    check_at_most("interpolation, as validation pixels see it", estimate.interpolation, 1e-6);
    check_close("error", estimate.error(), shared / scale, 0.02 * shared);
}

// Validation pixels are right, but the values interpolated there are wrong, and the spreads take that for noise. The
// interpolated value is what is compared with the control samples.
void control_samples_are_compared_with_the_interpolated_value(void**) {
    Random random(22);
    const double wrong = 0.2, spread = 0.02, scale = 2.02;
    RoundPixels pixels = synthetic(random, 20000, 1e-6, 0);
    ControlSet control;
    for (const uint32_t i : control_places(20000)) {
        if (i % 8 == 0) {
            pixels.spread[4 * i] = float(spread);
            pixels.spread[4 * i + 1] = pixels.spread[4 * i + 2] = float(wrong);
        }
        control.pixels.push_back({i,
                                  float(pixels.radiance[4 * i] + (i % 16 == 0  ? spread
                                                                  : i % 8 == 0 ? -spread
                                                                               : 0)),
                                  0, 0, 0, false});
    }
    const ErrorEstimate estimate = estimated(pixels, control);
    check_at_most("interpolation, as validation pixels see it", estimate.interpolation, 1e-5);
    // Control samples differ from the pixel by the spread, to either side. The square of that is a hundredth of the
    // squared error, which changes the error by half a hundredth. At validation pixels, an eighth of all, it is the
    // only error: another half a hundredth.
    const double expected = wrong / scale * std::sqrt(double(estimate.slots[0].interpolated) / 20000);
    check_close("error", estimate.error(), expected, 0.03 * expected);
}

// Half of the pixels that may be interpolated were validation pixels in a previous round, and display their own
// samples, which are wrong. Control pixels are validation pixels in this round, too: their own samples count for all
// pixels that display theirs.
void previous_validation_pixels_count_by_their_own_samples(void**) {
    Random random(29);
    const double wrong = 0.2, scale = 2.22;  // relative to the control samples
    RoundPixels pixels = synthetic(random, 24000, 1e-6, 0);
    ControlSet control;
    uint64_t wrong_pixels = 0;
    for (uint32_t i = 0; i < 24000; ++i) {
        const bool chosen = i % 8 == 0, may_be = i % 3 != 0, is = may_be && !chosen && i % 3 == 1,
                   is_wrong = may_be && !is;
        pixels.decision[i] = is ? interpolated : chosen && may_be ? validation : shaded;
        pixels.sample_count[i] = is ? 0 : 64;
        std::fill_n(&pixels.spread[4 * i], 4, 0.0f);
        if (chosen && may_be) pixels.spread[4 * i + 1] = float(wrong);  // the interpolated value would be right
        if (chosen)
            control.pixels.push_back({i, float(pixels.radiance[4 * i] + (is_wrong ? wrong : 0)), 0, 0, 0, false});
        wrong_pixels += is_wrong;
    }
    const ErrorEstimate estimate = estimated(pixels, control);
    // At validation pixels the interpolated value deviates from the wrong samples, which counts as an error of
    // interpolation. The rest is bias.
    const double expected = std::pow(wrong / scale, 2) * double(wrong_pixels) / 24000;
    check_close("error", estimate.error(), std::sqrt(expected), 0.02 * std::sqrt(expected));
}

// Control samples of the frame's own sampler have an error of their own, which is subtracted. They are not used for
// pixels with nearly as many samples.
void biased_control_samples_have_an_error_of_their_own(void**) {
    ControlSet control;
    control.samples = 400;
    const ControlSet::Pixel biased = {0, 1, 7, 7, 0, true}, unbiased = {0, 1, 0.0625f, 0.0625f, 0, false};
    assert_true(control.is_better_than(biased, 100) && control.is_better_than(biased, 200) &&
                !control.is_better_than(biased, 300) && !control.is_better_than(biased, 0));
    assert_true(control.is_better_than(unbiased, 1000));
    // 0.3 of the control samples' own squared error is visible; it falls as samples to the power -1.2.
    const double own_part = std::pow(0.25, 1.2);
    check_close("of a quarter of its samples", control.square(biased, 1.25, 0.5, 100) / 0.25, 1 / (1 + 0.3 * own_part),
                1e-12);
    check_close("without bias", control.square(unbiased, 1.25, 0.5, 100), 0.25 - 0.015625, 1e-12);
    check_close("of another", control.squared_error_of_other(biased, 1.25, 0.5, 0.01, 100), 0.25 - 0.01 * own_part,
                1e-12);
}

// Every pixel errs by b n^(-g / 2), all to one side, and by noise besides. A comparison with four times the samples
// shows 1 - 4^-0.6 = 0.565 of the common error.
void common_mode_error_is_separated_from_noise(void**) {
    Random random(30);
    const double noise = 0.01, visible = 0.5647;
    const auto unseen_of_300 = [&](double common) {
        CommonModeError error;
        for (int i = 0; i < 300; ++i) error.add(visible * common + noise * normal(random), 0.25);
        return error.unseen();
    };
    // The mean of 300 has a seventeenth of the noise of each: 0.0006, a thirtieth of 0.017.
    const double common = 0.03, unseen = common * common * (1 - visible * visible);
    check_close("unseen", unseen_of_300(common), unseen, 0.1 * unseen);
    // With noise alone, the squared mean exceeds its own variance by E max(Z^2 - 1, 0) = 2 phi(1) = 0.484 on average,
    // with a standard deviation of 1.1: over 1,000 sets the mean is known to 0.035. (Without the subtraction it would
    // be 1.)
    double sum = 0;
    for (int set = 0; set < 1000; ++set) sum += unseen_of_300(0);
    check_close("unseen, of noise alone", sum / 1000 / (noise * noise / 300 * (1 / (visible * visible) - 1)), 0.484,
                0.12);
    CommonModeError one;
    one.add(0.1, 0.25);
    assert_true(one.unseen() == 0);
}

// An error that all pixels have in common is added to the estimate of the bias.
void common_mode_error_is_part_of_the_bias(void**) {
    Random random(31);
    const double wrong = 0.2;  // of 64 samples; of 256, 0.2 4^-0.6
    const RoundPixels pixels = synthetic(random, 20000, 1e-6, 0);
    ControlSet control;
    control.samples = 256;
    for (const uint32_t i : control_places(20000))
        control.pixels.push_back({i, float(pixels.radiance[4 * i] - wrong * (1 - std::pow(4, -0.6))), 0, 0, 0, true});
    const ErrorEstimate estimate = estimated(pixels, control);
    // Errors are relative to the control samples, which lie 0.087 above the truth of 1.8: one part in twenty.
    // visible_control_error takes one part in eighteen off the squares.
    check_close("error", estimate.error() / (wrong / 1.82), 1, 0.1);
}

// Spreads estimate twice the error that there is; control samples correct them.
void control_samples_correct_the_error_of_pilot_samples(void**) {
    Random random(16);
    const double error = 0.01;
    BiasEstimate sum;
    for (int i = 0; i < 5000; ++i)
        sum.add(std::pow(error * normal(random), 2), 2 * std::pow(error * normal(random), 2));
    // Means of 5,000 squares of normal deviations are known to 2 %; the control samples have all but a thousandth of
    // the weight.
    check_close("error", sum.error() / (error * error), 1, 0.12);
    BiasEstimate none, dark;
    dark.add(0, 0);
    assert_true(none.error() == 0 && dark.error() == 0);
}

// One square that is far larger than all others may be chance: n equal squares and one of n times as much have twice
// the mean, with a standard error as large as the increase, so that little of it counts. Where all squares are larger,
// all of the increase counts.
void a_single_large_square_is_uncertain(void**) {
    const int n = 400;
    BiasEstimate one, all;
    for (int i = 0; i < n; ++i) {
        one.add(i == 0 ? 0.001 * (n + 1) : 0.001, 0.001);
        all.add(0.002 + 0.0005 * (i % 2), 0.001);
    }
    // Ratio 2, variance 1: the ratio is within its standard error of 1, and its weight is the expected variance of 1/4
    // over 1/4 + 1.
    check_close("one", one.error() / 0.001, 1.2, 0.001);
    check_close("all", all.error() / 0.001, 2.25, 0.001);
}

// Unbiased samples that find more light than a light cut show that the cut misses some. Samples that find less show
// nothing.
void a_cut_is_contradicted_only_by_more_light(void**) {
    const ControlSet::Pixel cut = {0, 1, 0.01f, 0.01f, 0, true};
    const auto seen = [](float mean, float deviation) { return ControlSet::Pixel{0, mean, 0, deviation, 0, false}; };
    assert_true(ControlSet::sees_more_than(seen(1.31f, 0.1f), cut) &&
                !ControlSet::sees_more_than(seen(1.29f, 0.1f), cut));
    assert_false(ControlSet::sees_more_than(seen(0, 0), cut));
}

// All control pixels but a few, which err most, have got more samples than their control samples. Those few do not
// stand for the others.
void pixels_that_outgrow_their_control_samples_still_count(void**) {
    Random random(26);
    RoundPixels pixels = synthetic(random, 20000, 0.01, 0);
    ControlSet control;
    control.samples = 1;
    for (uint32_t i = 0; i < 400; ++i) {
        const bool wrong = i < 4;
        const uint32_t at = 24 * i + 1;  // shaded
        control.pixels.push_back({at, float((wrong ? 1.5 : 1) * pixels.radiance[4 * at]), 0, 0, 0, !wrong});
    }
    const ErrorEstimate estimate = estimated(pixels, control);
    // Four squares of a ninth among 400, known to their half: the mean square of the frame, not of the four.
    const double seen = 4.0 / 9 / 400;
    assert_true(estimate.bias > 0.2 * seen && estimate.bias <= seen);
}

void pixels_chosen_for_a_small_part_are_chosen_for_a_larger_one(void**) {
    uint32_t few = 0, more = 0;
    std::vector<uint32_t> rows(256);
    for (uint32_t y = 0; y < 256; ++y)
        for (uint32_t x = 0; x < 256; ++x) {
            const bool chosen = is_chosen_by(x, y, 77, 1.0 / 32);
            few += chosen;
            rows[y] += chosen;
            more += is_chosen_by(x, y, 77, 1.0 / 16);
            assert_true(!chosen || is_chosen_by(x, y, 77, 1.0 / 16));
        }
    // Binomial: four standard deviations of 65,536 trials; and no row of 256 has none of its 8 or thrice as many (e^-8,
    // 1e-6).
    check_close("a 32nd", few, 2048, 4 * std::sqrt(2048.0));
    check_close("a 16th", more, 4096, 4 * std::sqrt(4096.0));
    assert_true(*std::max_element(rows.begin(), rows.end()) < 28);
}

// A frame with an unbiased sampler and no target error has no control set; one with a time budget has a smaller one.
void the_control_set_has_the_size_that_settings_permit(void**) {
    Settings settings;
    assert_true(ControlSet::effort(settings, 30000, 0).samples == 4 * settings.samples());
    settings.set_number("accumulate", 8);
    assert_true(ControlSet::effort(settings, 30000, 0).samples == 32 * settings.samples());
    settings.set_number("accumulate", 1);
    settings.set_choice("sampler", "combined");
    assert_true(ControlSet::effort(settings, 30000, 0).part == 0);
    settings.set_number("target_error", 0.02);
    assert_true(ControlSet::effort(settings, 30000, 0).pilot > 0 &&
                ControlSet::effort(settings, 30000, 0).samples == 0);
    settings.set_choice("sampler", "cut");
    const ControlSet::Effort planned = ControlSet::effort(settings, 30000, 0);
    assert_int_equal(planned.pilot, 91);  // (0.3 / 0.02)^(2 / 1.2)
    assert_int_equal(planned.samples, 364);
    settings.set_choice("sampler", "filtered");
    assert_int_equal(ControlSet::effort(settings, 30000, 0).samples, 1125);  // 5 / (0.02 / 0.3)^2
    settings.set_number("time_budget", 50);
    const ControlSet::Effort hurried = ControlSet::effort(settings, 30000, 250000);
    check_at_most("samples in a twentieth of the time",
                  hurried.part * 30000 * (hurried.samples + constants::pixel_samples), 1.2 * 0.06 * 250000);
    assert_true(hurried.part * 30000 >= 64);
    // 64 pixels of 64 samples, and 30 before the first, are 6 % of 100,267.
    assert_true(ControlSet::effort(settings, 30000, 101000).part > 0 &&
                ControlSet::effort(settings, 30000, 100000).part == 0);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(noise_and_interpolation_error_are_estimated),
        cmocka_unit_test(noise_is_not_taken_for_interpolation),
        cmocka_unit_test(root_mean_square_of_pixel_errors_is_the_frames_error),
        cmocka_unit_test(a_frame_without_light_has_no_error),
        cmocka_unit_test(a_single_large_square_is_uncertain),
        cmocka_unit_test(a_cut_is_contradicted_only_by_more_light),
        cmocka_unit_test(pixels_that_outgrow_their_control_samples_still_count),
        cmocka_unit_test(tiles_count_their_own_validation_pixels),
        cmocka_unit_test(control_samples_see_a_bias_that_spreads_do_not),
        cmocka_unit_test(common_mode_error_is_separated_from_noise),
        cmocka_unit_test(common_mode_error_is_part_of_the_bias),
        cmocka_unit_test(control_samples_correct_the_error_of_pilot_samples),
        cmocka_unit_test(control_samples_see_an_error_that_neighbours_share),
        cmocka_unit_test(control_samples_are_compared_with_the_interpolated_value),
        cmocka_unit_test(previous_validation_pixels_count_by_their_own_samples),
        cmocka_unit_test(biased_control_samples_have_an_error_of_their_own),
        cmocka_unit_test(pixels_chosen_for_a_small_part_are_chosen_for_a_larger_one),
        cmocka_unit_test(the_control_set_has_the_size_that_settings_permit),
    };
    return cmocka_run_group_tests_name("estimate", tests, nullptr, nullptr);
}
