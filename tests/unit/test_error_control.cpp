// Error control: how many rounds a frame takes, and how many samples each round takes of which pixels.
#include "frame/error_control.h"
#include "frame/resampling.h"
#include "numeric_testing.h"
#include "picture/decision.h"

namespace lightband {
namespace {

using namespace testing;

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
        if (budget[36] > least_samples) assert_true(predicted_noise(histogram, fewer, Allocation::least_error) > noise);
    }
    // Where the least samples do, every pixel gets them; bins above all pixels' have more, for rounds that find some of
    // them worse.
    const Budget least = plan_noise(histogram, 1e9, 1 << 20, Allocation::least_error);
    for (uint32_t bin = 0; bin <= 36; ++bin) assert_int_equal(least[bin], least_samples);
    for (uint32_t bin = 36 + bins_per_octave; bin <= 90; ++bin)
        check_close("samples an octave up", least[bin], 2.0 * least[bin - bins_per_octave], 1.5);  // both rounded
    // Noise that cannot be reached gets the maximum number of samples, and no more.
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
    ErrorControl control(settings, {1520, 1, 1}, 2, {}, 0);
    control.plan(some_histogram(), 0);
    assert_false(control.needs_another_round(estimate_of(0.03 * 0.03, 0.02 * 0.02), {}));
}

// The estimate is below the target error, but half of it is one pixel that one sample dominates, so that it is
// uncertain.
void uncertain_noise_takes_another_round(void**) {
    const Settings settings = asking("target_error", 0.05);
    ErrorControl control(settings, {1520, 1, 1}, 2, {}, 0);
    control.plan(some_histogram(), 0);
    ErrorEstimate estimate = estimate_of(0.04 * 0.04, 0);
    estimate.noise_deviation = 0.5 * 0.04 * 0.04;  // in all 0.049: more than 0.93 of 0.05
    assert_true(control.needs_another_round(estimate, {}));
    estimate.noise_deviation = 0.1 * 0.04 * 0.04;
    assert_false(control.needs_another_round(estimate, {}));
}

void noise_asks_for_samples_and_interpolation_for_levels(void**) {
    const Settings settings = asking("target_error", 0.05);
    ErrorControl control(settings, {1520, 1, 1}, 2, {}, 0);
    const Budget first = control.plan(some_histogram(), 0);
    const float scale = control.scales().of[0];
    assert_true(control.needs_another_round(estimate_of(0.2 * 0.2, 0), {}));
    assert_true(control.scales().of[0] == scale);
    check_close("part, to a quarter of the noise at most in one round", control.wanted_part(), 0.25, 0);
    // The budget stays: pixels move to other bins of it.
    assert_true(control.plan_further({}, Histogram(budget_bins), 0) == first);
    assert_true(control.needs_another_round(estimate_of(0.02 * 0.02, 0.1 * 0.1), {}));
    assert_true(control.scales().of[0] > scale);
    assert_true(control.scales().of[1] == scale);  // where no validation pixel has an error
}

// After five rounds with too large an error of interpolation, all pixels are shaded instead. Not so where the error is
// noise, where the user chose the scale, or where a time budget may not suffice.
void interpolation_is_given_up_where_no_levels_suffice(void**) {
    const struct {
        double interpolation;
        const char* also;
        double value;
        bool gives_up;
    } cases[] = {{0.1, "seed", 1, true},
                 {0.01, "seed", 1, false},
                 {0.1, "bandwidth_scale", 1, false},
                 {0.1, "time_budget", 1e6, false}};
    for (const auto& own : cases) {
        Settings settings = asking("target_error", 0.05);
        settings.set_number(own.also, own.value);
        Forecast forecast{1520, 1, 1};
        forecast.pilot_error = 1e-4;  // by which the error, not the time, governs
        forecast.pilot_samples = 64;
        ErrorControl control(settings, forecast, 2, {}, 0);
        control.plan(some_histogram(), 0);
        for (int round = 1; round <= 5; ++round) {
            assert_true(control.interpolates());
            assert_true(control.needs_another_round(estimate_of(0.2 * 0.2, own.interpolation * own.interpolation), {}));
            control.plan_further({}, Histogram(budget_bins), 0);
        }
        assert_true(control.interpolates() != own.gives_up);
    }
}

