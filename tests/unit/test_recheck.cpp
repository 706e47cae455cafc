// The recheck of a light cut by unbiased samples: it detects light that the cut loses with any number of samples, and
// is misled neither by noise nor by a cut that converges.
#include "frame/control_set.h"
#include "frame/recheck.h"
#include "numeric_testing.h"
#include "picture/budget.h"

namespace lightband {
namespace {

using namespace testing;

constexpr RecheckSamples samples{64, 256, 735};  // unbiased: ControlSet::unbiased_samples(64)
constexpr double harmless = 0.005;

double normal(Random* random) {
    return std::sqrt(-2 * std::log(1 - random->uniform())) * std::cos(2 * pi * random->uniform());
}

// Pixels of a cut that errs by `few` with 64 samples (half of the squared error is common to all pixels) and loses the
// fraction `lost` of the light with any number of samples. Unbiased samples have the standard deviation `noise`.
Recheck of_pixels(uint64_t seed, double few, double lost, double noise) {
    Random random(seed);
    std::vector<RecheckedPixel> pixels;
    const double falls = std::pow(samples.few / samples.many, 0.5 * constants::stratified_gain);
    for (int i = 0; i < 72; ++i) {
        const double alike = few * std::sqrt(0.5), a = alike * normal(&random), b = alike * falls * normal(&random);
        const double first = noise * std::sqrt(2.0) * normal(&random),
                     second = noise * std::sqrt(2.0) * normal(&random);
        pixels.push_back({1 - lost + alike + a, 1 - lost + falls * alike + b, 1 + (first + second) / 2,
                          (first - second) / 2, noise});
    }
    return recheck(pixels, samples);
}

// A difference of more than four standard errors occurs by chance once in 16,000 times; with 71 degrees of freedom,
// once in 6,000.
void a_cut_that_converges_is_kept(void**) {
    for (uint64_t seed = 0; seed < 200; ++seed) assert_false(of_pixels(seed, 0.04, 0, 0.04).contradicts(harmless));
}

// The extrapolated cut has 2.2 times its error with many samples (0.435 of that with few), so that a mean of 72 is
// known to 0.007.
void light_lost_at_any_number_of_samples_is_detected(void**) {
    for (uint64_t seed = 0; seed < 200; ++seed) assert_true(of_pixels(seed, 0.04, 0.06, 0.04).contradicts(harmless));
    for (uint64_t seed = 0; seed < 200; ++seed) assert_true(of_pixels(seed, 0.04, -0.06, 0.04).contradicts(harmless));
}

void a_difference_below_the_frames_error_is_harmless(void**) {
    const Recheck seen = of_pixels(1, 0.001, 0.02, 0.01);
    assert_true(seen.contradicts(harmless));
    assert_false(seen.contradicts(0.03));
}

// A cut that errs to either side, so that its mean is right, but by more than as many unbiased samples would.
void a_cut_with_more_error_than_unbiased_samples_is_given_up(void**) {
    const auto scattered = [](double error, double noise) {
        Random random(5);
        std::vector<RecheckedPixel> pixels;
        for (int i = 0; i < 72; ++i) {
            const double off = error * (i % 2 == 0 ? 1 : -1), first = noise * normal(&random),
                         second = noise * normal(&random);
            pixels.push_back({1 + off, 1 + off, 1 + (first + second) / 2, (first - second) / 2, noise});
        }
        return recheck(pixels, samples);
    };
    // 256 unbiased samples err by 0.02 * sqrt(735 / 256 / 2) = 0.024.
    assert_true(scattered(0.1, 0.02).contradicts(harmless));
    assert_false(scattered(0.02, 0.02).contradicts(harmless));
}

// One pixel's replicates may agree by chance, so that its spread alone is no standard error.
void the_standard_error_of_one_pixel_is_not_its_spread(void**) {
    assert_false(recheck({{1.02, 1.02, 1, 0, 0.01}}, samples).contradicts(harmless));
    assert_true(recheck({{1.05, 1.05, 1, 0, 0.01}}, samples).contradicts(harmless));
}

void no_pixels_contradict_nothing(void**) {
    assert_false(recheck({}, samples).contradicts(harmless));
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_cut_that_converges_is_kept),
        cmocka_unit_test(light_lost_at_any_number_of_samples_is_detected),
        cmocka_unit_test(a_difference_below_the_frames_error_is_harmless),
        cmocka_unit_test(a_cut_with_more_error_than_unbiased_samples_is_given_up),
        cmocka_unit_test(the_standard_error_of_one_pixel_is_not_its_spread),
        cmocka_unit_test(no_pixels_contradict_nothing),
    };
    return cmocka_run_group_tests_name("recheck", tests, nullptr, nullptr);
}
