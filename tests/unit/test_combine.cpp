// How much a shaded pixel takes from its neighbours.
#include "frame/combine.h"
#include "numeric_testing.h"
#include "picture/decision.h"

namespace lightband {
namespace {

using namespace testing;

constexpr uint32_t side = 64;
constexpr double radiance = 2;

double normal(Random& random) {  // Box and Muller
    return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * pi * random.uniform());
}

// A grey picture of 64 x 64 pixels, all shaded and all compared with interpolation. Own values have the standard deviation `own`, interpolated
// ones `other` and the error `bias` besides; spreads tell of `told` of either noise.
struct Picture {
    RoundPixels pixels;
    std::vector<double> own, interpolated;  // errors

    Picture(Random& random, double own_noise, double other_noise, double bias_finest, double bias_coarser, double told = 1) {
        for (uint32_t i = 0; i < side * side; ++i) {
            const double bias = lattice_level(i % side, i / side, 6) == 0 ? bias_finest : bias_coarser;
            own.push_back(own_noise * normal(random));
            interpolated.push_back(other_noise * normal(random) + bias * (random.uniform() < 0.5 ? -1 : 1));
            const double spread = told * own_noise * normal(random), other = told * other_noise * normal(random);
            const float value = float(radiance + own[i]);
            pixels.radiance.insert(pixels.radiance.end(), {value, value, value, value * value + float(15 * own_noise * own_noise)});
            pixels.spread.insert(pixels.spread.end(), {float(spread), float(interpolated[i] - own[i]), float(other - spread),
                                                       float(other_noise * other_noise)});
            pixels.sample_count.push_back(16);
            pixels.decision.push_back(first_bin | validation_bit);
            pixels.material.push_back(1);
        }
    }
    std::vector<uint8_t> parts(uint32_t frames = 1) const {
        return neighbour_parts(pixels, {}, tiles_of_picture(side, side), side, 6, frames);
    }
};

bool is_finest(uint32_t i) { return lattice_level(i % side, i / side, 6) == 0; }

double mean_part(const std::vector<uint8_t>& parts) {
    double sum = 0, count = 0;
    for (uint32_t i = 0; i < parts.size(); ++i)
        if (is_finest(i)) sum += parts[i] / 255.0, ++count;
    return sum / count;
}

// A tile's 192 pixels know a mean square to sqrt(2 / 192) = 10 %; a part is a ratio of two of these, and the mean of 16 tiles is known to
// 0.04. Steps of 1 / 255 are within that.
void the_part_is_the_one_that_errs_least(void**) {
    Random random(21);
    check_close("noise alone", mean_part(Picture(random, 0.02, 0.01, 0, 0).parts()), 0.8, 0.04);
    check_close("interpolation as bad", mean_part(Picture(random, 0.02, 0.01, 0.03, 0.12).parts()), 4 / (4 + 1 + 9.0), 0.04);
    check_close("an edge", mean_part(Picture(random, 0.02, 0.01, 0.4, 0.6).parts()), 0, 0.01);
}

// Of four frames a fourth of the noise is left, and all of what interpolation errs.
void a_mean_of_frames_has_less_noise(void**) {
    Random random(22);
    check_close("part", mean_part(Picture(random, 0.02, 0.01, 0.03, 0.12).parts(4)), 1 / (1 + 0.25 + 9.0), 0.04);
}

// Spreads tell of a quarter of the variance: without the coarser lattice, 4 / (4 + 1) of a quarter would be left of the part.
void noise_that_spreads_miss_is_not_taken_for_an_error_of_interpolation(void**) {
    Random random(23);
    check_at_most("what is missing", 0.8 - mean_part(Picture(random, 0.02, 0.01, 0, 0, 0.5).parts()), 0.1);
}

// Lattice points are what others are interpolated from: their own values stay.
void lattice_points_keep_their_values(void**) {
    Random random(24);
    const std::vector<uint8_t> parts = Picture(random, 0.02, 0.01, 0, 0).parts();
    for (uint32_t i = 0; i < parts.size(); ++i)
        if (!is_finest(i)) assert_int_equal(parts[i], 0);
}

void a_pixel_does_not_choose_its_own_part(void**) {
    Random random(25);
    Picture picture(random, 0.02, 0.01, 0.02, 0.08);
    const size_t at = 33 * side + 17;
    const uint8_t before = picture.parts()[at];
    picture.pixels.spread[4 * at] *= -3;
    picture.pixels.spread[4 * at + 1] *= -1;
    picture.pixels.spread[4 * at + 2] *= 5;
    assert_int_equal(picture.parts()[at], before);
    // But where it differs by more than noise, there is an edge, and it keeps its own value.
    picture.pixels.spread[4 * at + 1] = 1;
    assert_int_equal(picture.parts()[at], 0);
}

// The estimate is of what is shown: over 3,072 pixels a mean square is known to sqrt(2 / 3072) = 2.6 %, so two of them agree within four
// standard errors of their difference, 15 %.
void the_estimate_is_of_what_is_shown(void**) {
    Random random(26);
    for (const double bias : {0.0, 0.03}) {
        Picture picture(random, 0.02, 0.01, bias, 4 * bias);
        picture.pixels.neighbour_part = picture.parts();
        const ErrorEstimate estimate = estimate_error(picture.pixels, {0}, 1, {}, tiles_of_picture(side, side));
        double sum = 0;
        for (uint32_t i = 0; i < side * side; ++i) {
            const double part = picture.pixels.neighbour_part[i] / 255.0;
            sum += std::pow(((1 - part) * picture.own[i] + part * picture.interpolated[i]) / (1 + dark_part) / radiance, 2);
        }
        check_close("squared error", estimate.error() * estimate.error() / (sum / side / side), 1, 0.15);
    }
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_part_is_the_one_that_errs_least),
        cmocka_unit_test(a_mean_of_frames_has_less_noise),
        cmocka_unit_test(noise_that_spreads_miss_is_not_taken_for_an_error_of_interpolation),
        cmocka_unit_test(lattice_points_keep_their_values),
        cmocka_unit_test(a_pixel_does_not_choose_its_own_part),
        cmocka_unit_test(the_estimate_is_of_what_is_shown),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