// A few validation pixels may differ by chance. While noise is large, one of them alone does not refine its tile's
// levels.
void one_validation_pixel_does_not_refine_a_tile_under_noise(void**) {
    const Settings settings = asking("target_error", 0.05);
    const double allowed = 0.7 * 0.04 * 0.04;  // noise, as ErrorControl divides the error
    for (const bool noisy : {true, false}) {
        ErrorControl control(settings, {1520, 1, 1}, 2, {}, 0);
        control.plan(some_histogram(), 0);
        const float scale = control.scales().of[0];
        ErrorEstimate estimate = estimate_of((noisy ? 2 : 0.9) * allowed, 0.03 * 0.03);
        estimate.interpolation_deviation = 0.04 * 0.04;
        estimate.tiles = {{300, 8, 0.5, 0.25}, {300, 200, 0, 0}};  // one of eight, by 70 %
        assert_true(control.needs_another_round(estimate, {}));
        assert_true((control.scales().of[0] > scale) != noisy);
    }
}

// ---- Further rounds ---------------------------------------------------------------------------------

// A tenth of all pixels, at random, varies a hundred times as much.
RoundPixels unequal(Random& random, size_t count, uint32_t samples) {
    RoundPixels pixels;
    for (size_t i = 0; i < count; ++i) {
        const double variance = random.uniform() < 0.1 ? 4 : 0.04;
        pixels.radiance.insert(pixels.radiance.end(), {2, 2, 2, float(4 + variance * (samples - 1) / samples)});
        pixels.spread.insert(pixels.spread.end(), {0, 0, 0, 0});
        pixels.sample_count.push_back(samples);
        pixels.decision.push_back(uint8_t(first_bin + share_one));
        pixels.material.push_back(1);
    }
    return pixels;
}

Budget sixty_four_at_share_one() {
    Budget budget(budget_bins);
    for (uint32_t bin = 0; bin < budget_bins; ++bin)
        budget[bin] = uint32_t(std::clamp(std::round(64 * share_of(bin)), 16.0, 65536.0));
    return budget;
}

void pixels_that_vary_most_are_resampled(void**) {
    Random random(19);
    const RoundPixels pixels = unequal(random, 10000, 64);
    const Budget budget = sixty_four_at_share_one();
    const auto varies = [&](size_t i) { return pixels.radiance[4 * i + 3] > 5; };
    // Noisy pixels are all alike: twice the samples leave at least 0.48 of the noise. Resampling the quiet ones pays
    // only below 0.3.
    for (const double part : {0.45, 0.4, 0.35}) {
        const Resampling next = plan_resampling(pixels, {}, 2, Allocation::least_error, budget, part);
        double before = 0, after = 0, resampled = 0, kept = 0;
        for (size_t i = 0; i < 10000; ++i) {
            const double more = budget[next.bins[i]] / 64.0, noise = varies(i) ? 4 : 0.04;
            const bool again = more >= least_resampling_factor;
            assert_true(varies(i) || !again);
            assert_true(again || next.bins[i] == 0);  // in a list of their own
            before += noise;
            after += again ? noise * std::pow(more, -constants::stratified_gain) : noise;
            (again ? resampled : kept) += again ? budget[next.bins[i]] : 64;
        }
        // Pixels move to whole bins, a quarter of an octave apart. At 64 samples a fifth of a pixel's variance is taken
        // from the mean of all pixels, which makes 0.12 of the quiet pixels' 0.04. That is planned to be left of them,
        // of 0.44 of all.
        check_at_most("noise left over the part that was asked for", after / before / part, 1.25);
        check_at_most("the part asked for less what quiet pixels are planned to leave", part - 0.9 * 0.12 / 0.44,
                      1.25 * after / before);
        // Resampling all pixels would need this many samples for the same noise.
        check_at_most("samples over those of resampling all", resampled,
                      0.5 * 10000 * 64 * std::pow(part, -1 / constants::stratified_gain));
        const RoundSamples all = round_samples(next.sampled, Histogram(budget_bins), budget);
        check_close("samples", all.samples, resampled, 0);
        check_close("growth", next.growth, (resampled + kept) / (64 * 10000), 1e-12);
    }
}

// The rounding of the budget does not prevent the one pixel that needs it from being resampled: twice 426.55 samples
// are 853, twice 427 are 854.
void the_pixel_that_errs_most_is_resampled(void**) {
    Random random(27);
    RoundPixels pixels = unequal(random, 10000, 427);
    const size_t worst = 5000;
    pixels.radiance[4 * worst + 3] = 1e6;
    Budget budget(budget_bins);
    for (uint32_t bin = 0; bin < budget_bins; ++bin)
        budget[bin] = uint32_t(std::clamp(std::round(426.55 * share_of(bin)), 16.0, 65536.0));
    const Resampling next = plan_resampling(pixels, {}, 2, Allocation::least_error, budget, 0.9);
    for (size_t i = 0; i < 10000; ++i)
        assert_true((budget[next.bins[i]] >= least_resampling_factor * 427) == (i == worst));
}

