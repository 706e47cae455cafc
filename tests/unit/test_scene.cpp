// What the user describes: reflectances, maps, cameras.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include "brdf_testing.h"
#include "numeric_testing.h"
#include "scene/brdf.h"
#include "scene/camera.h"
#include "scene/environment.h"
#include "scene/table_cells.h"
#include "scene/unmeasured_cells.h"

namespace lightband {
namespace {

using namespace testing;

const float not_a_number = std::numeric_limits<float>::quiet_NaN();
const float infinite_float = std::numeric_limits<float>::infinity();

// ---- Reflectance -------------------------------------------------------------------------------------

// A pair by its angles, both directions above the horizon and off the poles where azimuths have no meaning.
struct AngledPair {
    double theta_half, theta_diff, phi_diff;
    Pair pair;
};

AngledPair random_pair(Random& random) {
    for (;;) {
        const double h = random.uniform(0.01, 1.5), d = random.uniform(0.01, 1.5), p = random.uniform(0, 2 * pi);
        const Pair pair = directions_of(h, d, p, random.uniform(0, 2 * pi));
        if (pair.wi.z > 1e-3 && pair.wo.z > 1e-3) return {h, d, p, pair};
    }
}

// An azimuth is known to the rounding of its sine's two factors, each at least 0.01: 1e-16 / 1e-4, a few times over, of
// a radian, which is 57 cells.
constexpr double cell_rounding = 1e-9;

void coordinates_are_rusinkiewicz_angles(void**) {
    Random random(21);
    for (int i = 0; i < 10000; ++i) {
        const AngledPair at = random_pair(random);
        const TableCoordinates found = table_coordinates(at.pair.wi, at.pair.wo);
        check_close("theta_half", found.theta_half, 90 * std::sqrt(at.theta_half / (pi / 2)), cell_rounding);
        check_close("theta_diff", found.theta_diff, 90 * at.theta_diff / (pi / 2), cell_rounding);
        check_close("phi_diff", found.phi_diff, 180 * std::fmod(at.phi_diff, pi) / pi, cell_rounding);
    }
}

void coordinates_stay_inside_the_table(void**) {
    const auto check_inside = [](const Vec3& wi, const Vec3& wo) {
        const TableCoordinates at = table_coordinates(wi, wo);
        assert_true(at.theta_half >= 0 && at.theta_half <= 90);
        assert_true(at.theta_diff >= 0 && at.theta_diff <= 90);
        assert_true(at.phi_diff >= 0 && at.phi_diff < 180);
    };
    const Vec3 up(0, 0, 1);
    check_inside(up, up);
    for (const double angle : {1e-300, 1e-9, 0.3, pi / 2 - 1e-9})
        for (int quarter = 0; quarter < 8; ++quarter) {
            const Vec3 tilted = turn_about_z(Vec3(std::sin(angle), 0, std::cos(angle)), quarter * pi / 4);
            check_inside(tilted, up);
            check_inside(up, tilted);
            check_inside(tilted, tilted);
            check_inside(tilted, Vec3(-tilted.x, -tilted.y, tilted.z));
        }
}

// A table whose cells all differ: equal values mean equal cells.
const BrdfTable& numbered_table() {
    static const BrdfTable table = [] {
        BrdfTable numbered;
        for (size_t i = 0; i < BrdfTable::cell_count * 3; ++i) numbered.rgb.push_back(float(i));
        return numbered;
    }();
    return table;
}

bool near_border(const Pair& pair) {
    const TableCoordinates at = table_coordinates(pair.wi, pair.wo);
    for (const double place : {at.theta_half, at.theta_diff, at.phi_diff})
        if (std::fabs(place - std::round(place)) < 1e-9) return true;
    return false;
}

void tables_are_reciprocal_and_isotropic(void**) {
    const Brdf brdf = numbered_table();
    Random random(22);
    for (int i = 0; i < 10000; ++i) {
        const Pair pair = random_pair(random).pair;
        if (near_border(pair)) continue;
        const Vec3 value = evaluate(brdf, pair.wi, pair.wo);
        check_vector("reciprocity", evaluate(brdf, pair.wo, pair.wi), value, 0);
        const double turn = random.uniform(0, 2 * pi);
        check_vector("isotropy", evaluate(brdf, turn_about_z(pair.wi, turn), turn_about_z(pair.wo, turn)), value, 0);
    }
}

// At a cell's centre both lookups give the cell; midway between two centres the linear one gives their mean.
void linear_lookup_meets_the_centres(void**) {
    BrdfTable table = numbered_table();
    const Brdf brdf = table;
    const auto at = [](double h, double d, double p) {
        return directions_of(std::pow(h / 90, 2) * pi / 2, d / 90 * pi / 2, p / 180 * pi);
    };
    const float* rgb = &table.rgb[BrdfTable::cell(30, 20, 70) * 3];
    const float* next_rgb = &table.rgb[BrdfTable::cell(30, 20, 71) * 3];
    const Vec3 here(rgb[0], rgb[1], rgb[2]), next(next_rgb[0], next_rgb[1], next_rgb[2]);
    const Pair centre = at(30.5, 20.5, 70.5), middle = at(30.5, 20.5, 71);
    // The cells' numbers reach 4e6 and change by up to 5e4 a cell, times the rounding of the coordinates.
    constexpr double tolerance = 5e4 * cell_rounding;
    check_vector("nearest", evaluate(brdf, centre.wi, centre.wo, Lookup::nearest), here, 0);
    check_vector("linear", evaluate(brdf, centre.wi, centre.wo, Lookup::linear), here, tolerance);
    check_vector("between", evaluate(brdf, middle.wi, middle.wo, Lookup::linear), 0.5 * (here + next), tolerance);
}

void linear_lookup_wraps_phi_and_skips_unmeasured_cells(void**) {
    BrdfTable table;
    table.rgb.assign(BrdfTable::cell_count * 3, 1.0f);
    const auto set = [&](uint32_t phi, float value) {
        for (uint32_t h = 29; h <= 31; ++h)
            for (uint32_t d = 19; d <= 21; ++d) std::fill_n(&table.rgb[BrdfTable::cell(h, d, phi) * 3], 3, value);
    };
    set(0, 3.0f);
    set(179, 5.0f);
    set(70, -1.0f);
    set(71, 7.0f);
    set(90, -1.0f);
    set(91, -1.0f);
    const auto value = [&](double phi, Lookup lookup) {
        const Pair pair = directions_of(std::pow(30.5 / 90, 2) * pi / 2, 20.5 / 90 * pi / 2, phi / 180 * pi);
        return evaluate(Brdf(table), pair.wi, pair.wo, lookup).x;
    };
    check_close("across 0", value(0, Lookup::linear), 4, 1e-9);
    check_close("across 180", value(179.75, Lookup::linear), 0.75 * 5 + 0.25 * 3, 1e-9);
    check_close("beside a hole", value(71, Lookup::linear), 7, 1e-9);
    check_close("in a hole, nearest", value(70.5, Lookup::nearest), 0, 0);
    check_close("in a hole, linear", value(91, Lookup::linear), 0, 0);
}

// ---- Unmeasured cells --------------------------------------------------------------------------------

void set_cell(BrdfTable& table, uint32_t h, uint32_t d, uint32_t p, float value) {
    std::fill_n(&table.rgb[3 * BrdfTable::cell(h, d, p)], 3, value);
}

float value_of(const BrdfTable& table, uint32_t h, uint32_t d, uint32_t p) {
    return table.rgb[3 * BrdfTable::cell(h, d, p)];
}

// A matte surface of which nothing was measured within 10 degrees of the horizon: it is whole again.
void unmeasured_grazing_cells_of_a_matte_surface_are_filled(void**) {
    const double least_cosine = std::cos(80 * pi / 180);
    BrdfTable table;
    table.rgb.resize(BrdfTable::cell_count * 3);
    size_t unmeasured = 0;
    for (size_t cell = 0; cell < BrdfTable::cell_count; ++cell) {
        const TableCell at = TableCell::numbered(cell);
        const bool measured = at.centre().lower_cosine() > least_cosine;
        std::fill_n(&table.rgb[3 * cell], 3, measured ? float(0.9 / pi) : -1.0f);
        unmeasured += !measured && at.reaches_above_horizon() ? 1 : 0;
    }
    check_vector("before", directional_albedo(table, 85 * pi / 180), Vec3(0), 0);
    const UnmeasuredCells count = fill_unmeasured_cells(table);
    assert_int_equal(count.filled, unmeasured);
    assert_int_equal(count.left, 0);
    for (const double degrees : {45.0, 80.0, 85.0, 89.5, 89.99})
        check_vector("filled", directional_albedo(table, degrees * pi / 180), Vec3(0.9), 1e-5);
    for (size_t cell = 0; cell < BrdfTable::cell_count; ++cell)
        assert_true(TableCell::numbered(cell).reaches_above_horizon() == (table.rgb[3 * cell] >= 0));
    assert_int_equal(fill_unmeasured_cells(table).filled, 0);
}

void holes_are_filled_along_their_arc(void**) {
    BrdfTable table;
    table.rgb.assign(BrdfTable::cell_count * 3, 1.0f);
    for (const uint32_t d : {0, 1, 41, 42, 43}) set_cell(table, 5, d, 60, -1);
    set_cell(table, 5, 2, 60, 3);
    set_cell(table, 5, 44, 60, 9);
    const UnmeasuredCells count = fill_unmeasured_cells(table);
    assert_int_equal(count.filled, 5);
    assert_int_equal(count.left, 0);
    for (const uint32_t d : {0, 1}) check_close("before the first", value_of(table, 5, d, 60), 3, 0);
    for (const uint32_t d : {41, 42, 43}) check_close("between", value_of(table, 5, d, 60), 1 + 2.0 * (d - 40), 1e-6);
}

// Below grazing_half_angle, which lies in cell 79 of theta_half, an arc of which nothing was measured stays as it is;
// beyond, it takes the values of the one inside.
void arcs_without_a_measured_cell(void**) {
    BrdfTable table;
    table.rgb.assign(BrdfTable::cell_count * 3, 1.0f);
    const auto clear = [&](uint32_t h) {
        size_t reached = 0;
        for (uint32_t d = 0; d < BrdfTable::theta_diff_cells; ++d) {
            set_cell(table, h, d, 90, -1);
            reached += TableCell{h, d, 90}.reaches_above_horizon() ? 1 : 0;
        }
        return reached;
    };
    const size_t left = clear(78), filled = clear(85) + clear(86);
    for (uint32_t d = 0; d < BrdfTable::theta_diff_cells; ++d) set_cell(table, 84, d, 90, 7);
    const UnmeasuredCells count = fill_unmeasured_cells(table);
    assert_int_equal(count.left, left);
    assert_int_equal(count.filled, filled);
    for (uint32_t d = 0; d < 10; ++d) {
        check_close("left", value_of(table, 78, d, 90), -1, 0);
        check_close("from the inner arc", value_of(table, 86, d, 90), 7, 0);
    }
}

void nothing_is_reflected_below_the_horizon(void**) {
    const Vec3 up(0, 0, 1), flat(1, 0, 0), down = glm::normalize(Vec3(1, 0, -1));
    for (const Brdf& brdf : {Brdf(Lambert{Vec3(1)}), Brdf(Ggx{0.2, Vec3(1)}), Brdf(numbered_table())})
        for (const Vec3& below : {flat, down}) {
            check_vector("light", evaluate(brdf, below, up), Vec3(0), 0);
            check_vector("eye", evaluate(brdf, up, below), Vec3(0), 0);
        }
}

// Walter et al. 2007: at normal incidence D = 1 / (pi alpha^2), G = 1, F = f0, over 4.
void ggx_is_reciprocal_and_known_at_normal_incidence(void**) {
    Random random(23);
    for (const double alpha : {1e-3, 0.1, 1.0}) {
        const Brdf brdf = Ggx{alpha, Vec3(0.9, 0.5, 0.04)};
        const double peak = 1 / (4 * pi * alpha * alpha);
        check_vector("peak", evaluate(brdf, Vec3(0, 0, 1), Vec3(0, 0, 1)), peak * Vec3(0.9, 0.5, 0.04),
                     rounding * peak);
        for (int i = 0; i < 1000; ++i) {
            const Pair pair = random_pair(random).pair;
            const Vec3 value = evaluate(brdf, pair.wi, pair.wo);
            check_vector("reciprocity", evaluate(brdf, pair.wo, pair.wi), value, 1e-12 * value.x);
            assert_true(value.x >= value.y && value.y >= value.z && value.z > 0);
        }
    }
}

// Midpoint quadrature over half vectors: x by 1440 steps, so 1e-6 of a smooth integrand; the horizon cuts it, 1e-5.
void albedos_are_what_they_must_be(void**) {
    for (const double theta : {0.0, 0.7, 1.4})
        check_vector("Lambert", directional_albedo(Lambert{Vec3(1, 0.5, 0.1)}, theta), Vec3(1, 0.5, 0.1), 1e-5);
    for (const double alpha : {0.1, 0.5, 1.0})
        for (const double theta : {0.0, 0.7, 1.4}) {
            const double white = directional_albedo(Ggx{alpha, Vec3(1)}, theta).x;
            check_at_most("GGX reflects more than arrives", white, 1 + 1e-5);
            // What bounces twice between facets is lost: little on a smooth surface seen from above.
            if (alpha == 0.1 && theta < 1) check_at_most("GGX loses", 1 - white, 0.05);
        }
}

// ---- Maps --------------------------------------------------------------------------------------------

// Another colour in every texel.
RgbImage asymmetric_map(uint32_t width, uint32_t height) {
    RgbImage map{width, height, {}};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) map.rgb.insert(map.rgb.end(), {float(x), float(y), float(x * y)});
    return map;
}

Vec3 texel_of(const RgbImage& map, uint32_t x, uint32_t y) {
    const float* rgb = map.texel(x, y);
    return {rgb[0], rgb[1], rgb[2]};
}

void directions_and_maps_round_trip(void**) {
    Random random(24);
    for (int i = 0; i < 10000; ++i) {
        const Vec3 d = random.direction();
        check_vector("direction", direction_of(latitude_longitude(d)), d, rounding);
    }
}

void maps_are_oriented_as_openexr_says(void**) {
    const auto check_place = [](const Vec3& direction, double u, double v) {
        const Vec2 at = latitude_longitude(direction);
        check_close("u", at.x, u, rounding);
        check_close("v", at.y, v, rounding);
    };
    check_place({0, 0, 1}, 0.5, 0.5);
    check_place({1, 0, 0}, 0.25, 0.5);
    check_place({-1, 0, 0}, 0.75, 0.5);
    check_place(glm::normalize(Vec3(1e-14, 0, -1)), 0, 0.5);
    check_place(glm::normalize(Vec3(-1e-14, 0, -1)), 1, 0.5);
    check_close("+Y", latitude_longitude({0, 1, 0}).y, 0, rounding);
    check_close("-Y", latitude_longitude({0, -1, 0}).y, 1, rounding);
    // The same, seen in a map: +X lies in the left half, up in the first rows.
    const RgbImage map = asymmetric_map(16, 8);
    const Vec3 right_and_up = glm::normalize(Vec3(1, 1, 1e-3));
    check_vector("texel", radiance(map, right_and_up, Lookup::nearest), texel_of(map, 4, 2), 0);
}

void lookups_agree_at_the_centres_and_go_around(void**) {
    const RgbImage map = asymmetric_map(16, 8);
    const auto at = [&](double x, double y, Lookup lookup) {
        return radiance(map, direction_of({x / 16, y / 8}), lookup);
    };
    // Values up to 105 times the rounding of a place in texels.
    constexpr double tolerance = 105 * 16 * rounding;
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 16; ++x) {
            check_vector("nearest", at(x + 0.5, y + 0.5, Lookup::nearest), texel_of(map, x, y), 0);
            check_vector("linear", at(x + 0.5, y + 0.5, Lookup::linear), texel_of(map, x, y), tolerance);
            const Vec3 next = texel_of(map, (x + 1) % 16, y);
            check_vector("between", at(x + 1.0 - 1e-12, y + 0.5, Lookup::linear), 0.5 * (texel_of(map, x, y) + next),
                         1e-9);
        }
    // Beyond the outermost centres the rows go on as they are.
    check_vector("north", at(3.5, 0.1, Lookup::linear), texel_of(map, 3, 0), tolerance);
    check_vector("south", at(3.5, 7.9, Lookup::linear), texel_of(map, 3, 7), tolerance);
}

