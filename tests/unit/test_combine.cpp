// The weight of the interpolated value in what a shaded pixel displays.
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

// A grey picture of 64 x 64 pixels, all of them shaded and compared with the interpolated value. Own values have the
// standard deviation `own_noise`, interpolated ones `other_noise` and the error `bias_...` besides. Spreads contain the
// fraction `seen` of either noise.
struct Picture {
    RoundPixels pixels;
    std::vector<double> own, interpolated;  // errors

    Picture(Random& random, double own_noise, double other_noise, double bias_finest, double bias_coarser,
            double seen = 1) {
        for (uint32_t i = 0; i < side * side; ++i) {
            const double bias = lattice_level(i % side, i / side, 6) == 0 ? bias_finest : bias_coarser;
            own.push_back(own_noise * normal(random));
            interpolated.push_back(other_noise * normal(random) + bias * (random.uniform() < 0.5 ? -1 : 1));
            const double spread = seen * own_noise * normal(random), other = seen * other_noise * normal(random);
            const float value = float(radiance + own[i]);
            pixels.radiance.insert(pixels.radiance.end(),
                                   {value, value, value, value * value + float(15 * own_noise * own_noise)});
            pixels.spread.insert(pixels.spread.end(), {float(spread), float(interpolated[i] - own[i]),
                                                       float(other - spread), float(other_noise * other_noise)});
            pixels.sample_count.push_back(16);
            pixels.decision.push_back(first_bin | validation_bit);
            pixels.material.push_back(1);
        }
    }
    std::vector<uint8_t> parts(uint32_t frames = 1) const {
        return neighbour_parts(pixels, {}, tiles_of_picture(side, side), side, 6, frames);
    }
};

bool is_finest(uint32_t i) {
    return lattice_level(i % side, i / side, 6) == 0;
}

double mean_part(const std::vector<uint8_t>& parts) {
    double sum = 0, count = 0;
    for (uint32_t i = 0; i < parts.size(); ++i)
        if (is_finest(i)) sum += parts[i] / 255.0, ++count;
    return sum / count;
}

// A tile's 192 pixels know a mean square to sqrt(2 / 192) = 10 %; a part is a ratio of two of these, and the mean of 16
// tiles is known to 0.04. Steps of 1 / 255 are within that.
void the_weight_is_the_one_with_least_error(void**) {
    Random random(21);
    check_close("noise alone", mean_part(Picture(random, 0.02, 0.01, 0, 0).parts()), 0.8, 0.04);
    check_close("interpolation as bad", mean_part(Picture(random, 0.02, 0.01, 0.03, 0.12).parts()), 4 / (4 + 1 + 9.0),
                0.04);
    check_close("an edge", mean_part(Picture(random, 0.02, 0.01, 0.4, 0.6).parts()), 0, 0.01);
}

// The mean of four frames has a quarter of the squared noise, and all of the error of interpolation.
void a_mean_of_frames_has_less_noise(void**) {
    Random random(22);
    check_close("part", mean_part(Picture(random, 0.02, 0.01, 0.03, 0.12).parts(4)), 1 / (1 + 0.25 + 9.0), 0.04);
}

// Spreads contain a quarter of the variance: without the coarser lattice, only a quarter of the weight 4 / (4 + 1)
// would be left.
void noise_that_spreads_miss_is_not_taken_for_an_error_of_interpolation(void**) {
    Random random(23);
    check_at_most("what is missing", 0.8 - mean_part(Picture(random, 0.02, 0.01, 0, 0, 0.5).parts()), 0.1);
}

// Other pixels are interpolated from lattice points, so their own values stay.
void lattice_points_keep_their_values(void**) {
    Random random(24);
    const std::vector<uint8_t> parts = Picture(random, 0.02, 0.01, 0, 0).parts();
    for (uint32_t i = 0; i < parts.size(); ++i)
        if (!is_finest(i)) assert_int_equal(parts[i], 0);
}

void a_pixels_own_noise_does_not_change_its_weight(void**) {
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

// The estimate is of what is displayed: over 3,072 pixels a mean square is known to sqrt(2 / 3072) = 2.6 %, so two of
// them agree within four standard errors of their difference, 15 %.
void the_estimate_is_of_what_is_displayed(void**) {
    Random random(26);
    for (const double bias : {0.0, 0.03}) {
        Picture picture(random, 0.02, 0.01, bias, 4 * bias);
        picture.pixels.neighbour_part = picture.parts();
        const ErrorEstimate estimate = estimate_error(picture.pixels, {0}, 1, {}, tiles_of_picture(side, side));
        double sum = 0;
        for (uint32_t i = 0; i < side * side; ++i) {
            const double part = picture.pixels.neighbour_part[i] / 255.0;
            sum += std::pow(((1 - part) * picture.own[i] + part * picture.interpolated[i]) / (1 + dark_part) / radiance,
                            2);
        }
        check_close("squared error", estimate.error() * estimate.error() / (sum / side / side), 1, 0.15);
    }
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_weight_is_the_one_with_least_error),
        cmocka_unit_test(a_mean_of_frames_has_less_noise),
        cmocka_unit_test(noise_that_spreads_miss_is_not_taken_for_an_error_of_interpolation),
        cmocka_unit_test(lattice_points_keep_their_values),
        cmocka_unit_test(a_pixels_own_noise_does_not_change_its_weight),
        cmocka_unit_test(the_estimate_is_of_what_is_displayed),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
