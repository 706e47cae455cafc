// The sample budget and the table of settings.
#include "picture/budget.h"
#include "picture/settings.h"
#include "numeric_testing.h"

namespace lightband {
namespace {

using namespace testing;

// ---- Budget ------------------------------------------------------------------------------------------

double pixels_in(const std::vector<uint64_t>& histogram) {
    double sum = 0;
    for (uint64_t count : histogram) sum += double(count);
    return sum;
}

double samples_in(const std::vector<uint64_t>& histogram, const std::vector<uint32_t>& samples) {
    double sum = 0;
    for (size_t bin = 0; bin < histogram.size(); ++bin) sum += double(histogram[bin]) * samples[bin];
    return sum;
}

std::vector<uint64_t> random_histogram(Random& random) {
    std::vector<uint64_t> histogram(budget_bins);
    const uint32_t first = random.below(budget_bins), count = 1 + random.below(20);
    for (uint32_t bin = first; bin < std::min(first + count, budget_bins); ++bin) histogram[bin] = random.below(100000);
    ++histogram[first];
    return histogram;
}

// The total grows bin by bin, by one sample for each of its pixels: it stops less than one sample per pixel short.
void budget_meets_its_mean(void**) {
    Random random(31);
    for (int i = 0; i < 300; ++i) {
        const std::vector<uint64_t> histogram = random_histogram(random);
        const double mean = std::floor(random.log_uniform(1, 4096));
        const uint32_t most = 1u << 20;
        const std::vector<uint32_t> samples = plan_mean(histogram, mean, most);
        assert_int_equal(samples.size(), budget_bins);
        const double found = samples_in(histogram, samples) / pixels_in(histogram);
        // Shares of 2^19 and more apart may leave nothing to be shared between the bounds.
        bool bounded = true;
        for (uint32_t bin = 0; bin < budget_bins; ++bin)
            if (histogram[bin] > 0 && samples[bin] > std::min(least_samples, uint32_t(mean)) && samples[bin] < most)
                bounded = false;
        check_at_most("mean", found, mean);
        if (!bounded) check_at_most("samples per pixel short of the mean", mean - found, 1);
    }
}

void budget_grows_with_the_share_within_its_limits(void**) {
    Random random(32);
    for (int i = 0; i < 300; ++i) {
        const std::vector<uint64_t> histogram = random_histogram(random);
        const double mean = std::floor(random.log_uniform(1, 4096));
        const uint32_t most = uint32_t(random.log_uniform(1, 1 << 16));
        const std::vector<uint32_t> samples = plan_mean(histogram, mean, most);
        const uint32_t least = std::min({least_samples, most, uint32_t(mean)});
        for (uint32_t bin = 0; bin < budget_bins; ++bin) {
            assert_true(samples[bin] >= least && samples[bin] <= most);
            if (bin > 0) assert_true(samples[bin] >= samples[bin - 1]);
        }
    }
}

// Between the bounds a bin gets twice the samples of that an octave lower, each rounded by half a sample.
void budget_follows_the_shares(void**) {
    std::vector<uint64_t> histogram(budget_bins);
    for (uint32_t bin = 30; bin < 46; ++bin) histogram[bin] = 1000;
    const std::vector<uint32_t> samples = plan_mean(histogram, 500, 1 << 20);
    for (uint32_t bin = 30 + bins_per_octave; bin < 46; ++bin)
        check_close("twice", samples[bin], 2.0 * samples[bin - bins_per_octave], 1.5);
    // One bin alone gets the mean.
    std::vector<uint64_t> single(budget_bins);
    single[7] = 123;
    assert_int_equal(plan_mean(single, 64, 1 << 16)[7], 64);
    assert_int_equal(plan_mean(single, 64, 16)[7], 16);
    assert_int_equal(plan_mean(single, 1, 16)[7], 1);
    // No pixel at all: any number within the limits.
    for (const uint32_t count : plan_mean(std::vector<uint64_t>(budget_bins), 64, 16))
        assert_true(count >= 4 && count <= 16);
}

// ---- Settings ----------------------------------------------------------------------------------------

std::string first_of(const std::string& choices) {
    return choices.substr(0, choices.find('|'));
}

void defaults_are_accepted_and_set(void**) {
    assert_true(Settings::count() > 0);
    for (uint32_t i = 0; i < Settings::count(); ++i) {
        const lb_setting_info& row = Settings::info(i);
        Settings settings;
        assert_true(std::string(row.documentation).size() > 10);
        if (row.type == LB_SETTING_CHOICE) {
            assert_string_equal(settings.choice(row.name), row.default_choice);
            assert_string_equal(first_of(row.choices).c_str(), row.default_choice);
            settings.set_choice(row.name, row.default_choice);
            assert_string_equal(settings.choice(row.name), row.default_choice);
        } else {
            check_close(row.name, settings.number(row.name), row.default_number, 0);
            settings.set_number(row.name, row.default_number);
            check_close(row.name, settings.number(row.name), row.default_number, 0);
        }
    }
}

// Refused values leave the setting as it was.
void numbers_outside_their_range_are_named(void**) {
    for (uint32_t i = 0; i < Settings::count(); ++i) {
        const lb_setting_info& row = Settings::info(i);
        if (row.type == LB_SETTING_CHOICE) continue;
        Settings settings;
        for (const double bound : {row.minimum, row.maximum}) {
            settings.set_number(row.name, bound);
            check_close(row.name, settings.number(row.name), bound, 0);
        }
        const auto refused = [&](double value, const std::vector<std::string>& words) {
            expect_error(LB_ERROR_INVALID_ARGUMENT, words, [&] { settings.set_number(row.name, value); });
            check_close(row.name, settings.number(row.name), row.maximum, 0);
        };
        refused(row.minimum - 1, {row.name, text(row.minimum - 1), text(row.minimum), text(row.maximum)});
        refused(row.maximum * 2 + 1, {row.name, text(row.maximum)});
        refused(std::nan(""), {row.name, "nan"});
        if (row.type == LB_SETTING_INTEGER) refused(row.minimum + 0.5, {row.name, "whole"});
        expect_error(LB_ERROR_INVALID_ARGUMENT, {row.name, "number"}, [&] { settings.set_choice(row.name, "much"); });
        expect_error(LB_ERROR_INVALID_ARGUMENT, {row.name, "number"}, [&] { settings.choice(row.name); });
    }
}

void unknown_choices_and_names_are_listed(void**) {
    std::vector<std::string> names;
    for (uint32_t i = 0; i < Settings::count(); ++i) names.push_back(Settings::info(i).name);
    names.push_back("smaples");
    Settings settings;
    expect_error(LB_ERROR_INVALID_ARGUMENT, names, [&] { settings.set_number("smaples", 1); });
    expect_error(LB_ERROR_INVALID_ARGUMENT, names, [&] { settings.set_choice("smaples", "1"); });
    expect_error(LB_ERROR_INVALID_ARGUMENT, names, [&] { settings.number("smaples"); });
    expect_error(LB_ERROR_INVALID_ARGUMENT, names, [&] { settings.choice("smaples"); });
    for (uint32_t i = 0; i < Settings::count(); ++i) {
        const lb_setting_info& row = Settings::info(i);
        if (row.type != LB_SETTING_CHOICE) continue;
        expect_error(LB_ERROR_INVALID_ARGUMENT, {row.name, "neither", row.choices},
                     [&] { settings.set_choice(row.name, "neither"); });
        expect_error(LB_ERROR_INVALID_ARGUMENT, {row.name, "choice"}, [&] { settings.number(row.name); });
        expect_error(LB_ERROR_INVALID_ARGUMENT, {row.name}, [&] { settings.set_number(row.name, 0); });
        assert_string_equal(settings.choice(row.name), row.default_choice);
    }
}

// What the passes read is what the table names first; each choice moves its own value and no other.
void typed_values_follow_the_table(void**) {
    struct Choice {
        const char *name, *other;
        bool (*chosen)(const Settings& settings);
    };
    const Choice choices[] = {
        {"method", "reference", [](const Settings& s) { return s.method() == Method::reference; }},
        {"transport", "box", [](const Settings& s) { return s.transport() == TransportForm::box; }},
        {"band_rule", "sum", [](const Settings& s) { return s.band_rule() == BandRule::sum; }},
        {"variance", "printed", [](const Settings& s) { return s.variance() == Variance::printed; }},
        {"allocation", "constant_variance",
         [](const Settings& s) { return s.allocation() == Allocation::constant_variance; }},
        {"brdf_lookup", "linear", [](const Settings& s) { return s.brdf_lookup() == Lookup::linear; }},
        {"environment_lookup", "nearest", [](const Settings& s) { return s.environment_lookup() == Lookup::nearest; }},
        {"split_suns", "off", [](const Settings& s) { return !s.split_suns(); }},
        {"background", "environment", [](const Settings& s) { return s.background(); }},
        // A reference has its own way of sampling: these two say so without being asked.
        {"sequence", "random",
         [](const Settings& s) { return s.method() == Method::adaptive && s.sequence() == Sequence::random; }},
        {"sampler", "brdf",
         [](const Settings& s) { return s.method() == Method::adaptive && s.sampler() == Sampler::brdf; }},
    };
    for (const Choice& set : choices) {
        Settings settings;
        for (const Choice& read : choices) assert_false(read.chosen(settings));
        settings.set_choice(set.name, set.other);
        for (const Choice& read : choices) assert_int_equal(read.chosen(settings), &read == &set);
    }
}

void references_are_random_and_numbers_arrive(void**) {
    Settings settings;
    settings.set_choice("method", "reference");
    assert_true(settings.method() == Method::reference);
    assert_true(settings.sequence() == Sequence::random);
    assert_true(settings.sampler() == Sampler::brdf);
    settings.set_number("samples", 1024);
    settings.set_number("bandwidth_scale", 3);
    check_close("scale", settings.bandwidth_scale(), 3, 0);
    settings.set_number("seed", 4294967295.0);
    assert_int_equal(settings.seed(), 4294967295u);
    settings.set_number("accumulate", 3);
    settings.set_number("max_samples", 77);
    settings.set_number("pilots", 99);
    settings.set_number("coarsest_level", 2);
    assert_int_equal(settings.samples(), 1024);
    assert_int_equal(settings.accumulate(), 3);
    assert_int_equal(settings.max_samples(), 77);
    assert_int_equal(settings.pilots(), 99);
    assert_int_equal(settings.coarsest_level(), 2);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(budget_meets_its_mean),
        cmocka_unit_test(budget_grows_with_the_share_within_its_limits),
        cmocka_unit_test(budget_follows_the_shares),
        cmocka_unit_test(defaults_are_accepted_and_set),
        cmocka_unit_test(numbers_outside_their_range_are_named),
        cmocka_unit_test(unknown_choices_and_names_are_listed),
        cmocka_unit_test(typed_values_follow_the_table),
        cmocka_unit_test(references_are_random_and_numbers_arrive),
    };
    return cmocka_run_group_tests_name("frame_plan", tests, nullptr, nullptr);
}
