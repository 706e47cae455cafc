// Small bright sources of a map become suns of the same light.
#include <cmath>

#include "bandwidth/disc_bandwidth.h"
#include "numeric_testing.h"
#include "sampling/bright_sources.h"
#include "scene/environment.h"

namespace lightband {
namespace {

using namespace testing;

struct Disc {
    Vec3 direction;
    double half_angle, radiance;
};

RgbImage sky(uint32_t height, double radiance, const std::vector<Disc>& discs) {
    RgbImage map{2 * height, height, {}, {}};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < 2 * height; ++x) {
            const Vec3 d = direction_of(Vec2((x + 0.5) / (2 * height), (y + 0.5) / height));
            double value = radiance;
            for (const Disc& disc : discs)
                if (glm::dot(d, disc.direction) > std::cos(disc.half_angle)) value = disc.radiance;
            map.rgb.insert(map.rgb.end(), 3, float(value));
        }
    return map;
}

const Vec3 right = glm::normalize(Vec3(1, 0.5, 0.2)), left = glm::normalize(Vec3(-0.3, -0.2, 0.9));

// The integral of radiance over all directions.
Vec3 flux_of(const RgbImage& map, Lookup lookup) {
    Vec3 flux(0);
    for (uint32_t y = 0; y < map.height; ++y)
        for (uint32_t x = 0; x < map.width; ++x)
            for (int c = 0; c < 3; ++c)
                flux[c] += double(map.texel(x, y)[c]) * lookup_solid_angle(map.width, map.height, y, lookup);
    return flux;
}

// Discs of 0.01 in texels of 0.003: a texel off in direction and in radius.
void discs_are_found(void**) {
    const double texel = pi / 1024;
    const RgbImage map = sky(1024, 1, {{right, 0.01, 2e5}, {left, 0.01, 1e5}});
    for (const Lookup lookup : {Lookup::linear, Lookup::nearest}) {
        const BrightSources found = split_bright_sources(map, 1, lookup);
        assert_int_equal(found.suns.size(), 2);
        for (size_t i = 0; i < 2; ++i) {
            check_at_most("distance", glm::length(found.suns[i].direction - (i == 0 ? right : left)), texel);
            check_close("radius", found.suns[i].angular_radius, 0.01, texel);
            check_close("radiance", found.suns[i].radiance().x / (i == 0 ? 2e5 : 1e5), 1, 0.2);
        }
        for (const float value : found.rest.rgb) assert_true(value == 1);
    }
}

// To 1e-6 of each channel, for texels of whatever colour at the poles and at the seam.
void light_is_kept(void**) {
    for (const uint32_t height : {160u, 256u})
        for (const Lookup lookup : {Lookup::linear, Lookup::nearest})
            for (const uint32_t row : {0u, height / 2, height - 1})
                for (const uint32_t column : {0u, height, 2 * height - 1}) {
                    RgbImage map = sky(height, 0.3, {});
                    const float colour[3] = {1e8f, 3e6f, 0.1f};
                    for (size_t c = 0; c < 3; ++c) map.rgb[(size_t(row) * map.width + column) * 3 + c] = colour[c];
                    const BrightSources found = split_bright_sources(map, 1, lookup);
                    assert_int_equal(found.suns.size(), 1);
                    Vec3 after = flux_of(found.rest, lookup);
                    const Vec3 before = flux_of(map, lookup);
                    for (const Sun& sun : found.suns) after += sun.radiance() * sun.solid_angle();
                    for (int c = 0; c < 3; ++c) check_close("flux", after[c] / before[c], 1, 1e-6);
                }
}

// The weights of lookups of a map of ones are those of the whole sphere.
void lookups_cover_the_sphere(void**) {
    for (const uint32_t height : {1u, 2u, 3u, 17u})
        for (const Lookup lookup : {Lookup::linear, Lookup::nearest}) {
            double sum = 0;
            for (uint32_t y = 0; y < height; ++y) sum += 5 * lookup_solid_angle(5, height, y, lookup);
            check_close("solid angle", sum, 4 * pi, 1e-12);
        }
}

// Half of what comes from elsewhere: a disc of pi 0.01^2 under a sky of 4 pi.
void what_is_not_bright_beside_the_sky_stays(void**) {
    for (const double share : {0.4, 0.6}) {
        const double radiance = share * 4 * pi / (pi * 0.01 * 0.01);
        assert_int_equal(split_bright_sources(sky(2048, 1, {{right, 0.01, radiance}}), 1, Lookup::linear).suns.size(),
                         share > 0.5 ? 1 : 0);
    }
}

void wide_lights_stay(void**) {
    for (const uint32_t height : {1u, 2u, 8u, 16u, 64u, 128u}) {
        RgbImage map = sky(height, 0, {});
        map.rgb[height / 2 * map.width * 3] = 1;
        assert_int_equal(bright_sources(map, 1, Lookup::linear).size(), 1);
        assert_int_equal(split_bright_sources(map, 1, Lookup::linear).suns.size(), 0);
    }
    assert_int_equal(split_bright_sources(sky(256, 1e-3, {{right, 0.3, 1}}), 1, Lookup::linear).suns.size(), 0);
}

void a_texel_in_the_dark_is_a_sun(void**) {
    RgbImage map = sky(1, 0, {});
    assert_int_equal(split_bright_sources(map, 1, Lookup::linear).suns.size(), 0);
    map = sky(256, 0, {});
    map.rgb[3 * (200 * 512 + 7) + 1] = 1e-30f;
    const BrightSources found = split_bright_sources(map, 1, Lookup::linear);
    assert_int_equal(found.suns.size(), 1);
    const Vec3 direction = direction_of(Vec2(7.5 / 512, 200.5 / 256));
    check_close("distance", glm::length(found.suns[0].direction - direction), 0, 1e-12);
    // The mean square of the distance from the middle of the pyramid that linear lookup makes of a texel, a sixth of
    // its width each way.
    const double width = pi / 256, across = std::sqrt(1 - direction.y * direction.y);
    check_close("radius", found.suns[0].angular_radius, width * std::sqrt((1 + across * across) / 3), 1e-12);
}

// A disc of radiance 1: its flux is its solid angle, and its irradiance on a surface that faces it pi sin^2.
void a_sun_is_a_disc(void**) {
    for (const double radius : {Sun::least_radius, 0.0047, 0.5, Sun::largest_radius}) {
        Sun sun;
        sun.direction = right;
        sun.angular_radius = radius;
        sun.irradiance = Vec3(pi * std::sin(radius) * std::sin(radius));
        check_close("radiance", sun.radiance().x, 1, 1e-12);
        double cosines = 0;
        const int side = 64;
        for (int i = 0; i < side * side; ++i) {
            const Vec3 d = sun.sample(Vec2((i % side + 0.5) / side, (i / side + 0.5) / side));
            check_close("length", glm::length(d), 1, 1e-12);
            assert_true(sun.contains(d));
            cosines += glm::dot(d, right) / (side * side);
        }
        check_close("irradiance", cosines * sun.solid_angle(), sun.irradiance.x, 1e-4 * sun.irradiance.x);
        const double within = std::acos(glm::dot(sun.sample(Vec2(1 - 1e-12, 0.3)), right));
        check_close("edge", within, radius, 1e-3 * radius);
    }
}

// 95 % of the energy of the disc's spectrum 2 J1(x) / x lies below x = 2 pi a nu; and beyond the other rule's, no
// amplitude exceeds a hundredth.
void a_discs_bandwidth_is_that_of_its_spectrum(void**) {
    const double x = 2 * pi * 0.01 * disc_bandwidth(0.01, BandRule::energy),
                 y = 2 * pi * disc_bandwidth(1, BandRule::sum);
    const double beyond = std::pow(std::cyl_bessel_j(0, x), 2) + std::pow(std::cyl_bessel_j(1, x), 2);
    check_close("energy beyond", beyond, 0.05, 0.002);
    for (double at = y; at < 10 * y; at += 0.1)
        check_at_most("amplitude", std::abs(2 * std::cyl_bessel_j(1, at) / at), 0.01);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(discs_are_found),          cmocka_unit_test(light_is_kept),
        cmocka_unit_test(lookups_cover_the_sphere), cmocka_unit_test(what_is_not_bright_beside_the_sky_stays),
        cmocka_unit_test(wide_lights_stay),         cmocka_unit_test(a_texel_in_the_dark_is_a_sun),
        cmocka_unit_test(a_sun_is_a_disc),          cmocka_unit_test(a_discs_bandwidth_is_that_of_its_spectrum),
    };
    return cmocka_run_group_tests_name("bright sources", tests, nullptr, nullptr);
}
