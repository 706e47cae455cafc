// Error control: what rounds estimate of their error, and what is planned from it.
#include "frame/control.h"
#include "picture/decision.h"
#include "frame/estimate.h"
#include "frame/redraw.h"
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
ErrorEstimate estimated(const RoundPixels& pixels, const Audit& audit = {}) {
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
    // Where the least samples do, every pixel gets them; bins above all pixels' have more, for rounds that find some of them worse.
    const Budget least = plan_noise(histogram, 1e9, 1 << 20, Allocation::least_error);
    for (uint32_t bin = 0; bin <= 36; ++bin) assert_int_equal(least[bin], least_samples);
    for (uint32_t bin = 36 + bins_per_octave; bin <= 90; ++bin)
        check_close("samples an octave up", least[bin], 2.0 * least[bin - bins_per_octave], 1.5);  // both rounded
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

// The error is reached; but where half of it is one pixel that one sample made, that is only how it looks.
void noise_of_one_sample_is_not_believed(void**) {
    const Settings settings = asking("target_error", 0.05);
    Control control(settings, {1520, 1, 1}, 2, {}, 0);
    control.plan(some_histogram(), 0);
    ErrorEstimate estimate = estimate_of(0.04 * 0.04, 0);
    estimate.noise_deviation = 0.5 * 0.04 * 0.04;  // in all 0.049: more than 0.93 of 0.05
    assert_true(control.again(estimate, {}));
    estimate.noise_deviation = 0.1 * 0.04 * 0.04;
    assert_false(control.again(estimate, {}));
}

void noise_asks_for_samples_and_interpolation_for_levels(void**) {
    const Settings settings = asking("target_error", 0.05);
    Control control(settings, {1520, 1, 1}, 2, {}, 0);
    const Budget first = control.plan(some_histogram(), 0);
    const float scale = control.scales().of[0];
    assert_true(control.again(estimate_of(0.2 * 0.2, 0), {}));
    assert_true(control.scales().of[0] == scale);
    check_close("part, to a quarter of the noise at most in one round", control.wanted_part(), 0.25, 0);
    // The budget stays: pixels move to other bins of it.
    assert_true(control.plan_further({}, Histogram(budget_bins), 0) == first);
    assert_true(control.again(estimate_of(0.02 * 0.02, 0.1 * 0.1), {}));
    assert_true(control.scales().of[0] > scale);
    assert_true(control.scales().of[1] == scale);  // where no witness saw any error
}

// After five rounds whose interpolation errs too much, pixels are shaded instead; not where noise is to blame, a user chose the scale, or a
// time may not last.
void what_no_levels_are_found_for_is_not_interpolated(void**) {
    const struct {
        double interpolation;
        const char* also;
        double value;
        bool gives_up;
    } cases[] = {{0.1, "seed", 1, true}, {0.01, "seed", 1, false}, {0.1, "bandwidth_scale", 1, false}, {0.1, "time_budget", 1e6, false}};
    for (const auto& own : cases) {
        Settings settings = asking("target_error", 0.05);
        settings.set_number(own.also, own.value);
        Forecast forecast{1520, 1, 1};
        forecast.probed_error = 1e-4;  // by which the error, not the time, governs
        forecast.probe_samples = 64;
        Control control(settings, forecast, 2, {}, 0);
        control.plan(some_histogram(), 0);
        for (int round = 1; round <= 5; ++round) {
            assert_true(control.interpolates());
            assert_true(control.again(estimate_of(0.2 * 0.2, own.interpolation * own.interpolation), {}));
            control.plan_further({}, Histogram(budget_bins), 0);
        }
        assert_true(control.interpolates() != own.gives_up);
    }
}

// Few witnesses may see an error by chance: while there is noise to blame, a tile's are not believed alone.
void a_single_witness_is_doubted_while_there_is_noise(void**) {
    const Settings settings = asking("target_error", 0.05);
    const double allowed = 0.7 * 0.04 * 0.04;  // noise, as Control shares it
    for (const bool noisy : {true, false}) {
        Control control(settings, {1520, 1, 1}, 2, {}, 0);
        control.plan(some_histogram(), 0);
        const float scale = control.scales().of[0];
        ErrorEstimate estimate = estimate_of((noisy ? 2 : 0.9) * allowed, 0.03 * 0.03);
        estimate.interpolation_deviation = 0.04 * 0.04;
        estimate.tiles = {{300, 8, 0.5, 0.25}, {300, 200, 0, 0}};  // one of eight, by 70 %
        assert_true(control.again(estimate, {}));
        assert_true((control.scales().of[0] > scale) != noisy);
    }
}

void tiles_count_their_own_witnesses(void**) {
    Random random(14);
    // Of 40 pixels a row: three tiles, the last of 8 pixels, and two rows of them.
    const ErrorEstimate estimate = estimate_error(synthetic(random, 40 * 24, 0.16, 0.1), {0}, 1, {}, tiles_of_picture(40, 24));
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

// A picture that is wrong by the same in every pixel, of which two replicates tell nothing; the audit errs by chance alone.
void an_audit_sees_what_the_spreads_do_not(void**) {
    Random random(15);
    const double scale = 2.22, wrong = 0.2, doubt = 0.1;
    for (const double factor : {0.0, 1.0}) {
        const RoundPixels pixels = synthetic(random, 20000, 0.16, 0);
        Audit audit;
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
    Audit audit;
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
    Audit audit;
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

// Of the pixels that might be interpolated, half were witnesses of a former round and show what they drew, which is wrong. Audited ones
// are witnesses still: what they drew counts for as many as show it.
void what_former_witnesses_show_counts(void**) {
    Random random(29);
    const double wrong = 0.2, scale = 2.22;  // of what the audit saw
    RoundPixels pixels = synthetic(random, 24000, 1e-6, 0);
    Audit audit;
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
    // Witnesses deviate by what is wrong with what was drawn there, which counts as interpolation's; the rest is bias.
    const double expected = std::pow(wrong / scale, 2) * double(wrong_pixels) / 24000;
    check_close("error", estimate.error(), std::sqrt(expected), 0.02 * std::sqrt(expected));
}

// By the frame's own sampler: what it shows of itself is taken off, and it is silent where it knows no better.
void an_audit_of_the_same_sampler_knows_its_limits(void**) {
    Audit audit;
    audit.samples = 400;
    const Audit::Pixel biased = {0, 1, 7, 7, 0, true}, unbiased = {0, 1, 0.0625f, 0.0625f, 0, false};
    assert_true(audit.tells_of(biased, 100) && audit.tells_of(biased, 200) && !audit.tells_of(biased, 300) && !audit.tells_of(biased, 0));
    assert_true(audit.tells_of(unbiased, 1000));
    // 0.3 of the audit's own error, which falls as samples to the power -1.2.
    const double shown = std::pow(0.25, 1.2);
    check_close("of a quarter of its samples", audit.square(biased, 1.25, 0.5, 100) / 0.25, 1 / (1 + 0.3 * shown), 1e-12);
    check_close("without bias", audit.square(unbiased, 1.25, 0.5, 100), 0.25 - 0.015625, 1e-12);
    check_close("of another", audit.square_of_other(biased, 1.25, 0.5, 0.01, 100), 0.25 - 0.01 * shown, 1e-12);
}

// Pixels that err by b n^(-g / 2), all to one side, and by chance besides: of four times the samples the former shows 1 - 4^-0.6 = 0.565.
void what_an_audit_shares_is_told_from_chance(void**) {
    Random random(30);
    const double chance = 0.01, shown = 0.5647;
    const auto hidden_of_300 = [&](double alike) {
        SharedError shared;
        for (int i = 0; i < 300; ++i) shared.add(shown * alike + chance * normal(random), 0.25);
        return shared.hidden();
    };
    // The mean of 300 is known to a seventeenth of what chance makes of each: 0.0006, of 0.017 a thirtieth.
    const double alike = 0.03, hidden = alike * alike * (1 - shown * shown);
    check_close("hidden", hidden_of_300(alike), hidden, 0.1 * hidden);
    // Of chance alone, what is left of a squared normal mean above its variance: E max(Z^2 - 1, 0) = 2 phi(1) = 0.484, of a deviation
    // of 1.1: over 1,000 sets known to 0.035. (Nothing taken off, it would be 1.)
    double sum = 0;
    for (int set = 0; set < 1000; ++set) sum += hidden_of_300(0);
    check_close("hidden of chance", sum / 1000 / (chance * chance / 300 * (1 / (shown * shown) - 1)), 0.484, 0.12);
    SharedError one;
    one.add(0.1, 0.25);
    assert_true(one.hidden() == 0);
}

// What is common to all pixels is added to what a frame says of its bias.
void a_bias_of_all_pixels_alike_is_known_whole(void**) {
    Random random(31);
    const double wrong = 0.2;  // of 64 samples; of 256, 0.2 4^-0.6
    const RoundPixels pixels = synthetic(random, 20000, 1e-6, 0);
    Audit audit;
    audit.samples = 256;
    for (const uint32_t i : audited_places(20000))
        audit.pixels.push_back({i, float(pixels.radiance[4 * i] - wrong * (1 - std::pow(4, -0.6))), 0, 0, 0, true});
    const ErrorEstimate estimate = estimated(pixels, audit);
    // Relative to what the audit saw, which lies 0.087 above the truth of 1.8: one part in twenty. Of squares, shown_of_audit takes off
    // one in eighteen.
    check_close("error", estimate.error() / (wrong / 1.82), 1, 0.1);
}

// Pixels whose spreads tell of twice the error that is there: an audit knows better.
void a_probe_believes_its_audit(void**) {
    Random random(16);
    const double error = 0.01;
    AuditSum sum;
    for (int i = 0; i < 5000; ++i) sum.add(std::pow(error * normal(random), 2), 2 * std::pow(error * normal(random), 2));
    // Means of 5,000 squares of normal deviations are known to 2 %; an audit is given all but a thousandth of the weight.
    check_close("error", sum.error() / (error * error), 1, 0.12);
    AuditSum none, dark;
    dark.add(0, 0);
    assert_true(none.error() == 0 && dark.error() == 0);
}

// One square of many that is far too large is as likely chance: of n alike and one of n times as much the mean is twice what it was, and
// as much in doubt. Where all are as large, they are believed.
void a_single_square_is_doubted(void**) {
    const int n = 400;
    AuditSum one, all;
    for (int i = 0; i < n; ++i) {
        one.add(i == 0 ? 0.001 * (n + 1) : 0.001, 0.001);
        all.add(0.002 + 0.0005 * (i % 2), 0.001);
    }
    // Ratio 2, variance 1: surprise 0, and a quarter of expected doubt in five quarters of doubt.
    check_close("one", one.error() / 0.001, 1.2, 0.001);
    check_close("all", all.error() / 0.001, 2.25, 0.001);
}

// A cut whose pixels miss light is told so by what has met it; not by what has not.
void a_cut_is_refuted_by_light_alone(void**) {
    const Audit::Pixel cut = {0, 1, 0.01f, 0.01f, 0, true};
    const auto seen = [](float mean, float deviation) { return Audit::Pixel{0, mean, 0, deviation, 0, false}; };
    assert_true(Audit::refutes(seen(1.31f, 0.1f), cut) && !Audit::refutes(seen(1.29f, 0.1f), cut));
    assert_false(Audit::refutes(seen(0, 0), cut));
}

// Of a frame's pixels all but a few, which err most, have overtaken their audit: those few do not speak for all.
void what_has_overtaken_its_audit_is_still_counted(void**) {
    Random random(26);
    RoundPixels pixels = synthetic(random, 20000, 0.01, 0);
    Audit audit;
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
    for (uint32_t bin = 0; bin < budget_bins; ++bin) budget[bin] = uint32_t(std::clamp(std::round(64 * share_of(bin)), 16.0, 65536.0));
    return budget;
}

void what_varies_most_is_drawn_anew(void**) {
    Random random(19);
    const RoundPixels pixels = unequal(random, 10000, 64);
    const Budget budget = sixty_four_at_share_one();
    const auto varies = [&](size_t i) { return pixels.radiance[4 * i + 3] > 5; };
    // Noisy pixels are all alike: twice the samples leave 0.48 at least. Quiet ones are worth redrawing below 0.3.
    for (const double part : {0.45, 0.4, 0.35}) {
        const Redraw next = redraw(pixels, {}, 2, Allocation::least_error, budget, part);
        double before = 0, after = 0, drawn = 0, kept = 0;
        for (size_t i = 0; i < 10000; ++i) {
            const double more = budget[next.bins[i]] / 64.0, noise = varies(i) ? 4 : 0.04;
            const bool anew = more >= worth_redrawing;
            assert_true(varies(i) || !anew);
            assert_true(anew || next.bins[i] == 0);  // listed apart
            before += noise;
            after += anew ? noise * std::pow(more, -stratified_gain) : noise;
            (anew ? drawn : kept) += anew ? budget[next.bins[i]] : 64;
        }
        // Pixels move to whole bins, a quarter of an octave apart, and of 64 samples a fifth of the variance is taken from the mean of all:
        // of the quiet pixels' 0.04 that makes 0.12, which is planned to be left of them, of 0.44 of all.
        check_at_most("noise left over what was asked for", after / before / part, 1.25);
        check_at_most("what was asked for less what quiet pixels seem to leave", part - 0.9 * 0.12 / 0.44, 1.25 * after / before);
        // Noise of all pixels would be lessened so by samples of all.
        check_at_most("samples over those of drawing all anew", drawn, 0.5 * 10000 * 64 * std::pow(part, -1 / stratified_gain));
        const Redrawing all = redrawing(next.drawn, Histogram(budget_bins), budget);
        check_close("samples", all.samples, drawn, 0);
        check_close("growth", next.growth, (drawn + kept) / (64 * 10000), 1e-12);
    }
}

// A budget's rounding does not keep back the one pixel that is worth it: twice 426.55 samples are 853, twice 427 are 854.
void one_pixel_that_errs_most_is_drawn_anew(void**) {
    Random random(27);
    RoundPixels pixels = unequal(random, 10000, 427);
    const size_t worst = 5000;
    pixels.radiance[4 * worst + 3] = 1e6;
    Budget budget(budget_bins);
    for (uint32_t bin = 0; bin < budget_bins; ++bin) budget[bin] = uint32_t(std::clamp(std::round(426.55 * share_of(bin)), 16.0, 65536.0));
    const Redraw next = redraw(pixels, {}, 2, Allocation::least_error, budget, 0.9);
    for (size_t i = 0; i < 10000; ++i) assert_true((budget[next.bins[i]] >= worth_redrawing * 427) == (i == worst));
}

void further_rounds_within_a_cost_spend_it(void**) {
    Random random(20);
    const RoundPixels pixels = unequal(random, 10000, 64);
    const Redraw next = redraw(pixels, {}, 2, Allocation::least_error, sixty_four_at_share_one(), 0);
    Histogram fresh(budget_bins);
    fresh[share_one] = 500;
    for (const double cost : {5e5, 5e6, 5e7}) {
        const Budget budget = replan_cost(next.drawn, fresh, cost, 30, 1 << 20);
        const Redrawing all = redrawing(next.drawn, fresh, budget);
        check_at_most("cost", all.samples + 30 * all.pixels, cost);
        // Two kinds of pixels: one may be left out for want of samples for all of it.
        check_at_most("cost that is left", cost, 4 * (all.samples + 30 * all.pixels));
        assert_true(cost < 5e6 || all.pixels == 10500);
    }
}

// A pixel that others are interpolated from counts as often as they.
void lattice_points_are_drawn_anew_first(void**) {
    Random random(21);
    RoundPixels pixels = unequal(random, 10000, 64);
    for (size_t i = 0; i < 10000; ++i) pixels.radiance[4 * i + 3] = 4.04f;
    std::vector<float> areas(10000, 1);
    for (size_t i = 0; i < 10000; ++i)
        if (i % 100 % 4 == 0 && i / 100 % 4 == 0) areas[i] = 16;
    const Redraw next = redraw(pixels, areas, 2, Allocation::least_error, sixty_four_at_share_one(), 0.7);
    for (size_t i = 0; i < 10000; ++i) {
        assert_true((sixty_four_at_share_one()[next.bins[i]] >= 128) == (areas[i] > 1));
    }
}

// ---- First rounds -----------------------------------------------------------------------------------

// 1000 pixels in a second, at 1000 samples a millisecond: some 900 of each, or 2.2 times as many of so few that each has them.
void pixels_are_interpolated_in_time_where_it_pays(void**) {
    const Settings settings = asking("time_budget", 1000);
    Pace pace;
    pace.samples_per_millisecond = 1000;
    for (const uint64_t pixels : {300, 800}) {
        Control control(settings, {1000, 1, 1}, 2, pace, 0);
        Histogram histogram(budget_bins);
        histogram[share_one] = pixels;
        assert_true(control.reconsider(histogram, 0) == (pixels > 500));
        assert_true(control.interpolates() == (pixels < 500));
    }
}

Forecast probed(double error) {
    Forecast forecast{1000, 1, 1};
    forecast.probed_error = error;
    forecast.probe_samples = 64;
    return forecast;
}

// By a probe of as much noise as is allowed, at 64 samples: with interpolation's share of the error, and what a first round may miss, all
// take 2.2 times the samples, and 30 more of each pixel; so shading all pays from (64 + 30) / (2.2 * 64 + 30) = 0.55 on.
void pixels_are_interpolated_where_it_pays(void**) {
    const Settings settings = asking("target_error", 0.02);
    for (const uint64_t pixels : {300, 800}) {
        Control control(settings, probed(std::pow(0.8 * 0.02, 2)), 2, {}, 0);
        Histogram histogram(budget_bins);
        histogram[share_one] = pixels;
        assert_true(control.interpolates());
        assert_true(control.reconsider(histogram, 0) == (pixels > 500));
        assert_true(control.interpolates() == (pixels < 500));
    }
}

// Pixels that are all alike get what takes the probe's error to what is allowed, less a margin; whatever their share says of it.
void a_probe_plans_the_first_round(void**) {
    const Settings settings = asking("target_error", 0.02);
    const double planned = 0.55 * 0.7 * std::pow(0.8 * 0.02, 2);
    for (const uint32_t bin : {3u, share_one, budget_bins - 1}) {
        Control control(settings, probed(1e-3), 2, {}, 0);
        Histogram histogram(budget_bins);
        histogram[bin] = 1000;
        // Samples are whole numbers: of some 300, a half is a six-hundredth.
        check_close("samples", control.plan(histogram, 0)[bin] / (64 * std::pow(1e-3 / planned, 1 / 1.2)), 1, 1.0 / 300);
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
    assert_true(Audit::effort(settings, 30000, 0).samples == 4 * settings.samples());
    settings.set_number("accumulate", 8);
    assert_true(Audit::effort(settings, 30000, 0).samples == 32 * settings.samples());
    settings.set_number("accumulate", 1);
    settings.set_choice("sampler", "combined");
    assert_true(Audit::effort(settings, 30000, 0).part == 0);
    settings.set_number("target_error", 0.02);
    assert_true(Audit::effort(settings, 30000, 0).probe > 0 && Audit::effort(settings, 30000, 0).samples == 0);
    settings.set_choice("sampler", "cut");
    const Audit::Effort planned = Audit::effort(settings, 30000, 0);
    assert_int_equal(planned.probe, 91);  // (0.3 / 0.02)^(2 / 1.2)
    assert_int_equal(planned.samples, 364);
    settings.set_choice("sampler", "filtered");
    assert_int_equal(Audit::effort(settings, 30000, 0).samples, 1125);  // 5 / (0.02 / 0.3)^2
    settings.set_number("time_budget", 50);
    const Audit::Effort hurried = Audit::effort(settings, 30000, 250000);
    check_at_most("samples in a twentieth of the time", hurried.part * 30000 * (hurried.samples + Pace::pixel_samples), 1.2 * 0.06 * 250000);
    assert_true(hurried.part * 30000 >= 64);
    // 64 pixels of 64 samples, and 30 before the first, are 6 % of 100,267.
    assert_true(Audit::effort(settings, 30000, 101000).part > 0 && Audit::effort(settings, 30000, 100000).part == 0);
}

// Whichever comes first: of an error that shading all 1000 pixels reaches in 0.3 s, and one that they reach in 4, a second lasts for one.
void an_error_is_kept_where_there_is_time_for_it(void**) {
    Pace pace;
    pace.samples_per_millisecond = 1000;
    for (const auto& [target, kept] : {std::pair(0.01, true), {0.002, false}}) {
        Settings settings = asking("time_budget", 1000);
        settings.set_number("target_error", target);
        Control control(settings, probed(std::pow(0.8 * 0.01, 2) * std::pow(4, 1.2)), 2, pace, 0);
        Histogram histogram(budget_bins);
        histogram[share_one] = 1000;
        control.reconsider(histogram, 0);
        const double each = control.plan(histogram, 0)[share_one];
        // 64 samples leave 4^1.2 times the noise allowed of 256; or the first of two rounds has 0.15 s for all.
        check_close("samples of each", each, kept ? 256 : 0.15 * 1000 - Pace::pixel_samples, 1);
    }
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
    const std::vector<DrawnGroup> drawn = {{30, 16, 1000}, {33, 16, 500}, {36, 16, 20}};
    const Budget second = control.plan_further(drawn, Histogram(budget_bins), cost.elapsed_milliseconds);
    check_close("second round, milliseconds", (samples(second) + before_first) / 500, 1000 - cost.elapsed_milliseconds - 12, 4);
    cost.elapsed_milliseconds = 990;
    assert_false(control.again(estimate_of(0.01, 0), cost));
    // A round that made programs says nothing of those that will find them.
    const double before = control.pace().samples_per_millisecond;
    cost.made_programs = true;
    cost.shading_milliseconds *= 10;
    control.again(estimate_of(0.01, 0), cost);
    check_close("pace", control.pace().samples_per_millisecond, before, 0);
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
        cmocka_unit_test(what_no_levels_are_found_for_is_not_interpolated),
        cmocka_unit_test(a_single_witness_is_doubted_while_there_is_noise),
        cmocka_unit_test(a_single_square_is_doubted),
        cmocka_unit_test(noise_of_one_sample_is_not_believed),
        cmocka_unit_test(one_pixel_that_errs_most_is_drawn_anew),
        cmocka_unit_test(a_cut_is_refuted_by_light_alone),
        cmocka_unit_test(what_has_overtaken_its_audit_is_still_counted),
        cmocka_unit_test(tiles_count_their_own_witnesses),
        cmocka_unit_test(an_audit_sees_what_the_spreads_do_not),
        cmocka_unit_test(what_an_audit_shares_is_told_from_chance),
        cmocka_unit_test(a_bias_of_all_pixels_alike_is_known_whole),
        cmocka_unit_test(a_probe_believes_its_audit),
        cmocka_unit_test(an_audit_sees_what_neighbours_share),
        cmocka_unit_test(an_audit_judges_what_would_be_interpolated),
        cmocka_unit_test(what_former_witnesses_show_counts),
        cmocka_unit_test(an_audit_of_the_same_sampler_knows_its_limits),
        cmocka_unit_test(what_varies_most_is_drawn_anew),
        cmocka_unit_test(further_rounds_within_a_cost_spend_it),
        cmocka_unit_test(lattice_points_are_drawn_anew_first),
        cmocka_unit_test(pixels_are_interpolated_where_it_pays),
        cmocka_unit_test(pixels_are_interpolated_in_time_where_it_pays),
        cmocka_unit_test(a_probe_plans_the_first_round),
        cmocka_unit_test(who_is_drawn_among_few_is_among_more),
        cmocka_unit_test(an_audit_takes_what_it_may),
        cmocka_unit_test(an_error_is_kept_where_there_is_time_for_it),
        cmocka_unit_test(a_time_is_shared_between_two_rounds),
    };
    return cmocka_run_group_tests_name("control", tests, nullptr, nullptr);
}
