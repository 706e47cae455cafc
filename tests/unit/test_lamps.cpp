// Lamps of a map: small, and bright beside all that is none.
#include "numeric_testing.h"
#include "sampling/lamps.h"
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

// Of discs of 0.01, in texels of 0.003: a texel off in direction, and in size, that of the texel which lookups add included.
void suns_are_found(void**) {
    const double texel = pi / 1024;
    const std::vector<Lamp> found = lamps(sky(1024, 1, {{right, 0.01, 2e5}, {left, 0.01, 1e5}}), 1);
    assert_int_equal(found.size(), 2);
    for (size_t i = 0; i < 2; ++i) {
        // The brightest texel of a disc is any of it.
        check_at_most("distance", glm::length(found[i].direction - (i == 0 ? right : left)), 0.01 + texel);
        assert_true(found[i].size > 0.01 && found[i].size < std::sqrt(2.0) * 2 * 0.01 + 2 * texel);
    }
}

// Half of what comes from elsewhere: a disc of pi 0.01^2 under a sky of 4 pi.
void what_is_not_bright_beside_the_sky_is_none(void**) {
    for (const double share : {0.4, 0.6}) {
        const double radiance = share * 4 * pi / (pi * 0.01 * 0.01);
        assert_int_equal(lamps(sky(2048, 1, {{right, 0.01, radiance}}), 1).size(), share > 0.5 ? 1 : 0);
    }
}

void wide_lights_are_none(void**) { assert_int_equal(lamps(sky(256, 1e-3, {{right, 0.3, 1}}), 1).size(), 0); }

void a_texel_in_the_dark_is_one(void**) {
    RgbImage map = sky(1, 0, {});
    assert_int_equal(lamps(map, 1).size(), 0);
    map = sky(16, 0, {});
    map.rgb[3 * (13 * 32 + 7) + 1] = 1e-30f;
    const std::vector<Lamp> found = lamps(map, 1);
    assert_int_equal(found.size(), 1);
    check_close("distance", glm::length(found[0].direction - direction_of(Vec2(7.5 / 32, 13.5 / 16))), 0, 1e-12);
    check_close("size", found[0].size, pi / 16, 1e-12);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(suns_are_found),
        cmocka_unit_test(what_is_not_bright_beside_the_sky_is_none),
        cmocka_unit_test(wide_lights_are_none),
        cmocka_unit_test(a_texel_in_the_dark_is_one),
    };
    return cmocka_run_group_tests_name("lamps", tests, nullptr, nullptr);
}