void bad_radiance_is_named(void**) {
    RgbImage map = asymmetric_map(16, 8);
    check_radiance(map, "sky.exr", LB_ERROR_FORMAT);
    for (const float bad : {-1.0f, not_a_number, infinite_float}) {
        RgbImage broken = map;
        broken.rgb[(5 * 16 + 3) * 3 + 1] = bad;
        expect_error(LB_ERROR_FORMAT, {"sky.exr", "green", "(3, 5)"},
                     [&] { check_radiance(broken, "sky.exr", LB_ERROR_FORMAT); });
    }
}

// ---- Cameras -----------------------------------------------------------------------------------------

lb_camera_desc camera_description() {
    lb_camera_desc desc = LB_CAMERA_DESC_INIT;
    desc.eye[2] = 4;
    return desc;
}

void cameras_have_defaults_and_right_handed_axes(void**) {
    const Camera camera = Camera::from(camera_description());
    check_vector("forward", camera.forward, {0, 0, -1}, 0);
    check_vector("right", camera.right, {1, 0, 0}, 0);
    check_vector("up", camera.up, {0, 1, 0}, 0);
    check_close("fov_y", camera.fov_y, 0.7, 0);
    check_close("near", camera.near_plane, 4e-3, rounding);
    check_close("far", camera.far_plane, 4e3, rounding * 4e3);
    check_close("radians per pixel", camera.radians_per_pixel(100), 2 * std::tan(0.35) / 100, rounding);
    Random random(25);
    for (int i = 0; i < 1000; ++i) {
        lb_camera_desc desc = LB_CAMERA_DESC_INIT;
        for (int c = 0; c < 3; ++c) {
            desc.eye[c] = float(random.uniform(-5, 5));
            desc.target[c] = float(random.uniform(-5, 5));
            desc.up[c] = float(random.uniform(-1, 1));
        }
        const Camera any = Camera::from(desc);
        check_vector("handedness", glm::cross(any.right, any.up), -any.forward, 1e-12);
        check_close("up", glm::dot(any.up, any.forward), 0, 1e-12);
        assert_true(glm::dot(any.up, Vec3(desc.up[0], desc.up[1], desc.up[2])) > 0);
    }
}

