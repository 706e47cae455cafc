// The built-in materials as physics demands them: reciprocal, neither negative nor brighter than the light, tabulated
// in the MERL layout, cached without risk.
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <thread>

#include "io/merl.h"
#include "io_testing.h"
#include "materials/builtin_materials.h"
#include "materials/builtin_models.h"
#include "materials/coated_flakes.h"
#include "scene/brdf.h"
#include "scene/table_cells.h"

namespace lightband {
namespace {

using testing::expect_error;
using testing::ScratchFolder;

Vec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Vec3 random_direction(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    return direction(std::acos(unit(random)), 2 * pi * unit(random));
}

void names_are_those_of_the_models(void**) {
    const char* const expected[] = {"interference-paint", "red-car-paint", "rough-gold",   "rough-nickel",
                                    "blue-rubber",        "matte-fabric",  "rough-copper", "satin-white-plastic"};
    assert_int_equal(builtin_models.size(), std::size(expected));
    for (size_t i = 0; i < builtin_models.size(); ++i) assert_string_equal(builtin_models[i].name, expected[i]);
    expect_error(LB_ERROR_INVALID_ARGUMENT, {"\"gold\"", "interference-paint", "satin-white-plastic"},
                 [] { builtin_material("gold", ""); });
}

// Helmholtz: exchanging light and eye changes nothing. The models' sums commute; only contraction into fused
// multiply-adds may round the two sides differently.
void models_are_reciprocal_finite_and_not_negative(void**) {
    constexpr double relative_rounding = 1e-12;
    for (const BuiltinModel& material : builtin_models) {
        const auto model = material.make();
        std::mt19937 random(7);
        for (int i = 0; i < 20000; ++i) {
            const Vec3 wi = random_direction(random), wo = random_direction(random);
            const Vec3 there = model->value(DirectionPair::from_directions(wi, wo));
            const Vec3 back = model->value(DirectionPair::from_directions(wo, wi));
            for (int channel = 0; channel < 3; ++channel) {
                if (!std::isfinite(there[channel]) || there[channel] < 0.0)
                    fail_msg("%s is %g", material.name, there[channel]);
                if (std::fabs(there[channel] - back[channel]) > relative_rounding * there[channel])
                    fail_msg("%s: %.17g there, %.17g back", material.name, there[channel], back[channel]);
            }
        }
    }
}

// The integral of f cos(theta_i) over the light's directions, as one over half vectors: dwi = 4 <o, h> dh. Rings of
// half vectors lie as the square of their number, which resolves the sharpest coat (alpha 0.05) by fifty rings.
Vec3 directional_albedo(const ReflectanceModel& model, double theta_o, int rings) {
    const Vec3 wo = direction(theta_o, 0.0);
    const int turns = rings / 2;
    Vec3 sum(0.0);
    for (int ring = 0; ring < rings; ++ring) {
        const double root = (ring + 0.5) / rings, theta = root * root * pi / 2;
        const double area = std::sin(theta) * (pi * root / rings) * (2 * pi / turns);
        for (int turn = 0; turn < turns; ++turn) {
            const Vec3 half = direction(theta, (turn + 0.5) / turns * pi);
            const double cos_diff = glm::dot(wo, half);
            if (cos_diff <= 0.0) continue;
            const DirectionPair pair = DirectionPair::from_directions(2 * cos_diff * half - wo, wo);
            if (pair.above_horizon()) sum += model.value(pair) * (pair.cos_i * 4 * cos_diff * area);
        }
    }
    return sum;
}

// Energy: no material reflects more than it receives, in any channel, from any direction. The table of
// docs/materials.md is printed here.
void models_conserve_energy(void**) {
    for (const BuiltinModel& material : builtin_models) {
        const auto model = material.make();
        double largest = 0.0;
        for (int degrees = 0; degrees <= 85; degrees += 5) {
            const Vec3 albedo = directional_albedo(*model, degrees * pi / 180, 300);
            for (int channel = 0; channel < 3; ++channel) {
                largest = std::fmax(largest, albedo[channel]);
                if (!(albedo[channel] <= 1.0))
                    fail_msg("%s reflects %g at %d degrees", material.name, albedo[channel], degrees);
            }
            if (degrees == 45)
                print_message("albedo at 45 degrees: %-20s %.3f %.3f %.3f\n", material.name, albedo.x, albedo.y,
                              albedo.z);
        }
        const Vec3 coarse = directional_albedo(*model, pi / 4, 300), fine = directional_albedo(*model, pi / 4, 600);
        print_message("    largest %.3f; halving the quadrature's steps moves it by %.1g\n", largest,
                      glm::length(fine - coarse));
        assert_true(glm::length(fine - coarse) < 1e-3);
    }
}

// The furnace: a white pigment returns all that the coat lets in, and the coat the rest. White flakes return it once:
// F + (1 - F)^2, for what the coat throws back at them is lost.
void white_under_a_clear_coat(void**) {
    // Flakes tilted too far send light beyond the critical angle of 41.8 degrees. Seen at 60 degrees, at 35.3 inside, a
    // tilt of 3.2 is enough; of GGX normals with alpha 0.002 the share 1 / (1 + tan^2(3.2 degrees) / alpha^2) = 0.0013
    // has it.
    constexpr double lobe_tails = 0.0013;
    CoatedFlakesParameters white;
    white.coat_alpha = 0.05;
    white.flake_alpha = 0.002;
    white.tint = Vec3(1.0);
    white.pigment = Vec3(1.0);
    const ReflectanceCurve mirror([](double) { return Vec3(1.0); });
    for (const double degrees : {0.0, 30.0, 60.0}) {
        const double theta_o = degrees * pi / 180;
        const double coat = fresnel_reflectance(std::cos(theta_o), 1.0, CoatedFlakes::coat_index);
        white.flake_coverage = 0.0;
        const double pigment = directional_albedo(CoatedFlakes(white, mirror), theta_o, 600).g;
        white.flake_coverage = 1.0;
        const double flakes = directional_albedo(CoatedFlakes(white, mirror), theta_o, 600).g;
        print_message("white pigment %.4f, white flakes %.4f of %.4f at %.0f degrees\n", pigment, flakes,
                      coat + (1 - coat) * (1 - coat), degrees);
        assert_true(std::fabs(pigment - 1.0) < lobe_tails);
        assert_true(std::fabs(flakes - (coat + (1 - coat) * (1 - coat))) < lobe_tails);
    }
}

// The lobes that make a paint: broad flakes below a narrow coat, brighter than a tenth of it.
void car_paint_has_a_broad_and_a_narrow_lobe(void**) {
    const auto paint = builtin_models[1].make();
    const auto at = [&](double degrees) {
        return paint->value(DirectionPair::from_angles(degrees * pi / 180, 0.1, pi / 2)).r;
    };
    const double peak = at(0), flakes = at(10), rest = at(40);
    assert_true(peak > 3 * flakes);
    assert_true(flakes > 3 * rest);
}

// Hue from green to purple: green leads at normal incidence and is the weakest channel at 70 degrees in air.
void interference_paint_shifts_from_green_to_purple(void**) {
    const ReflectanceCurve flake = reflectance_curve(interference_flake_reflectance);
    const Vec3 normal = flake(1.0);
    const double inside = std::sqrt(1 - std::pow(std::sin(70 * pi / 180) / CoatedFlakes::coat_index, 2));
    const Vec3 grazing = flake(inside);
    print_message("flakes: (%.2f %.2f %.2f) at 0, (%.2f %.2f %.2f) at 70 degrees\n", normal.r, normal.g, normal.b,
                  grazing.r, grazing.g, grazing.b);
    assert_true(normal.g > 2 * normal.r && normal.g > 1.5 * normal.b);
    assert_true(grazing.r > 1.5 * grazing.g && grazing.b > 1.5 * grazing.g);
}

// Light and eye at a place in the table, in cells, built as vectors: the difference vector turned by the half vector's
// angle about y.
void directions_at(double half, double diff, double phi, Vec3* wi, Vec3* wo) {
    const double theta_half = std::pow(half / 90, 2) * pi / 2;
    const Vec3 difference = direction(diff / 90 * pi / 2, phi / 180 * pi);
    const double c = std::cos(theta_half), s = std::sin(theta_half);
    *wi = {c * difference.x + s * difference.z, difference.y, c * difference.z - s * difference.x};
    const Vec3 normal_half(s, 0, c);
    *wo = 2 * glm::dot(*wi, normal_half) * normal_half - *wi;
}

bool corner_above_horizon(uint32_t half, uint32_t diff, uint32_t phi) {
    for (uint32_t corner = 0; corner < 8; ++corner) {
        Vec3 wi, wo;
        directions_at(half + (corner & 1), diff + (corner >> 1 & 1), phi + (corner >> 2), &wi, &wo);
        if (std::fmin(wi.z, wo.z) > 1e-12) return true;
    }
    return false;
}

void tables_hold_the_models_at_cell_centres(void**) {
    // A float's rounding, and that of cosines near zero where the centre comes within 1e-4 of the horizon.
    constexpr double relative_rounding = 1e-6;
    for (const BuiltinModel& material : builtin_models) {
        const auto start = std::chrono::steady_clock::now();
        const BrdfTable table = builtin_material(material.name, "");
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        print_message("%s: computed in %.2f s\n", material.name, seconds.count());
        assert_int_equal(table.rgb.size(), BrdfTable::cell_count * 3);

        const auto model = material.make();
        std::mt19937 random(3);
        int below = 0, across = 0;
        for (int i = 0; i < 50000; ++i) {
            const uint32_t half = random() % 90, diff = random() % 90, phi = random() % 180;
            Vec3 wi, wo;
            directions_at(half + 0.5, diff + 0.5, phi + 0.5, &wi, &wo);
            const float* rgb = &table.rgb[3 * BrdfTable::cell(half, diff, phi)];
            if (std::fmin(wi.z, wo.z) <= 0) {
                // The models are bright everywhere; a cell is empty if all of it lies below the horizon, and only then.
                const bool reached = corner_above_horizon(half, diff, phi);
                ++(reached ? across : below);
                if ((rgb[1] > 0) != reached || (rgb[1] == -1) == reached)
                    fail_msg("%s: cell (%u, %u, %u) holds %g", material.name, half, diff, phi, double(rgb[1]));
                continue;
            }
            for (int channel = 0; channel < 3; ++channel) {
                const double expected = model->value(DirectionPair::from_directions(wi, wo))[channel];
                const double found = rgb[channel];
                if (!(std::fabs(found - expected) <= relative_rounding * std::fabs(expected)))
                    fail_msg("%s: cell (%u, %u, %u) holds %g, the model says %g", material.name, half, diff, phi, found,
                             expected);
            }
        }
        assert_in_range(below, 10000, 40000);
        assert_in_range(across, 100, 1000);  // 1.2 % of all cells
    }
}

// Up to the horizon a table reflects what its model does, as far as cells of one degree can follow it. At 89.99 degrees
// the table of the sharpest lobe, a coat of alpha 0.05 that grows within the last cell, reflects 8.7 % less than its
// model; cloth, whose sheen loses a tenth of its light in the last tenth of a degree, 13 to 16 % more.
void tables_keep_their_albedo_to_grazing(void**) {
    constexpr double least = 0.9, most = 1.18;
    for (const BuiltinModel& material : builtin_models) {
        const auto model = material.make();
        const Brdf table = builtin_material(material.name, "");
        for (const double degrees : {80.0, 89.0, 89.5, 89.9, 89.99}) {
            const double theta = degrees * pi / 180;
            const Vec3 found = directional_albedo(table, theta), expected = directional_albedo(*model, theta, 1000);
            print_message("%-20s %5.2f degrees: (%.3f %.3f %.3f) of (%.3f %.3f %.3f)\n", material.name, degrees,
                          found.x, found.y, found.z, expected.x, expected.y, expected.z);
            for (int c = 0; c < 3; ++c)
                if (!(found[c] >= least * expected[c] && found[c] <= most * expected[c] && found[c] <= 1))
                    fail_msg("%s reflects %g of %g at %g degrees", material.name, found[c], expected[c], degrees);
        }
    }
}

// Cells that lie mirrored in phi_diff have light and eye exchanged, also where the horizon crosses them and the value
// is that of a place beside the centre. A table is made of one half of the cells and its mirror image, so that the
// model is asked about each of them here.
void tables_are_reciprocal_across_the_horizon(void**) {
    // Of cosines near zero: the middle of what lies above the horizon is found to 5e-13 of the cell's diagonal.
    constexpr double relative_rounding = 1e-6;
    for (const BuiltinModel& material : builtin_models) {
        const auto model = material.make();
        int across = 0;
        for (size_t cell = 0; cell < BrdfTable::cell_count; ++cell) {
            const TableCell place = TableCell::numbered(cell);
            if (!place.reaches_above_horizon() || place.centre().lower_cosine() > 0) continue;
            const size_t mirror =
                BrdfTable::cell(place.theta_half, place.theta_diff, BrdfTable::phi_diff_cells - 1 - place.phi_diff);
            const Vec3 there = cell_value(*model, cell), back = cell_value(*model, mirror);
            for (int c = 0; c < 3; ++c)
                if (!(std::fabs(there[c] - back[c]) <= relative_rounding * std::fabs(there[c])))
                    fail_msg("%s, cell %zu: %g there, %g back", material.name, cell, there[c], back[c]);
            ++across;
        }
        assert_true(across > 0);
    }
}

bool same(const BrdfTable& a, const BrdfTable& b) {
    return a.rgb.size() == b.rgb.size() && std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(float)) == 0;
}

BrdfTable cached(const std::string& file) {
    assert_true(std::filesystem::exists(file));
    return io::read_merl(file);
}

void cache_keeps_the_table(void**) {
    ScratchFolder scratch;
    const std::string folder = scratch.file("made/on/demand");
    const BrdfTable computed = builtin_material("rough-gold", "");
    assert_true(same(builtin_material("rough-gold", folder), computed));
    const std::string file = folder + "/rough-gold-v2.binary";
    assert_true(same(cached(file), computed));

    // A second call takes what the file says, here within what two builds may differ by.
    BrdfTable nudged = computed;
    for (float& value : nudged.rgb)
        if (value > 0) value *= 1.000002f;
    io::write_merl(file, nudged);
    assert_true(same(builtin_material("rough-gold", folder), nudged));
}

void damaged_caches_are_replaced(void**) {
    ScratchFolder scratch;
    const std::string folder = scratch.file("");
    const std::string file = scratch.file("rough-nickel-v2.binary");
    const BrdfTable computed = builtin_material("rough-nickel", folder);
    const auto expect_repair = [&] {
        assert_true(same(builtin_material("rough-nickel", folder), computed));
        assert_true(same(io::read_merl(file), computed));
    };

    std::filesystem::resize_file(file, 1000);
    expect_repair();
    std::filesystem::resize_file(file, 0);
    expect_repair();
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).write("no table", 8);
    expect_repair();
    io::write_merl(file, builtin_material("rough-gold", ""));  // a sound table of something else
    expect_repair();
    assert_int_equal(scratch.entries(), 1);
}

