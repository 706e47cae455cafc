// What is foreseen of interpolation over directions, and what control makes of it.
#include "frame/control.h"
#include "frame/rehearsal.h"
#include "numeric_testing.h"

namespace lightband {
namespace {

using namespace testing;

// Pixels all over a half sphere, seen from +Z, of a radiance that wiggles faster than their distances: no plane fits.
std::vector<RehearsedPixel> wiggling(Random& random, size_t count, uint32_t slot, double shown, double expected) {
    std::vector<RehearsedPixel> pixels;
    for (size_t i = 0; i < count; ++i) {
        const Vec3 normal = random.hemisphere(), wo(0, 0, 1);
        const double wiggle = std::sin(200 * normal.x) * std::sin(200 * normal.y);
        pixels.push_back({normal, 2 * glm::dot(normal, wo) * normal - wo, slot, 1 + shown * wiggle, 1 + expected * wiggle});
    }
    return pixels;
}

// Errors are linear in the wiggle; what they are relative to differs by it, up to 2 %: squares by 4 %.
void what_is_shown_is_held_against_what_is_expected(void**) {
    Random random(1);
    check_close("twice", rehearse(wiggling(random, 400, 0, 0.02, 0.01), 0) / 4, 1, 0.05);
    check_close("alike", rehearse(wiggling(random, 400, 0, 0.01, 0.01), 0), 1, 1e-12);
    // Pilots' own grain shows at short distances alone: what they say too much here is not taken off.
    check_close("half", rehearse(wiggling(random, 400, 0, 0.01, 0.02), 0), 1, 0);
    check_close("too few", rehearse(wiggling(random, 40, 0, 0.02, 0.01), 0), 1, 0);
    check_close("dark", rehearse(wiggling(random, 400, 0, 0, 0), 0), 1, 0);
}

void materials_are_rehearsed_apart(void**) {
    Random random(2);
    std::vector<RehearsedPixel> both;
    for (const uint32_t slot : {0u, 1u})
        for (RehearsedPixel pixel : wiggling(random, 200, slot, 0, 0)) {
            pixel.shown = slot == 0 ? 1 : 5;
            pixel.expected = slot == 0 ? 1 : 2;
            both.push_back(pixel);
        }
    check_close("constants", rehearse(both, 0), 1, 0);
}

Settings over_directions(const char* name, double value) {
    Settings settings;
    settings.set_choice("interpolation", "directions");
    settings.set_number(name, value);
    return settings;
}

// A frame of given samples lets interpolation err by as much as its noise: the root of that is a deviation of 1 over 64 samples.
// Errors fall as the 3/4th power of the scale.
void levels_follow_what_is_foreseen(void**) {
    const Settings settings = over_directions("samples", 64);
    Forecast forecast;
    forecast.covered = 1000;
    forecast.mean_radiance = forecast.relative_deviation = 1;
    Control control(settings, forecast, 3, {}, 0);
    const float before = control.scales().of[0];
    control.follow({{400, 50, 8}, {400, 50, 2}, {0, 100, 0}});
    const double first = double(control.scales().of[0] / before), second = double(control.scales().of[1] / before);
    const double left = 8 * std::pow(first, -1.5) + 2 * std::pow(second, -1.5);
    check_close("squares left", left / (1000.0 / 64), 1, 1e-5);
    // What errs four times as much for as many pixels becomes finer by the 3.5th root of it.
    check_close("share of the tiles", first / second, std::pow(4, 1 / 3.5), 1e-5);
    assert_true(control.scales().of[2] == before);
}

// Of 10,000 pixels at 5 %, of which a probe of 32 samples leaves 3 %: all of them cost 620,000 samples and less.
void directions_are_chosen_where_they_spare(void**) {
    const Settings settings = over_directions("target_error", 0.05);
    Forecast forecast;
    forecast.covered = 10000;
    forecast.mean_radiance = forecast.relative_deviation = 1;
    forecast.probed_error = 0.0009;
    forecast.probe_samples = 32;
    const Control control(settings, forecast, 1, {}, 0);
    assert_true(control.spares({{9500, 500, 1}}, 10000));
    assert_false(control.spares({{9500, 500, 1}}, 500));      // in the image few would be shaded as well
    assert_false(control.spares({{9500, 500, 1000}}, 10000));  // an error of a third of each, to be a hundredth
    assert_false(control.spares({{5000, 5000, 20}}, 10000));   // more than half of the pixels are too many
    assert_false(control.spares({}, 10000));                   // nothing is known
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(what_is_shown_is_held_against_what_is_expected),
        cmocka_unit_test(materials_are_rehearsed_apart),
        cmocka_unit_test(levels_follow_what_is_foreseen),
        cmocka_unit_test(directions_are_chosen_where_they_spare),
    };
    return cmocka_run_group_tests_name("foresight", tests, nullptr, nullptr);
}
