// What a frame says of its error, and the audits that it is held against.
#include "frame/error_control.h"
#include "frame/estimate.h"
#include "numeric_testing.h"
#include "picture/decision.h"

namespace lightband {
namespace {

using namespace testing;

constexpr uint8_t interpolated = 1, shaded = 40, witness = shaded | validation_bit;

double normal(Random& random) {  // Box and Muller
    return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * pi * random.uniform());
}

// A grey frame of known noise: every pixel has `samples` samples of variance `variance` around the radiance 2, and spreads as
// their two halves would have. Every third pixel is interpolated with the error `bias`, every eighth a witness of it.
RoundPixels synthetic(Random& random, size_t count, double variance, double bias, uint32_t samples = 64) {
    RoundPixels pixels;
    for (size_t i = 0; i < count; ++i) {
        const double deviation = std::sqrt(variance / samples);
        const uint8_t decision = i % 8 == 0 ? witness : i % 3 == 0 ? interpolated : shaded;
        const double spread = deviation * normal(random), noise = deviation * normal(random);
        const double radiance = 2 + noise;
        pixels.radiance.insert(pixels.radiance.end(), {float(radiance), float(radiance), float(radiance), 0});
        const bool drawn = decision != interpolated;
        // The mean of squares whose unbiased variance is the given one; or the variance of the mean.
        pixels.radiance.back() = float(drawn ? radiance * radiance + variance * (samples - 1) / samples : variance / samples);
        // What is interpolated at a witness has as much noise of its own, and the bias.
        if (decision == witness)
            pixels.spread.insert(pixels.spread.end(), {float(spread), float(bias + deviation * normal(random) - noise),
                                                       float(deviation * normal(random) - spread), float(variance / samples)});
        else
            pixels.spread.insert(pixels.spread.end(), {float(spread), 0, 0, 0});
        pixels.sample_count.push_back(drawn ? samples : 0);
        pixels.decision.push_back(decision);
        pixels.material.push_back(1);
    }
    return pixels;
}

// Of a frame of one material and one tile.
ErrorEstimate estimated(const RoundPixels& pixels, const ControlSet& audit = {}) {
    return estimate_error(pixels, {0}, 1, audit, {1, std::vector<uint32_t>(pixels.material.size())});
}

// Over 40,000 pixels the mean of squared normals is known to sqrt(2 / 40000) = 0.7 %, of 5,000 products to a few percent; noise of
// 2.5 % in the denominator adds three times its square.
void the_error_that_is_there_is_found(void**) {
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

void the_root_mean_square_of_pixels_is_the_frame(void**) {
    Random random(13);
    const RoundPixels pixels = synthetic(random, 5000, 0.16, 0.1);
    const ErrorEstimate estimate = estimated(pixels);
    std::vector<float> shape(5000);
    for (float& value : shape) value = float(random.uniform());
    double sum = 0;
    for (float error : pixel_errors(pixels, estimate, {0}, shape)) sum += double(error) * error;
    check_close("root mean square", std::sqrt(sum / 5000) / estimate.error(), 1, 1e-5);  // floats, summed in double precision
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

void tiles_count_their_own_witnesses(void**) {
    Random random(14);
    // Of 40 pixels a row: three tiles, the last of 8 pixels, and two rows of them.
    const ErrorEstimate estimate = estimate_error(synthetic(random, 40 * 24, 0.16, 0.1), {0}, 1, {}, tiles_of_picture(40, 24));
    assert_int_equal(estimate.tiles.size(), 6);
    uint64_t witnesses = 0, interpolated_pixels = 0;
    for (const ErrorEstimate::Tile& tile : estimate.tiles) {
        witnesses += tile.validation;
        interpolated_pixels += tile.interpolated;
    }
    assert_int_equal(witnesses, estimate.slots[0].validation);
    assert_int_equal(interpolated_pixels, estimate.slots[0].interpolated);
    // Pixels whose number is a multiple of eight are witnesses: 40 a row leave two, two and one to the tiles.
    assert_int_equal(estimate.tiles[0].validation, 16 * 2);
    assert_int_equal(estimate.tiles[2].validation, 16 * 1);
    assert_int_equal(estimate.tiles[5].validation, 8 * 1);
}

// A picture that is wrong by the same in every pixel, of which two replicates tell nothing; the audit errs by chance alone.
void an_audit_sees_what_the_spreads_do_not(void**) {
    Random random(15);
    const double scale = 2.22, wrong = 0.2, doubt = 0.1;
    for (const double factor : {0.0, 1.0}) {
        const RoundPixels pixels = synthetic(random, 20000, 0.16, 0);
        ControlSet audit;
        for (uint32_t i = 0; i < 20000; i += 8) {  // witnesses, which are shaded
            const double a = doubt * normal(random), b = doubt * normal(random);
            audit.pixels.push_back({i, float(2 + factor * wrong + 0.5 * (a + b)), float(0.5 * (a - b)), 0, 0, false});
        }
        const ErrorEstimate estimate = estimated(pixels, audit);
        // 2,500 squares of deviations of 0.2: known to a few percent; and none is within three standard errors of 0.
        const double expected = std::pow(factor * wrong / scale, 2);
        if (factor > 0)
            check_close("bias", estimate.bias / expected, 1, 0.1);
        else
            check_at_most("bias", std::abs(estimate.bias), 3 * estimate.bias_deviation + 1e-12);
    }
}

// Of a synthetic frame, as if drawn by chance: each witness, and two of the pixels that are shaded anyway, of which there are twice as many
// as are interpolated.
std::vector<uint32_t> audited_places(uint32_t count) {
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

// Interpolated pixels whose parents and witnesses all err alike, so that no witness sees it: an audit does.
void an_audit_sees_what_neighbours_share(void**) {
    Random random(18);
    const double shared = 0.2, scale = 2.22;
    RoundPixels pixels = synthetic(random, 20000, 1e-6, 0);
    ControlSet audit;
    for (const uint32_t i : audited_places(20000)) audit.pixels.push_back({i, float(pixels.radiance[4 * i] + shared), 0, 0, 0, false});
    const ErrorEstimate estimate = estimated(pixels, audit);
    check_at_most("interpolation, as witnesses see it", estimate.interpolation, 1e-6);
    check_close("error", estimate.error(), shared / scale, 0.02 * shared);
}

// Pixels that are right, but would not be if they were interpolated, while their replicates call that noise: it is the interpolated
// value that the audit holds against the truth.
void an_audit_judges_what_would_be_interpolated(void**) {
    Random random(22);
    const double wrong = 0.2, spread = 0.02, scale = 2.02;
    RoundPixels pixels = synthetic(random, 20000, 1e-6, 0);
    ControlSet audit;
    for (const uint32_t i : audited_places(20000)) {
        if (i % 8 == 0) {
            pixels.spread[4 * i] = float(spread);
            pixels.spread[4 * i + 1] = pixels.spread[4 * i + 2] = float(wrong);
        }
        audit.pixels.push_back({i, float(pixels.radiance[4 * i] + (i % 16 == 0 ? spread : i % 8 == 0 ? -spread : 0)), 0, 0, 0, false});
    }
    const ErrorEstimate estimate = estimated(pixels, audit);
    check_at_most("interpolation, as witnesses see it", estimate.interpolation, 1e-5);
    // The audit's mean is off by the spread either way: its square is a hundredth of the error's, half a hundredth of its root; at the
    // eighth of the pixels that are witnesses it is all there is, another half.
    const double expected = wrong / scale * std::sqrt(double(estimate.slots[0].interpolated) / 20000);
    check_close("error", estimate.error(), expected, 0.03 * expected);
}

// Of the pixels that might be interpolated, half were witnesses of a former round and show what they drew, which is wrong. Comparison ones
// are witnesses still: what they drew counts for as many as show it.
void what_former_witnesses_show_counts(void**) {
    Random random(29);
    const double wrong = 0.2, scale = 2.22;  // of what the audit saw
    RoundPixels pixels = synthetic(random, 24000, 1e-6, 0);
    ControlSet audit;
    uint64_t wrong_pixels = 0;
    for (uint32_t i = 0; i < 24000; ++i) {
        const bool audited = i % 8 == 0, might_be = i % 3 != 0, is = might_be && !audited && i % 3 == 1, shows_wrong = might_be && !is;
        pixels.decision[i] = is ? interpolated : audited && might_be ? witness : shaded;
        pixels.sample_count[i] = is ? 0 : 64;
        std::fill_n(&pixels.spread[4 * i], 4, 0.0f);
        if (audited && might_be) pixels.spread[4 * i + 1] = float(wrong);  // interpolated, it would be right
        if (audited) audit.pixels.push_back({i, float(pixels.radiance[4 * i] + (shows_wrong ? wrong : 0)), 0, 0, 0, false});
        wrong_pixels += shows_wrong;
    }
    const ErrorEstimate estimate = estimated(pixels, audit);
    // ChosenPixels deviate by what is wrong with what was drawn there, which counts as interpolation's; the rest is bias.
    const double expected = std::pow(wrong / scale, 2) * double(wrong_pixels) / 24000;
    check_close("error", estimate.error(), std::sqrt(expected), 0.02 * std::sqrt(expected));
}

// By the frame's own sampler: what it shows of itself is taken off, and it is silent where it knows no better.
void an_audit_of_the_same_sampler_knows_its_limits(void**) {
    ControlSet audit;
    audit.samples = 400;
    const ControlSet::Pixel biased = {0, 1, 7, 7, 0, true}, unbiased = {0, 1, 0.0625f, 0.0625f, 0, false};
    assert_true(audit.is_better_than(biased, 100) && audit.is_better_than(biased, 200) && !audit.is_better_than(biased, 300) && !audit.is_better_than(biased, 0));
    assert_true(audit.is_better_than(unbiased, 1000));
    // 0.3 of the audit's own error, which falls as samples to the power -1.2.
    const double shown = std::pow(0.25, 1.2);
    check_close("of a quarter of its samples", audit.square(biased, 1.25, 0.5, 100) / 0.25, 1 / (1 + 0.3 * shown), 1e-12);
    check_close("without bias", audit.square(unbiased, 1.25, 0.5, 100), 0.25 - 0.015625, 1e-12);
    check_close("of another", audit.squared_error_of_other(biased, 1.25, 0.5, 0.01, 100), 0.25 - 0.01 * shown, 1e-12);
}

// Pixels that err by b n^(-g / 2), all to one side, and by chance besides: of four times the samples the former shows 1 - 4^-0.6 = 0.565.
void what_an_audit_shares_is_estimated_from_chance(void**) {
    Random random(30);
    const double chance = 0.01, shown = 0.5647;
    const auto hidden_of_300 = [&](double alike) {
        CommonModeError shared;
        for (int i = 0; i < 300; ++i) shared.add(shown * alike + chance * normal(random), 0.25);
        return shared.unseen();
    };
    // The mean of 300 is known to a seventeenth of what chance makes of each: 0.0006, of 0.017 a thirtieth.
    const double alike = 0.03, hidden = alike * alike * (1 - shown * shown);
    check_close("hidden", hidden_of_300(alike), hidden, 0.1 * hidden);
    // Of chance alone, what is left of a squared normal mean above its variance: E max(Z^2 - 1, 0) = 2 phi(1) = 0.484, of a deviation
    // of 1.1: over 1,000 sets known to 0.035. (Nothing taken off, it would be 1.)
    double sum = 0;
    for (int set = 0; set < 1000; ++set) sum += hidden_of_300(0);
    check_close("hidden of chance", sum / 1000 / (chance * chance / 300 * (1 / (shown * shown) - 1)), 0.484, 0.12);
    CommonModeError one;
    one.add(0.1, 0.25);
    assert_true(one.unseen() == 0);
}

// What is common to all pixels is added to what a frame says of its bias.
void a_bias_of_all_pixels_alike_is_known_whole(void**) {
    Random random(31);
    const double wrong = 0.2;  // of 64 samples; of 256, 0.2 4^-0.6
    const RoundPixels pixels = synthetic(random, 20000, 1e-6, 0);
    ControlSet audit;
    audit.samples = 256;
    for (const uint32_t i : audited_places(20000))
        audit.pixels.push_back({i, float(pixels.radiance[4 * i] - wrong * (1 - std::pow(4, -0.6))), 0, 0, 0, true});
    const ErrorEstimate estimate = estimated(pixels, audit);
    // Relative to what the audit saw, which lies 0.087 above the truth of 1.8: one part in twenty. Of squares, visible_control_error takes off
    // one in eighteen.
    check_close("error", estimate.error() / (wrong / 1.82), 1, 0.1);
}

// Pixels whose spreads tell of twice the error that is there: an audit knows better.
void a_probe_believes_its_audit(void**) {
    Random random(16);
    const double error = 0.01;
    BiasEstimate sum;
    for (int i = 0; i < 5000; ++i) sum.add(std::pow(error * normal(random), 2), 2 * std::pow(error * normal(random), 2));
    // Means of 5,000 squares of normal deviations are known to 2 %; an audit is given all but a thousandth of the weight.
    check_close("error", sum.error() / (error * error), 1, 0.12);
    BiasEstimate none, dark;
    dark.add(0, 0);
    assert_true(none.error() == 0 && dark.error() == 0);
}

// One square of many that is far too large is as likely chance: of n alike and one of n times as much the mean is twice what it was, and
// as much in doubt. Where all are as large, they are believed.
void a_single_square_is_doubted(void**) {
    const int n = 400;
    BiasEstimate one, all;
    for (int i = 0; i < n; ++i) {
        one.add(i == 0 ? 0.001 * (n + 1) : 0.001, 0.001);
        all.add(0.002 + 0.0005 * (i % 2), 0.001);
    }
    // Ratio 2, variance 1: surprise 0, and a quarter of expected doubt in five quarters of doubt.
    check_close("one", one.error() / 0.001, 1.2, 0.001);
    check_close("all", all.error() / 0.001, 2.25, 0.001);
}

// A cut whose pixels miss light is estimated so by what has met it; not by what has not.
void a_cut_is_refuted_by_light_alone(void**) {
    const ControlSet::Pixel cut = {0, 1, 0.01f, 0.01f, 0, true};
    const auto seen = [](float mean, float deviation) { return ControlSet::Pixel{0, mean, 0, deviation, 0, false}; };
    assert_true(ControlSet::sees_more_than(seen(1.31f, 0.1f), cut) && !ControlSet::sees_more_than(seen(1.29f, 0.1f), cut));
    assert_false(ControlSet::sees_more_than(seen(0, 0), cut));
}

// Of a frame's pixels all but a few, which err most, have outgrown their audit: those few do not speak for all.
void what_has_overtaken_its_audit_is_still_counted(void**) {
    Random random(26);
    RoundPixels pixels = synthetic(random, 20000, 0.01, 0);
    ControlSet audit;
    audit.samples = 1;
    for (uint32_t i = 0; i < 400; ++i) {
        const bool wrong = i < 4;
        const uint32_t at = 24 * i + 1;  // shaded
        audit.pixels.push_back({at, float((wrong ? 1.5 : 1) * pixels.radiance[4 * at]), 0, 0, 0, !wrong});
    }
    const ErrorEstimate estimate = estimated(pixels, audit);
    // Four squares of a ninth among 400, known to their half: the mean square of the frame, not of the four.
    const double seen = 4.0 / 9 / 400;
    assert_true(estimate.bias > 0.2 * seen && estimate.bias <= seen);
}

void who_is_drawn_among_few_is_among_more(void**) {
    uint32_t few = 0, more = 0;
    std::vector<uint32_t> rows(256);
    for (uint32_t y = 0; y < 256; ++y)
        for (uint32_t x = 0; x < 256; ++x) {
            const bool drawn = is_chosen_by(x, y, 77, 1.0 / 32);
            few += drawn;
            rows[y] += drawn;
            more += is_chosen_by(x, y, 77, 1.0 / 16);
            assert_true(!drawn || is_chosen_by(x, y, 77, 1.0 / 16));
        }
    // Binomial: four standard deviations of 65,536 trials; and no row of 256 has none of its 8 or thrice as many (e^-8, 1e-6).
    check_close("a 32nd", few, 2048, 4 * std::sqrt(2048.0));
    check_close("a 16th", more, 4096, 4 * std::sqrt(4096.0));
    assert_true(*std::max_element(rows.begin(), rows.end()) < 28);
}

// A frame without bias and without an error to keep looks at no pixel; one with a time looks at fewer.
void an_audit_takes_what_it_may(void**) {
    Settings settings;
    assert_true(ControlSet::effort(settings, 30000, 0).samples == 4 * settings.samples());
    settings.set_number("accumulate", 8);
    assert_true(ControlSet::effort(settings, 30000, 0).samples == 32 * settings.samples());
    settings.set_number("accumulate", 1);
    settings.set_choice("sampler", "combined");
    assert_true(ControlSet::effort(settings, 30000, 0).part == 0);
    settings.set_number("target_error", 0.02);
    assert_true(ControlSet::effort(settings, 30000, 0).pilot > 0 && ControlSet::effort(settings, 30000, 0).samples == 0);
    settings.set_choice("sampler", "cut");
    const ControlSet::Effort planned = ControlSet::effort(settings, 30000, 0);
    assert_int_equal(planned.pilot, 91);  // (0.3 / 0.02)^(2 / 1.2)
    assert_int_equal(planned.samples, 364);
    settings.set_choice("sampler", "filtered");
    assert_int_equal(ControlSet::effort(settings, 30000, 0).samples, 1125);  // 5 / (0.02 / 0.3)^2
    settings.set_number("time_budget", 50);
    const ControlSet::Effort hurried = ControlSet::effort(settings, 30000, 250000);
    check_at_most("samples in a twentieth of the time", hurried.part * 30000 * (hurried.samples + constants::pixel_samples), 1.2 * 0.06 * 250000);
    assert_true(hurried.part * 30000 >= 64);
    // 64 pixels of 64 samples, and 30 before the first, are 6 % of 100,267.
    assert_true(ControlSet::effort(settings, 30000, 101000).part > 0 && ControlSet::effort(settings, 30000, 100000).part == 0);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_error_that_is_there_is_found),
        cmocka_unit_test(noise_is_not_taken_for_interpolation),
        cmocka_unit_test(the_root_mean_square_of_pixels_is_the_frame),
        cmocka_unit_test(a_frame_without_light_has_no_error),
        cmocka_unit_test(a_single_square_is_doubted),
        cmocka_unit_test(a_cut_is_refuted_by_light_alone),
        cmocka_unit_test(what_has_overtaken_its_audit_is_still_counted),
        cmocka_unit_test(tiles_count_their_own_witnesses),
        cmocka_unit_test(an_audit_sees_what_the_spreads_do_not),
        cmocka_unit_test(what_an_audit_shares_is_estimated_from_chance),
        cmocka_unit_test(a_bias_of_all_pixels_alike_is_known_whole),
        cmocka_unit_test(a_probe_believes_its_audit),
        cmocka_unit_test(an_audit_sees_what_neighbours_share),
        cmocka_unit_test(an_audit_judges_what_would_be_interpolated),
        cmocka_unit_test(what_former_witnesses_show_counts),
        cmocka_unit_test(an_audit_of_the_same_sampler_knows_its_limits),
        cmocka_unit_test(who_is_drawn_among_few_is_among_more),
        cmocka_unit_test(an_audit_takes_what_it_may),
    };
    return cmocka_run_group_tests_name("estimate", tests, nullptr, nullptr);
}