void further_rounds_within_a_cost_spend_it(void**) {
    Random random(20);
    const RoundPixels pixels = unequal(random, 10000, 64);
    const Resampling next = plan_resampling(pixels, {}, 2, Allocation::least_error, sixty_four_at_share_one(), 0);
    Histogram new_pixels(budget_bins);
    new_pixels[share_one] = 500;
    for (const double cost : {5e5, 5e6, 5e7}) {
        const Budget budget = replan_cost(next.sampled, new_pixels, cost, 30, 1 << 20);
        const RoundSamples all = round_samples(next.sampled, new_pixels, budget);
        check_at_most("cost", all.samples + 30 * all.pixels, cost);
        // Two kinds of pixels: one may be left out for want of samples for all of it.
        check_at_most("cost that is left", cost, 4 * (all.samples + 30 * all.pixels));
        assert_true(cost < 5e6 || all.pixels == 10500);
    }
}

// A pixel counts as often as others are interpolated from it.
void lattice_points_are_resampled_first(void**) {
    Random random(21);
    RoundPixels pixels = unequal(random, 10000, 64);
    for (size_t i = 0; i < 10000; ++i) pixels.radiance[4 * i + 3] = 4.04f;
    std::vector<float> areas(10000, 1);
    for (size_t i = 0; i < 10000; ++i)
        if (i % 100 % 4 == 0 && i / 100 % 4 == 0) areas[i] = 16;
    const Resampling next = plan_resampling(pixels, areas, 2, Allocation::least_error, sixty_four_at_share_one(), 0.7);
    for (size_t i = 0; i < 10000; ++i) {
        assert_true((sixty_four_at_share_one()[next.bins[i]] >= 128) == (areas[i] > 1));
    }
}

// ---- First rounds -----------------------------------------------------------------------------------

// 1000 pixels in a second at 1000 samples a millisecond have some 900 samples each. With interpolation each shaded
// pixel needs 2.2 times as many, which suffices where there are few of them.
void pixels_are_interpolated_in_time_where_it_pays(void**) {
    const Settings settings = asking("time_budget", 1000);
    Throughput throughput;
    throughput.samples_per_millisecond = 1000;
    for (const uint64_t pixels : {300, 800}) {
        ErrorControl control(settings, {1000, 1, 1}, 2, throughput, 0);
        Histogram histogram(budget_bins);
        histogram[share_one] = pixels;
        assert_true(control.replan(histogram, 0) == (pixels > 500));
        assert_true(control.interpolates() == (pixels < 500));
    }
}

Forecast with_pilot_error(double error) {
    Forecast forecast{1000, 1, 1};
    forecast.pilot_error = error;
    forecast.pilot_samples = 64;
    return forecast;
}

// Pilot samples, 64 a pixel, have as much noise as is allowed. With interpolation's share of the error and the margin
// of a first round, each shaded pixel takes 2.2 times the samples, and has a fixed cost of 30 more. Shading all pixels
// pays where more than (64 + 30) / (2.2 * 64 + 30) = 0.55 of them would be shaded.
void pixels_are_interpolated_where_it_pays(void**) {
    const Settings settings = asking("target_error", 0.02);
    for (const uint64_t pixels : {300, 800}) {
        ErrorControl control(settings, with_pilot_error(std::pow(0.8 * 0.02, 2)), 2, {}, 0);
        Histogram histogram(budget_bins);
        histogram[share_one] = pixels;
        assert_true(control.interpolates());
        assert_true(control.replan(histogram, 0) == (pixels > 500));
        assert_true(control.interpolates() == (pixels < 500));
    }
}

// Equal pixels get the samples that reduce the pilot samples' error to what is allowed, less a margin, whatever their
// bin is.
void pilot_samples_plan_the_first_round(void**) {
    const Settings settings = asking("target_error", 0.02);
    const double planned = 0.55 * 0.7 * std::pow(0.8 * 0.02, 2);
    for (const uint32_t bin : {3u, share_one, budget_bins - 1}) {
        ErrorControl control(settings, with_pilot_error(1e-3), 2, {}, 0);
        Histogram histogram(budget_bins);
        histogram[bin] = 1000;
        // Samples are whole numbers: of some 300, a half is a six-hundredth.
        check_close("samples", control.plan(histogram, 0)[bin] / (64 * std::pow(1e-3 / planned, 1 / 1.2)), 1,
                    1.0 / 300);
    }
}

