// The tree of the light above soft ceilings: all of the light and nothing else, in compact parts, at every depth.
#include "numeric_testing.h"
#include "sampling/light_tree.h"
#include "scene/environment.h"

namespace lightband {
namespace {

using namespace testing;

RgbImage noisy_map(uint32_t width, uint32_t height, uint64_t seed) {
    Random random(seed);
    RgbImage map{width, height, {}, {}};
    for (uint32_t i = 0; i < 3 * width * height; ++i) map.rgb.push_back(float(random.log_uniform(0.01, 100)));
    return map;
}

Vec3 flux_of(const LightPart& part, uint32_t layer) {
    return {part.flux[layer].rgb[0], part.flux[layer].rgb[1], part.flux[layer].rgb[2]};
}

Vec3 direction_of_part(const LightPart& part) { return {part.direction[0], part.direction[1], part.direction[2]}; }

Vec3 all_flux(const LightTree& tree, const LightTree::Trunk& trunk, uint32_t depth, uint32_t layer) {
    Vec3 sum(0);
    for (uint32_t i = trunk.first; i < trunk.first + trunk.count; ++i)
        for (uint32_t place = 1u << depth; place < 2u << depth; ++place) sum += flux_of(tree.parts[LightTree::index(i, place)], layer);
    return sum;
}

// The integral of the radiance above a ceiling, by many evenly spread lookups.
Vec3 light_above(const RgbImage& map, const MapSampler& sampler, Lookup lookup, uint32_t layer) {
    constexpr int columns = 2048, rows = 1024;
    Vec3 sum(0);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const Vec3 d = direction_of(Vec2((i + 0.5) / columns, (j + 0.5) / rows));
            const double density = lookup == Lookup::linear ? sampler.interpolated_pdf(d) : sampler.pdf(d);
            const double solid_angle = 2 * pi / columns * (std::cos(pi * j / rows) - std::cos(pi * (j + 1.0) / rows));
            sum += solid_angle * Ceilings::part_above(layer, density) * radiance(map, d, lookup) / sampler.unit();
        }
    return sum;
}

void parts_hold_all_light_above_the_ceilings(void**) {
    for (const Lookup lookup : {Lookup::nearest, Lookup::linear})
        for (const uint32_t width : {1u, 8u, 64u, 512u}) {
            const RgbImage map = noisy_map(width, std::max(1u, width / 2), width);
            const MapSampler sampler(map);
            const LightTree tree = light_tree(map, sampler, lookup);
            for (const uint32_t layer : {0u, 3u}) {
                const Vec3 expected = light_above(map, sampler, lookup, layer);
                // Both quadratures cut texels evenly: nearest lookups they integrate exactly, but for where they take the sine of the
                // polar angle. Of linear ones, what lies above a ceiling goes with the square of the radiance where that is low: of the square
                // of a linear function between two texels, cells of half a texel miss a sixteenth at most.
                for (const LightTree::Trunk& trunk : LightTree::trunks)
                    for (const uint32_t depth : {0u, 1u, LightTree::depth}) {
                        const Vec3 found = all_flux(tree, trunk, depth, layer);
                        for (int c = 0; c < 3; ++c)
                            check_close("flux over expected", found[c] / expected[c], 1, lookup == Lookup::nearest ? 1e-3 : 1.0 / 16);
                    }
            }
        }
}

void parts_are_unit_cones_around_their_light(void**) {
    const RgbImage map = noisy_map(64, 32, 5);
    const LightTree tree = light_tree(map, MapSampler(map), Lookup::linear);
    for (uint32_t i = 0; i < LightTree::trunk_parts; ++i)
        for (uint32_t place = 1; place < LightTree::heap; ++place) {
            const LightPart& part = tree.parts[LightTree::index(i, place)];
            if (part.flux[0].spread == 0) continue;
            check_close("length", glm::length(direction_of_part(part)), 1, 1e-6);
            // Ceilings rise, what is above them falls; half of a part is no wider than the part, within float's rounding.
            for (uint32_t layer = 1; layer < Ceilings::count; ++layer)
                check_at_most("flux", luminance(flux_of(part, layer)), luminance(flux_of(part, layer - 1)));
            if (place == 1) continue;
            const LightPart& whole = tree.parts[LightTree::index(i, place / 2)];
            check_at_most("spread", part.flux[0].spread, whole.flux[0].spread * (1 + 1e-5));
            const double cosine = glm::dot(direction_of_part(part), direction_of_part(whole));
            if (whole.sine < 1) check_at_most("sine of the way", std::sqrt(std::max(0.0, 1 - cosine * cosine)), whole.sine + 1e-3);
        }
}

// What a matte surface reflects is the same by the tree's finest parts and by brute force: parts some degrees wide err by their second
// order, (0.05 radians)^2 / 24 and less.
void a_fine_cut_is_the_integral(void**) {
    const RgbImage map = noisy_map(64, 32, 6);
    const MapSampler sampler(map);
    const LightTree tree = light_tree(map, sampler, Lookup::linear);
    Random random(7);
    for (int k = 0; k < 20; ++k) {
        const Vec3 normal = random.direction();
        const LightTree::Trunk& trunk = LightTree::trunks[k % 2];
        double found = 0, expected = 0;
        for (uint32_t i = trunk.first; i < trunk.first + trunk.count; ++i)
            for (uint32_t place = 1u << LightTree::depth; place < LightTree::heap; ++place) {
                const LightPart& part = tree.parts[LightTree::index(i, place)];
                found += std::max(0.0, glm::dot(direction_of_part(part), normal)) * luminance(flux_of(part, 0));
            }
        constexpr int columns = 512, rows = 256;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                const Vec3 d = direction_of(Vec2((i + 0.5) / columns, (j + 0.5) / rows));
                const double solid_angle = 2 * pi / columns * (std::cos(pi * j / rows) - std::cos(pi * (j + 1.0) / rows));
                expected += solid_angle * std::max(0.0, glm::dot(d, normal)) * Ceilings::part_above(0, sampler.interpolated_pdf(d)) *
                            luminance(radiance(map, d, Lookup::linear)) / sampler.unit();
            }
        check_close("irradiance", found / expected, 1, 5e-3);
    }
}

