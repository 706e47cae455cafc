// Error control: what rounds estimate of their error, and what is planned from it.
#include "frame/control.h"
#include "frame/decision.h"
#include "frame/estimate.h"
#include "numeric_testing.h"

namespace lightband {
namespace {

using namespace testing;

constexpr uint8_t interpolated = 1, shaded = 40, witness = shaded | witness_bit;

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
        // Two independent deviations of the two replicates from the interpolated value.
        const double a = bias + 2 * deviation * normal(random), b = bias + 2 * deviation * normal(random);
        pixels.spread.insert(pixels.spread.end(), {float(spread), decision == witness ? float(a * b) : 0});
        pixels.sample_count.push_back(drawn ? samples : 0);
        pixels.decision.push_back(decision);
        pixels.material.push_back(1);
    }
    return pixels;
}

// Over 40,000 pixels the mean of squared normals is known to sqrt(2 / 40000) = 0.7 %, of 5,000 products to a few percent; noise of
// 2.5 % in the denominator adds three times its square.
void the_error_that_is_there_is_found(void**) {
    Random random(11);
    const double variance = 0.16, bias = 0.1, scale = 2.02;
    const ErrorEstimate estimate = estimate_error(synthetic(random, 40000, variance, bias), {0}, 1, {});
    const double noise = variance / 64 / (scale * scale);
    check_close("noise", estimate.noise / noise, 1, 0.03);
    check_close("stratification", estimate.stratification, 1, 0.03);
    const double part = double(estimate.slots[0].interpolated) / 40000;
    check_close("interpolation", estimate.interpolation / (bias * bias / (scale * scale) * part), 1, 0.1);
    check_close("error", estimate.error(), std::sqrt(estimate.noise + estimate.interpolation), 0);
}

void noise_is_not_taken_for_interpolation(void**) {
    Random random(12);
    const ErrorEstimate estimate = estimate_error(synthetic(random, 40000, 0.64, 0), {0}, 1, {});
    // A mean of 5,000 products of independent normals is within four standard errors of 0.
    assert_true(estimate.slots[0].interpolation <= 4 * estimate.slots[0].interpolation_deviation);
}

void the_root_mean_square_of_pixels_is_the_frame(void**) {
    Random random(13);
    const RoundPixels pixels = synthetic(random, 5000, 0.16, 0.1);
    const ErrorEstimate estimate = estimate_error(pixels, {0}, 1, {});
    std::vector<float> shape(5000);
    for (float& value : shape) value = float(random.uniform());
    double sum = 0;
    for (float error : pixel_errors(pixels, estimate, {0}, shape)) sum += double(error) * error;
    check_close("root mean square", std::sqrt(sum / 5000) / estimate.error(), 1, 1e-5);  // floats, summed in double precision
}

void a_frame_without_light_has_no_error(void**) {
    RoundPixels pixels;
    pixels.radiance.assign(40, 0);
    pixels.spread.assign(20, 0);
    pixels.sample_count.assign(10, 8);
    pixels.decision.assign(10, shaded);
    pixels.material.assign(10, 1);
    assert_true(estimate_error(pixels, {0}, 1, {}).error() == 0);
    pixels.material.assign(10, 0);
    assert_true(estimate_error(pixels, {0}, 1, {}).error() == 0);
}

// ---- Planning ---------------------------------------------------------------------------------------

Histogram some_histogram() {
    Histogram histogram(budget_bins);
    histogram[30] = 1000;
    histogram[33] = 500;
    histogram[36] = 20;
    return histogram;
}