// Through the picture's middle looks the camera; through its corners, half a pixel in, the field of view; and all rays reach one unit
// of depth.
void rays_span_the_field_of_view(void**) {
    lb_camera_desc desc = camera_description();
    desc.target[0] = 1;
    const Camera camera = Camera::from(desc);
    const uint32_t width = 31, height = 17;
    const Camera::Rays rays = camera.rays(width, height);
    check_vector("middle", rays.through(15, 8), camera.forward, rounding);
    const Vec3 top = rays.through(15, -0.5), left = rays.through(-0.5, 8);
    check_close("half of fov_y", std::atan2(glm::length(glm::cross(top, camera.forward)), glm::dot(top, camera.forward)), 0.35, rounding);
    check_close("up", glm::dot(top, camera.up), std::tan(0.35), rounding);
    check_close("left", glm::dot(left, camera.right), -std::tan(0.35) * width / height, rounding);
    check_close("depth", glm::dot(rays.through(3, 5), camera.forward), 1, rounding);
}

void singular_cameras_are_named(void**) {
    const auto refused = [](const std::vector<std::string>& words, auto change) {
        lb_camera_desc desc = camera_description();
        change(desc);
        expect_error(LB_ERROR_INVALID_ARGUMENT, words, [&] { Camera::from(desc); });
    };
    refused({"target", "eye"}, [](lb_camera_desc& d) { d.target[2] = 4; });
    refused({"up", "parallel"}, [](lb_camera_desc& d) { d.up[2] = -3; });
    refused({"up", "parallel"}, [](lb_camera_desc& d) {
        std::memcpy(d.eye, std::array<float, 3>{0, 4, 0}.data(), sizeof d.eye);
    });
    refused({"eye", "nan"}, [](lb_camera_desc& d) { d.eye[0] = not_a_number; });
    refused({"target", "inf"}, [](lb_camera_desc& d) { d.target[1] = infinite_float; });
    refused({"up", "nan"}, [](lb_camera_desc& d) { d.up[1] = not_a_number; });
    refused({"fov_y", "-1"}, [](lb_camera_desc& d) { d.fov_y = -1; });
    refused({"fov_y", "3.2"}, [](lb_camera_desc& d) { d.fov_y = 3.2f; });
    refused({"near_plane"}, [](lb_camera_desc& d) { d.near_plane = -0.5f; });
    refused({"near_plane 5", "far_plane 2"}, [](lb_camera_desc& d) { d.near_plane = 5, d.far_plane = 2; });
    refused({"near_plane is 9.99", "at least 1e-30"}, [](lb_camera_desc& d) { d.near_plane = 1e-38f; });
    refused({"far_plane is ", "at most 1e+30"}, [](lb_camera_desc& d) { d.far_plane = 1e38f; });
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(coordinates_are_rusinkiewicz_angles),
        cmocka_unit_test(coordinates_stay_inside_the_table),
        cmocka_unit_test(tables_are_reciprocal_and_isotropic),
        cmocka_unit_test(linear_lookup_meets_the_centres),
        cmocka_unit_test(linear_lookup_wraps_phi_and_skips_unmeasured_cells),
        cmocka_unit_test(unmeasured_grazing_cells_of_a_matte_surface_are_filled),
        cmocka_unit_test(holes_are_filled_along_their_arc),
        cmocka_unit_test(arcs_without_a_measured_cell),
        cmocka_unit_test(nothing_is_reflected_below_the_horizon),
        cmocka_unit_test(ggx_is_reciprocal_and_known_at_normal_incidence),
        cmocka_unit_test(albedos_are_what_they_must_be),
        cmocka_unit_test(directions_and_maps_round_trip),
        cmocka_unit_test(maps_are_oriented_as_openexr_says),
        cmocka_unit_test(lookups_agree_at_the_centres_and_go_around),
        cmocka_unit_test(bad_radiance_is_named),
        cmocka_unit_test(cameras_have_defaults_and_right_handed_axes),
        cmocka_unit_test(rays_span_the_field_of_view),
        cmocka_unit_test(singular_cameras_are_named),
    };
    return cmocka_run_group_tests_name("scene", tests, nullptr, nullptr);
}