void one_lamp_is_one_place(void**) {
    RgbImage map{128, 64, std::vector<float>(3 * 128 * 64, 0), {}};
    const uint32_t x = 31, y = 20;
    for (int c = 0; c < 3; ++c) map.rgb[3 * (y * 128 + x) + c] = 1e6f;
    const MapSampler sampler(map);
    const LightTree tree = light_tree(map, sampler, Lookup::nearest);
    const Vec3 lamp = direction_of(Vec2((x + 0.5) / 128, (y + 0.5) / 64));
    const double expected = 1e6 / sampler.unit() * 2 * pi / 128 * (std::cos(pi * y / 64) - std::cos(pi * (y + 1) / 64));
    for (uint32_t k = 0; k <= 2 * LightTree::depth + 1; ++k) {
        const uint32_t depth = k / 2;
        const LightTree::Trunk& trunk = LightTree::trunks[k % 2];
        double all = 0;
        for (uint32_t i = trunk.first; i < trunk.first + trunk.count; ++i)
            for (uint32_t place = 1u << depth; place < 2u << depth; ++place) {
                const LightPart& part = tree.parts[LightTree::index(i, place)];
                if (luminance(flux_of(part, 0)) == 0) continue;
                all += luminance(flux_of(part, 0));
                // A texel is 2.8 degrees wide: no part of it, also of the blocks it is cut into, lies farther than half its diagonal from
                // its middle.
                check_at_most("off the lamp", std::acos(std::min(1.0, glm::dot(direction_of_part(part), lamp))),
                              0.5 * std::sqrt(2.0) * 2 * pi / 128);
            }
        check_close("flux", all / expected, 1, 1e-3);
    }
}

void a_black_map_has_no_light(void**) {
    const RgbImage map{8, 4, std::vector<float>(3 * 8 * 4, 0), {}};
    const LightTree tree = light_tree(map, MapSampler(map), Lookup::linear);
    assert_int_equal(tree.parts.size(), size_t(LightTree::trunk_parts) * LightTree::heap);
    for (const LightPart& part : tree.parts)
        for (const LightPart::Flux& flux : part.flux) assert_true(flux.rgb[0] == 0 && flux.spread == 0);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(parts_hold_all_light_above_the_ceilings), cmocka_unit_test(parts_are_unit_cones_around_their_light),
        cmocka_unit_test(a_fine_cut_is_the_integral),              cmocka_unit_test(one_lamp_is_one_place),
        cmocka_unit_test(a_black_map_has_no_light),
    };
    return cmocka_run_group_tests_name("light_tree", tests, nullptr, nullptr);
}