void a_budget_reaches_the_noise_asked_with_the_fewest_samples(void**) {
    const Histogram histogram = some_histogram();
    for (const double noise : {100.0, 10.0, 1.0, 0.1}) {
        const Budget budget = plan_noise(histogram, noise, 1 << 20, Allocation::least_error);
        check_at_most("noise", predicted_noise(histogram, budget, Allocation::least_error), noise);
        // A tenth less of every sample misses it: but for the least number that every pixel gets.
        Budget fewer = budget;
        for (uint32_t& samples : fewer) samples = std::max(least_samples, uint32_t(0.9 * samples));
        if (fewer != budget) assert_true(predicted_noise(histogram, fewer, Allocation::least_error) > noise);
    }
    // What cannot be reached is approached as far as the most samples let.
    for (uint32_t samples : plan_noise(histogram, 0, 128, Allocation::least_error)) assert_true(samples <= 128);
}

Settings asking(const char* name, double value) {
    Settings settings;
    settings.set_number(name, value);
    return settings;
}

ErrorEstimate estimate_of(double noise, double interpolation) {
    ErrorEstimate estimate;
    estimate.noise = noise;
    estimate.interpolation = interpolation;
    estimate.slots = {{1000, 600, 100, interpolation, 0}};
    // Two tiles; the first holds all of the error.
    const double mean = interpolation * 1520 / 300;
    estimate.tiles = {{300, 50, 50 * mean, 50 * mean * mean}, {300, 50, 0, 0}};
    return estimate;
}

void rounds_stop_where_the_error_is_reached(void**) {
    const Settings settings = asking("target_error", 0.05);
    Control control(settings, {1520, 1, 1}, 2, {}, 0);
    control.plan(some_histogram(), 0);
    assert_false(control.again(estimate_of(0.03 * 0.03, 0.02 * 0.02), {}));
}

void noise_asks_for_samples_and_interpolation_for_levels(void**) {
    const Settings settings = asking("target_error", 0.05);
    Control control(settings, {1520, 1, 1}, 2, {}, 0);
    const Budget first = control.plan(some_histogram(), 0);
    const float scale = control.scales()[0];
    assert_true(control.again(estimate_of(0.2 * 0.2, 0), {}));
    assert_true(control.scales()[0] == scale);
    const Budget second = control.plan(some_histogram(), 0);
    // To a quarter of the noise at most in one round: by four times the samples, less what stratified ones gain.
    assert_true(second[33] > 3 * first[33] && second[33] <= 4 * first[33]);
    assert_true(control.again(estimate_of(0.02 * 0.02, 0.1 * 0.1), {}));
    assert_true(control.scales()[0] > scale);
    assert_true(control.scales()[1] == scale);  // where no witness saw any error
}

// Few witnesses may see an error by chance: while there is noise to blame, a tile's are not believed alone.
void a_single_witness_is_doubted_while_there_is_noise(void**) {
    const Settings settings = asking("target_error", 0.05);
    const double allowed = 0.7 * 0.0415 * 0.0415;  // noise, as Control shares it
    for (const bool noisy : {true, false}) {
        Control control(settings, {1520, 1, 1}, 2, {}, 0);
        control.plan(some_histogram(), 0);
        const float scale = control.scales()[0];
        ErrorEstimate estimate = estimate_of((noisy ? 2 : 0.9) * allowed, 0.03 * 0.03);
        estimate.interpolation_deviation = 0.04 * 0.04;
        estimate.tiles = {{300, 8, 0.5, 0.25}, {300, 200, 0, 0}};  // one of eight, by 70 %
        assert_true(control.again(estimate, {}));
        assert_true((control.scales()[0] > scale) != noisy);
    }
}

void tiles_count_their_own_witnesses(void**) {
    Random random(14);
    RoundPixels pixels = synthetic(random, 40 * 24, 0.16, 0.1);
    pixels.width = 40;  // three tiles a row, the last of 8 pixels, and two rows of them
    const ErrorEstimate estimate = estimate_error(pixels, {0}, 1, {});
    assert_int_equal(estimate.tiles.size(), 6);
    uint64_t witnesses = 0, interpolated_pixels = 0;
    for (const ErrorEstimate::Tile& tile : estimate.tiles) {
        witnesses += tile.witnesses;
        interpolated_pixels += tile.interpolated;
    }
    assert_int_equal(witnesses, estimate.slots[0].witnesses);
    assert_int_equal(interpolated_pixels, estimate.slots[0].interpolated);
    // Pixels whose number is a multiple of eight are witnesses: 40 a row leave two, two and one to the tiles.
    assert_int_equal(estimate.tiles[0].witnesses, 16 * 2);
    assert_int_equal(estimate.tiles[2].witnesses, 16 * 1);
    assert_int_equal(estimate.tiles[5].witnesses, 8 * 1);
}

