// The optics behind the built-in materials, against closed forms: interfaces, films, colour, microfacet lobes.
#include <cmath>

#include "io_testing.h"
#include "materials/coated_flakes.h"
#include "materials/microfacet.h"
#include "materials/optical_constants.h"
#include "materials/reflectance_curve.h"

namespace lightband {
namespace {

// Closed forms of a few dozen operations: their rounding stays well below this.
constexpr double rounding = 1e-12;

void check_close(const char* what, double actual, double expected, double tolerance) {
    if (!(std::fabs(actual - expected) <= tolerance))
        fail_msg("%s: %.17g is not within %g of %.17g", what, actual, tolerance, expected);
}

const IndexSpectrum* const metals[] = {&index_of_aluminium(), &index_of_chromium(), &index_of_copper(),
                                       &index_of_gold(), &index_of_nickel()};

void fresnel_at_normal_incidence(void**) {
    for (const IndexSpectrum* metal : metals)
        for (const RefractiveIndex& index : *metal) {
            const double n = index.real(), k = index.imag();
            const double expected = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
            check_close("metal", fresnel_reflectance(1.0, 1.0, index), expected, rounding);
        }
    check_close("glass", fresnel_reflectance(1.0, 1.0, 1.5), 0.04, rounding);
    check_close("glass from inside", fresnel_reflectance(1.0, 1.5, 1.0), 0.04, rounding);
}

// At Brewster's angle tan(theta) = n the parallel part vanishes, and the other is ((n^2 - 1) / (n^2 + 1))^2.
void fresnel_at_brewster_angle(void**) {
    for (const double n : {1.33, 1.5, 2.4}) {
        const double perpendicular = (n * n - 1) / (n * n + 1);
        check_close("Brewster", fresnel_reflectance(1.0 / std::sqrt(1 + n * n), 1.0, n),
                    0.5 * perpendicular * perpendicular, rounding);
    }
}

void everything_is_reflected_at_grazing_and_beyond_the_critical_angle(void**) {
    check_close("grazing glass", fresnel_reflectance(0.0, 1.0, 1.5), 1.0, 0.0);
    for (const IndexSpectrum* metal : metals) {
        check_close("grazing metal", fresnel_reflectance(0.0, 1.0, (*metal)[20]), 1.0, 0.0);
        // To first order 1 - R is below 8 |n|^2 / n * cos < 1e3 * cos for these metals.
        check_close("nearly grazing metal", fresnel_reflectance(1e-9, 1.0, (*metal)[20]), 1.0, 1e-6);
    }
    for (const double sine : {0.67, 0.8, 0.99})  // the critical sine is 1 / 1.5
        check_close("total", fresnel_reflectance(std::sqrt(1 - sine * sine), 1.5, 1.0), 1.0, rounding);
    assert_true(fresnel_reflectance(std::sqrt(1 - 0.66 * 0.66), 1.5, 1.0) < 1.0);
}

void film_of_no_thickness_is_the_bare_substrate(void**) {
    const RefractiveIndex gold = index_of_gold()[15];
    for (const double cosine : {1.0, 0.6, 0.1}) {
        check_close("film", film_stack_reflectance(cosine, 1.0, {{2.3, 0.0}}, gold, 530.0),
                    fresnel_reflectance(cosine, 1.0, gold), rounding);
        check_close("stack", film_stack_reflectance(cosine, 1.0, {{{3.0, 3.3}, 0.0}, {1.38, 0.0}}, gold, 530.0),
                    fresnel_reflectance(cosine, 1.0, gold), rounding);
    }
}

// Born and Wolf, Principles of Optics, sec. 1.6.4: at normal incidence a quarter wave of index n1 on n2 in n0 reflects
// ((n0 n2 - n1^2) / (n0 n2 + n1^2))^2, nothing for n1 = sqrt(n0 n2); a half wave does not change the substrate.
void quarter_wave_and_half_wave_films(void**) {
    const double wavelength = 550.0, substrate = 1.9;
    for (const double film : {1.38, std::sqrt(substrate), 2.3}) {
        const double expected = std::pow((substrate - film * film) / (substrate + film * film), 2);
        check_close("quarter wave",
                    film_stack_reflectance(1.0, 1.0, {{film, wavelength / film / 4}}, substrate, wavelength), expected,
                    rounding);
        check_close("half wave",
                    film_stack_reflectance(1.0, 1.0, {{film, wavelength / film / 2}}, substrate, wavelength),
                    fresnel_reflectance(1.0, 1.0, substrate), rounding);
    }
    // Under an angle the wave travels d * cos inside the film: a quarter wave again, where d grows by 1 / cos.
    const double film = 1.38, cosine = 0.5, inside = std::sqrt(1 - (1 - cosine * cosine) / (film * film));
    const double thin = film_stack_reflectance(cosine, 1.0, {{film, wavelength / film / 4 / inside}}, substrate,
                                               wavelength);
    const double three_quarters =
        film_stack_reflectance(cosine, 1.0, {{film, 3 * wavelength / film / 4 / inside}}, substrate, wavelength);
    check_close("three quarter waves", three_quarters, thin, rounding);
    assert_true(thin < fresnel_reflectance(cosine, 1.0, substrate));
}

// Two quarter waves in series have the admittance (n2 / n1)^2 ns.
void two_quarter_waves(void**) {
    const double wavelength = 600.0, n1 = 1.38, n2 = 2.1, substrate = 1.52;
    const double admittance = std::pow(n1 / n2, 2) * substrate;
    check_close("two films",
                film_stack_reflectance(1.0, 1.0, {{n1, wavelength / n1 / 4}, {n2, wavelength / n2 / 4}}, substrate,
                                       wavelength),
                std::pow((1 - admittance) / (1 + admittance), 2), rounding);
}

void opaque_film_hides_the_substrate(void**) {
    const RefractiveIndex chromium = index_of_chromium()[17];
    for (const double cosine : {1.0, 0.3})
        check_close("opaque", film_stack_reflectance(cosine, 1.5, {{chromium, 1e4}}, 1.38, 550.0),
                    fresnel_reflectance(cosine, 1.5, chromium), rounding);
}

// The integral in closed form: Walsh 1926, "The reflection factor of a polished glass surface for diffused light".
void diffuse_reflectance_of_a_dielectric(void**) {
    for (const double n : {1.33, 1.5, 1.7}) {
        const double n2 = n * n, n4 = n2 * n2;
        const double expected = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
                                n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
                                2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
                                8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
        // The integrand bends like a square root at grazing: the last of 1024 steps errs by about 1024^-1.5 = 3e-5.
        check_close("diffuse", diffuse_fresnel_reflectance(n), expected, 3e-5);
    }
}

void perfect_reflectors_are_white_and_grey(void**) {
    for (const double reflectance : {0.0, 0.18, 1.0}) {
        Spectrum spectrum;
        spectrum.fill(reflectance);
        const Vec3 rgb = spectrum_rgb(spectrum);
        for (int channel = 0; channel < 3; ++channel) check_close("grey", rgb[channel], reflectance, rounding);
        check_close("saturation", saturation_within_unit_cube(rgb), 1.0, 0.0);
    }
}

void colours_outside_the_primaries_keep_their_luminance(void**) {
    for (size_t sample = 0; sample + 4 < wavelength_count; ++sample) {
        Spectrum band{}, gap;
        gap.fill(1.0);
        for (size_t i = sample; i < sample + 4; ++i) {
            band[i] = 1.0;
            gap[i] = 0.0;
        }
        for (const Spectrum& spectrum : {band, gap}) {
            const Vec3 unbounded = spectrum_rgb(spectrum);
            const Vec3 rgb = with_saturation(unbounded, saturation_within_unit_cube(unbounded));
            for (int channel = 0; channel < 3; ++channel) {
                assert_true(rgb[channel] >= -rounding);
                assert_true(rgb[channel] <= 1.0 + rounding);
            }
            check_close("luminance", luminance(rgb), luminance(unbounded), rounding);
        }
    }
    const Vec3 inside(0.2, 0.9, 0.4);
    assert_true(saturation_within_unit_cube(inside) == 1.0);
    assert_true(with_saturation(inside, 1.0) == inside);
}

// Akenine-Moller, Haines and Hoffman, Real-Time Rendering, 4th ed., table 9.2, computed from other measurements of the
// same metals; those differ among each other by up to 0.06.
void colours_of_metals_are_the_known_ones(void**) {
    const struct {
        const IndexSpectrum& index;
        Vec3 rgb;
    } known[] = {{index_of_gold(), {1.022, 0.782, 0.344}},
                 {index_of_copper(), {0.955, 0.638, 0.538}},
                 {index_of_aluminium(), {0.913, 0.922, 0.924}}};
    for (const auto& metal : known) {
        Spectrum reflectance;
        for (size_t sample = 0; sample < wavelength_count; ++sample)
            reflectance[sample] = fresnel_reflectance(1.0, 1.0, metal.index[sample]);
        for (int channel = 0; channel < 3; ++channel)
            check_close("metal", spectrum_rgb(reflectance)[channel], metal.rgb[channel], 0.06);
    }
}

void tabulated_curves_follow_their_functions(void**) {
    double largest = 0.0;
    for (const auto& flake : {aluminium_flake_reflectance, interference_flake_reflectance}) {
        const CosineCurve<Vec3> curve([&](double cosine) { return spectrum_rgb(flake(cosine)); });
        for (int i = 0; i < 2000; ++i) {
            const double cosine = (i + 0.5) / 2000;
            const Vec3 error = glm::abs(curve(cosine) - spectrum_rgb(flake(cosine)));
            largest = std::fmax(largest, std::fmax(error.r, std::fmax(error.g, error.b)));
        }
        assert_true(curve(1.0) == spectrum_rgb(flake(1.0)));
    }
    print_message("largest error of a tabulated reflectance: %.2g\n", largest);
    assert_true(largest < 1e-3);
}

// The curve of a flake is the spectrum's colour, brought into [0, 1] at unchanged luminance.
void reflectance_curves_stay_between_0_and_1(void**) {
    const ReflectanceCurve curve = reflectance_curve(interference_flake_reflectance);
    bool some_colour_was_outside = false;
    for (int node = 0; node <= 512; ++node) {
        const double cosine = node / 512.0;
        const Vec3 rgb = curve(cosine), unbounded = spectrum_rgb(interference_flake_reflectance(cosine));
        for (int channel = 0; channel < 3; ++channel) {
            assert_true(rgb[channel] >= 0.0 && rgb[channel] <= 1.0);
            if (unbounded[channel] < 0.0) some_colour_was_outside = true;
        }
        check_close("luminance", luminance(rgb), luminance(unbounded), rounding);
    }
    assert_true(some_colour_was_outside);
}

// The projected area of the facets is the area of the surface: the integral of D(h) cos over the hemisphere is 1.
void facet_distributions_are_normalised(void**) {
    constexpr int steps = 20000;  // the midpoint rule's error is (width of a step / width of the lobe)^2, below 1e-4
    for (const double roughness : {0.05, 0.2, 0.5}) {
        double ggx = 0.0, charlie = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double theta = (i + 0.5) / steps * pi / 2;
            const double area = 2 * pi * std::sin(theta) * std::cos(theta) * (pi / 2 / steps);
            ggx += ggx_distribution(std::cos(theta), roughness) * area;
            charlie += charlie_distribution(std::cos(theta), roughness) * area;
        }
        check_close("GGX", ggx, 1.0, 1e-4);
        check_close("Charlie", charlie, 1.0, 1e-4);
    }
}

// Smith: the facets that the eye sees cover the surface's projection, so cos / G1 is the integral of D(h) <o, h>.
double smith_visible_area(double cos_o, double (*distribution)(double, double), double roughness) {
    constexpr int steps = 1000;
    const double sin_o = std::sqrt(1 - cos_o * cos_o);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double theta = (i + 0.5) / steps * pi / 2;
        for (int j = 0; j < steps; ++j) {
            const double phi = (j + 0.5) / steps * pi;
            const double cosine = sin_o * std::sin(theta) * std::cos(phi) + cos_o * std::cos(theta);
            sum += distribution(std::cos(theta), roughness) * std::fmax(cosine, 0.0) * std::sin(theta);
        }
    }
    return sum * (pi / 2 / steps) * (2 * pi / steps);
}