// Whichever comes first governs: a second suffices for the target error that shading all 1000 pixels reaches in 0.3 s,
// but not for the one that takes 4 s.
void a_target_error_governs_where_there_is_time_for_it(void**) {
    Throughput throughput;
    throughput.samples_per_millisecond = 1000;
    for (const auto& [target, governs] : {std::pair(0.01, true), {0.002, false}}) {
        Settings settings = asking("time_budget", 1000);
        settings.set_number("target_error", target);
        ErrorControl control(settings, with_pilot_error(std::pow(0.8 * 0.01, 2) * std::pow(4, 1.2)), 2, throughput, 0);
        Histogram histogram(budget_bins);
        histogram[share_one] = 1000;
        control.replan(histogram, 0);
        const double each = control.plan(histogram, 0)[share_one];
        // 64 samples leave 4^1.2 times the noise that is allowed, so 256 are needed; or the first of two rounds has
        // 0.15 s for all pixels.
        check_close("samples of each", each, governs ? 256 : 0.15 * 1000 - constants::pixel_samples, 1);
    }
}

void a_time_budget_is_divided_between_two_rounds(void**) {
    const Settings settings = asking("time_budget", 1000);
    Throughput throughput;
    throughput.samples_per_millisecond = 1000;
    throughput.round_milliseconds = 20;
    ErrorControl control(settings, {1520, 1, 1}, 2, throughput, 10);
    const Histogram histogram = some_histogram();
    const auto samples = [&](const Budget& budget) {
        double sum = 0;
        for (uint32_t bin = 0; bin < budget_bins; ++bin) sum += double(histogram[bin]) * budget[bin];
        return sum;
    };
    const double first = samples(control.plan(histogram, 10));
    // The fixed cost of 1,520 pixels is subtracted from the time.
    const double before_first = 1520 * constants::pixel_samples;
    check_close("first round, milliseconds", (first + before_first) / 1000, 0.15 * (1000 - 10 - 12), 2);
    RoundCost cost;
    cost.samples = uint64_t(first);
    cost.pixels = 1520;
    cost.shading_milliseconds = 2 * (first + before_first) / 1000;  // half as fast as the throughput model says
    cost.other_milliseconds = 20;
    cost.elapsed_milliseconds = 10 + cost.shading_milliseconds + 20;
    assert_true(control.needs_another_round(estimate_of(0.01, 0), cost));
    const std::vector<SampledGroup> sampled = {{30, 16, 1000}, {33, 16, 500}, {36, 16, 20}};
    const Budget second = control.plan_further(sampled, Histogram(budget_bins), cost.elapsed_milliseconds);
    check_close("second round, milliseconds", (samples(second) + before_first) / 500,
                1000 - cost.elapsed_milliseconds - 12, 4);
    cost.elapsed_milliseconds = 990;
    assert_false(control.needs_another_round(estimate_of(0.01, 0), cost));
    // A round in which shaders were compiled does not change the throughput of later rounds, which find them compiled.
    const double before = control.throughput().samples_per_millisecond;
    cost.made_programs = true;
    cost.shading_milliseconds *= 10;
    control.needs_another_round(estimate_of(0.01, 0), cost);
    check_close("throughput", control.throughput().samples_per_millisecond, before, 0);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_budget_reaches_the_noise_asked_with_the_fewest_samples),
        cmocka_unit_test(rounds_stop_where_the_error_is_reached),
        cmocka_unit_test(noise_asks_for_samples_and_interpolation_for_levels),
        cmocka_unit_test(interpolation_is_given_up_where_no_levels_suffice),
        cmocka_unit_test(one_validation_pixel_does_not_refine_a_tile_under_noise),
        cmocka_unit_test(uncertain_noise_takes_another_round),
        cmocka_unit_test(the_pixel_that_errs_most_is_resampled),
        cmocka_unit_test(pixels_that_vary_most_are_resampled),
        cmocka_unit_test(further_rounds_within_a_cost_spend_it),
        cmocka_unit_test(lattice_points_are_resampled_first),
        cmocka_unit_test(pixels_are_interpolated_where_it_pays),
        cmocka_unit_test(pixels_are_interpolated_in_time_where_it_pays),
        cmocka_unit_test(pilot_samples_plan_the_first_round),
        cmocka_unit_test(a_target_error_governs_where_there_is_time_for_it),
        cmocka_unit_test(a_time_budget_is_divided_between_two_rounds),
    };
    return cmocka_run_group_tests_name("control", tests, nullptr, nullptr);
}