// A picture that is wrong by the same in every pixel, of which two replicates tell nothing; the audit's two err by chance alone.
void an_audit_sees_what_the_spreads_do_not(void**) {
    Random random(15);
    const double scale = 2.02, wrong = 0.2, doubt = 0.1;
    for (const double factor : {0.0, 1.0}) {
        const RoundPixels pixels = synthetic(random, 20000, 0.16, 0);
        Audit audit;
        for (uint32_t i = 0; i < 20000; i += 8) {  // witnesses, which are shaded
            const double a = doubt * normal(random), b = doubt * normal(random);
            audit.at.push_back(i);
            audit.mean.push_back(float(2 + factor * wrong + 0.5 * (a + b)));
            audit.spread.push_back(float(0.5 * (a - b)));
        }
        const ErrorEstimate estimate = estimate_error(pixels, {0}, 1, audit);
        // 2,500 products of deviations of 0.2: known to a few percent; and none is within three standard errors of 0.
        const double expected = std::pow(factor * wrong / scale, 2);
        if (factor > 0)
            check_close("bias", estimate.bias / expected, 1, 0.1);
        else
            check_at_most("bias", std::abs(estimate.bias), 3 * estimate.bias_deviation + 1e-12);
    }
}

// Probed pixels whose spreads tell of twice the error that is there: an audit knows better.
void a_probe_believes_its_audit(void**) {
    Random random(16);
    const double error = 0.01, doubt = 0.003;
    std::vector<Probed> pixels;
    for (int i = 0; i < 5000; ++i) {
        const double audit_spread = doubt * normal(random);
        pixels.push_back({std::sqrt(2.0) * error * normal(random), error * normal(random) + doubt * normal(random), audit_spread});
    }
    // Means of 5,000 squares of normal deviations are known to 2 %; an audit is given all but a hundredth of the weight.
    check_close("without an audit", probed_error(pixels, false) / (error * error), 2, 2 * 0.08);
    check_close("with one", probed_error(pixels, true) / (error * error), 1, 0.12);
    assert_true(probed_error({}, true) == 0 && probed_error({{0, 0, 0}}, true) == 0);
}

// Pixels that are all alike get what takes the probe's error to what is allowed, less a margin; whatever their share says of it.
void a_probe_plans_the_first_round(void**) {
    const Settings settings = asking("target_error", 0.02);
    const double probed = 1e-3, planned = 0.55 * 0.7 * std::pow(0.83 * 0.02, 2);
    for (const uint32_t bin : {3u, budget_bins / 2, budget_bins - 1}) {
        Forecast forecast{1000, 1, 1};
        forecast.probed_error = probed;
        Control control(settings, forecast, 2, {}, 0);
        Histogram histogram(budget_bins);
        histogram[bin] = 1000;
        // Samples are whole numbers: of some 300, a half is a six-hundredth.
        check_close("samples", control.plan(histogram, 0)[bin] / (Audit::probe_samples * std::pow(probed / planned, 1 / 1.2)), 1, 1.0 / 300);
    }
}

void who_is_drawn_among_few_is_among_more(void**) {
    uint32_t few = 0, more = 0;
    std::vector<uint32_t> rows(256);
    for (uint32_t y = 0; y < 256; ++y)
        for (uint32_t x = 0; x < 256; ++x) {
            const bool drawn = is_drawn(x, y, 77, 1.0 / 32);
            few += drawn;
            rows[y] += drawn;
            more += is_drawn(x, y, 77, 1.0 / 16);
            assert_true(!drawn || is_drawn(x, y, 77, 1.0 / 16));
        }
    // Binomial: four standard deviations of 65,536 trials; and no row of 256 has none of its 8 or thrice as many (e^-8, 1e-6).
    check_close("a 32nd", few, 2048, 4 * std::sqrt(2048.0));
    check_close("a 16th", more, 4096, 4 * std::sqrt(4096.0));
    assert_true(*std::max_element(rows.begin(), rows.end()) < 28);
}