void a_useless_cache_folder_costs_time_alone(void**) {
    ScratchFolder scratch;
    const BrdfTable computed = builtin_material("blue-rubber", "");
    std::ofstream(scratch.file("file")) << "not a folder";
    assert_true(same(builtin_material("blue-rubber", scratch.file("file")), computed));
    assert_true(same(builtin_material("blue-rubber", scratch.file("file/below")), computed));
    std::filesystem::create_directories(scratch.file("blue-rubber-v2.binary"));  // a folder where the file should be
    assert_true(same(builtin_material("blue-rubber", scratch.file("")), computed));
}

void two_may_fill_one_cache_at_once(void**) {
    ScratchFolder scratch;
    BrdfTable first, second;
    std::thread other([&] { first = builtin_material("rough-copper", scratch.file("")); });
    second = builtin_material("rough-copper", scratch.file(""));
    other.join();
    assert_true(same(first, second));
    assert_true(same(cached(scratch.file("rough-copper-v2.binary")), first));
    assert_int_equal(scratch.entries(), 1);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(names_are_those_of_the_models),
        cmocka_unit_test(models_are_reciprocal_finite_and_not_negative),
        cmocka_unit_test(models_conserve_energy),
        cmocka_unit_test(white_under_a_clear_coat),
        cmocka_unit_test(car_paint_has_a_broad_and_a_narrow_lobe),
        cmocka_unit_test(interference_paint_shifts_from_green_to_purple),
        cmocka_unit_test(tables_hold_the_models_at_cell_centres),
        cmocka_unit_test(tables_keep_their_albedo_to_grazing),
        cmocka_unit_test(tables_are_reciprocal_across_the_horizon),
        cmocka_unit_test(cache_keeps_the_table),
        cmocka_unit_test(damaged_caches_are_replaced),
        cmocka_unit_test(a_useless_cache_folder_costs_time_alone),
        cmocka_unit_test(two_may_fill_one_cache_at_once),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