void shadowing_follows_from_the_distributions(void**) {
    for (const double cosine : {0.2, 0.5, 0.9}) {
        // The visibility of light from where the eye is: 1 / (4 cos^2 (1 + 2 Lambda)).
        const double ggx_lambda = smith_visible_area(cosine, ggx_distribution, 0.3) / cosine - 1;
        const double ggx_fold = 4 * cosine * cosine * ggx_visibility(cosine, cosine, 0.3);
        check_close("GGX", ggx_fold, 1 / (1 + 2 * ggx_lambda), 1e-3);

        // The sheen's Lambda is a fit for roughness 0 and 1, interpolated between: near those it follows the integral
        // to 2 percent of G1, at 0.3 to 10.
        for (const double roughness : {0.1, 0.3, 1.0}) {
            const double lambda = smith_visible_area(cosine, charlie_distribution, roughness) / cosine - 1;
            print_message("sheen, roughness %.1f, cos %.1f: Lambda fitted %.3f, integrated %.3f\n", roughness, cosine,
                          charlie_lambda(cosine, roughness), lambda);
            const double seen = 1 / (1 + lambda), seen_by_fit = 1 / (1 + charlie_lambda(cosine, roughness));
            check_close("sheen", seen_by_fit / seen, 1.0, roughness == 0.3 ? 0.1 : 0.02);
        }
    }
}