// A frame without bias and without an error to keep looks at no pixel; one with a time looks at fewer.
void an_audit_takes_what_it_may(void**) {
    Settings settings;
    assert_true(Audit::effort(settings, 30000, 5000).samples == 4 * settings.samples());
    settings.set_choice("sampler", "combined");
    assert_true(Audit::effort(settings, 30000, 5000).part == 0);
    settings.set_number("target_error", 0.02);
    assert_true(Audit::effort(settings, 30000, 5000).probe > 0 && Audit::effort(settings, 30000, 5000).samples == 0);
    settings.set_choice("sampler", "cut");
    assert_int_equal(Audit::effort(settings, 30000, 5000).samples, 1250);  // half the inverse square of the error
    settings.set_number("time_budget", 50);
    const Audit::Effort hurried = Audit::effort(settings, 30000, 5000);
    check_at_most("samples in a twentieth of the time", hurried.part * 30000 * (hurried.samples + Pace::pixel_samples), 1.2 * 0.06 * 50 * 5000);
}

void a_time_is_shared_between_two_rounds(void**) {
    const Settings settings = asking("time_budget", 1000);
    Pace pace;
    pace.samples_per_millisecond = 1000;
    pace.round_milliseconds = 20;
    Control control(settings, {1520, 1, 1}, 2, pace, 10);
    const Histogram histogram = some_histogram();
    const auto samples = [&](const Budget& budget) {
        double sum = 0;
        for (uint32_t bin = 0; bin < budget_bins; ++bin) sum += double(histogram[bin]) * budget[bin];
        return sum;
    };
    const double first = samples(control.plan(histogram, 10));
    // What 1,520 pixels cost before their first sample is taken off the time.
    const double before_first = 1520 * Pace::pixel_samples;
    check_close("first round, milliseconds", (first + before_first) / 1000, 0.15 * (1000 - 10 - 12), 2);
    RoundCost cost;
    cost.samples = uint64_t(first);
    cost.pixels = 1520;
    cost.shading_milliseconds = 2 * (first + before_first) / 1000;  // half as fast as it was thought to be
    cost.other_milliseconds = 20;
    cost.elapsed_milliseconds = 10 + cost.shading_milliseconds + 20;
    assert_true(control.again(estimate_of(0.01, 0), cost));
    const double second = samples(control.plan(histogram, cost.elapsed_milliseconds));  // all are drawn anew
    check_close("second round, milliseconds", (second + before_first) / 500, 1000 - cost.elapsed_milliseconds - 12, 4);
    cost.elapsed_milliseconds = 990;
    assert_false(control.again(estimate_of(0.01, 0), cost));
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
        cmocka_unit_test(a_budget_reaches_the_noise_asked_with_the_fewest_samples),
        cmocka_unit_test(rounds_stop_where_the_error_is_reached),
        cmocka_unit_test(noise_asks_for_samples_and_interpolation_for_levels),
        cmocka_unit_test(a_single_witness_is_doubted_while_there_is_noise),
        cmocka_unit_test(tiles_count_their_own_witnesses),
        cmocka_unit_test(an_audit_sees_what_the_spreads_do_not),
        cmocka_unit_test(a_probe_believes_its_audit),
        cmocka_unit_test(a_probe_plans_the_first_round),
        cmocka_unit_test(who_is_drawn_among_few_is_among_more),
        cmocka_unit_test(an_audit_takes_what_it_may),
        cmocka_unit_test(a_time_is_shared_between_two_rounds),
    };
    return cmocka_run_group_tests_name("control", tests, nullptr, nullptr);
}