void refracted_pairs_obey_snell(void**) {
    const double n = 1.5;
    const Vec3 wi = glm::normalize(Vec3(0.5, 0.4, 0.3)), wo = glm::normalize(Vec3(-0.1, 0.7, 0.2));
    const auto refract = [=](const Vec3& w) {
        const Vec2 along = Vec2(w.x, w.y) / n;
        return Vec3(along, std::sqrt(1 - glm::dot(along, along)));
    };
    const DirectionPair expected = DirectionPair::from_directions(refract(wi), refract(wo));
    const DirectionPair found = DirectionPair::from_directions(wi, wo).refracted(n);
    check_close("half", found.cos_half, expected.cos_half, rounding);
    check_close("diff", found.cos_diff, expected.cos_diff, rounding);
    check_close("light", found.cos_i, expected.cos_i, rounding);
    check_close("eye", found.cos_o, expected.cos_o, rounding);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(fresnel_at_normal_incidence),
        cmocka_unit_test(fresnel_at_brewster_angle),
        cmocka_unit_test(everything_is_reflected_at_grazing_and_beyond_the_critical_angle),
        cmocka_unit_test(film_of_no_thickness_is_the_bare_substrate),
        cmocka_unit_test(quarter_wave_and_half_wave_films),
        cmocka_unit_test(two_quarter_waves),
        cmocka_unit_test(opaque_film_hides_the_substrate),
        cmocka_unit_test(diffuse_reflectance_of_a_dielectric),
        cmocka_unit_test(perfect_reflectors_are_white_and_grey),
        cmocka_unit_test(colours_outside_the_primaries_keep_their_luminance),
        cmocka_unit_test(colours_of_metals_are_the_known_ones),
        cmocka_unit_test(tabulated_curves_follow_their_functions),
        cmocka_unit_test(reflectance_curves_stay_between_0_and_1),
        cmocka_unit_test(facet_distributions_are_normalised),
        cmocka_unit_test(shadowing_follows_from_the_distributions),
        cmocka_unit_test(refracted_pairs_obey_snell),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
