// What the user describes: reflectances, maps, triangles, cameras, shapes.
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
#include "scene/triangles.h"

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

// ---- Triangles ---------------------------------------------------------------------------------------

struct Description {
    std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    std::vector<float> normals = {0, 0, 5, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    std::vector<uint32_t> indices = {0, 1, 2, 2, 1, 3};

    lb_mesh_desc desc() const {
        lb_mesh_desc result = LB_MESH_DESC_INIT;
        result.vertex_count = uint32_t(positions.size() / 3);
        result.positions = positions.data();
        result.normals = normals.empty() ? nullptr : normals.data();
        result.indices = indices.data();
        result.triangle_count = uint32_t(indices.size() / 3);
        return result;
    }
    void refused(lb_result code, const std::vector<std::string>& words) const {
        expect_error(code, words, [this] { Triangles::from(desc()); });
    }
};

void good_triangles_are_kept(void**) {
    const Triangles mesh = Triangles::from(Description().desc());
    assert_int_equal(mesh.indices.size(), 6);
    assert_int_equal(mesh.dropped, 0);
    check_close("normals are made unit", double(mesh.normals[2]), 1, 0);
    float low[3], high[3];
    mesh.bounds(low, high);
    for (int c = 0; c < 3; ++c) {
        check_close("low", double(low[c]), 0, 0);
        check_close("high", double(high[c]), c < 2 ? 1 : 0, 0);
    }
}

void bad_triangles_are_named(void**) {
    const auto broken = [](auto change) {
        Description description;
        change(description);
        return description;
    };
    broken([](Description& d) {
        d.positions[7] = not_a_number;
    }).refused(LB_ERROR_INVALID_ARGUMENT, {"positions[2][1]", "nan"});
    broken([](Description& d) {
        d.normals[3] = infinite_float;
    }).refused(LB_ERROR_INVALID_ARGUMENT, {"normals[1][0]", "inf"});
    broken([](Description& d) { d.normals[5] = 0; }).refused(LB_ERROR_INVALID_ARGUMENT, {"normals[1]", "length 0"});
    broken([](Description& d) {
        d.indices[4] = 4;
    }).refused(LB_ERROR_INVALID_ARGUMENT, {"indices[4] is 4", "vertex_count 4"});
    broken([](Description& d) { d.indices = {0, 1, 1}; }).refused(LB_ERROR_INVALID_ARGUMENT, {"zero area"});
    broken([](Description& d) { d.indices.clear(); }).refused(LB_ERROR_INVALID_ARGUMENT, {"no triangles"});
    broken([](Description& d) { d.positions.clear(); }).refused(LB_ERROR_INVALID_ARGUMENT, {"no vertices"});
    lb_mesh_desc huge = Description().desc();
    huge.triangle_count = 0x80000000u;
    expect_error(LB_ERROR_LIMIT, {"triangle_count", "2147483648"}, [&] { Triangles::from(huge); });
    huge = Description().desc();
    huge.indices = nullptr;
    expect_error(LB_ERROR_INVALID_ARGUMENT, {"no triangles", "NULL"}, [&] { Triangles::from(huge); });
}

void empty_triangles_are_dropped_and_normals_computed(void**) {
    Description description;
    description.normals.clear();
    description.indices = {0, 1, 1, 0, 1, 2, 3, 3, 3, 2, 1, 3};
    const Triangles mesh = Triangles::from(description.desc());
    assert_int_equal(mesh.dropped, 2);
    const std::vector<uint32_t> kept = {0, 1, 2, 2, 1, 3};
    assert_true(mesh.indices == kept);
    for (size_t i = 0; i < mesh.vertex_count(); ++i) check_close("normal", double(mesh.normals[3 * i + 2]), 1, 0);
    // However small, a triangle that has an area stays.
    for (float& x : description.positions) x *= 1e-15f;
    assert_int_equal(Triangles::from(description.desc()).indices.size(), 6);
}

// A fold of 90 degrees, one side three times as large: the shared normal leans by atan(1 / 3) to it.
void computed_normals_weigh_by_area(void**) {
    Description description;
    description.normals.clear();
    description.positions = {0, 0, 0, 0, 1, 0, 3, 0, 0, 0, 0, 1};
    description.indices = {0, 2, 1, 0, 1, 3};
    const Triangles mesh = Triangles::from(description.desc());
    const Vec3 expected = glm::normalize(Vec3(1, 0, 3));
    for (int c = 0; c < 3; ++c) check_close("normal", double(mesh.normals[size_t(c)]), expected[c], 1e-7);
}

// What each corner of each triangle shows, triangles in an order that only this gives them; each starts at its least corner.
std::vector<std::vector<std::vector<float>>> corners_of(const Triangles& mesh) {
    std::vector<std::vector<std::vector<float>>> triangles;
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        std::vector<std::vector<float>> corners;
        for (size_t c = 0; c < 3; ++c) {
            const size_t i = mesh.indices[3 * t + c];
            corners.push_back({mesh.positions[3 * i], mesh.positions[3 * i + 1], mesh.positions[3 * i + 2], mesh.normals[3 * i],
                               mesh.normals[3 * i + 1], mesh.normals[3 * i + 2], mesh.texcoords[2 * i], mesh.texcoords[2 * i + 1]});
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        triangles.push_back(corners);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

// Vertices that a device transforms which remembers the last sixteen, as small devices do.
size_t transformed(const Triangles& mesh) {
    constexpr size_t remembered = 16;
    std::vector<uint32_t> last;
    size_t count = 0;
    for (const uint32_t i : mesh.indices) {
        if (std::find(last.begin(), last.end(), i) != last.end()) continue;
        ++count;
        last.push_back(i);
        if (last.size() > remembered) last.erase(last.begin());
    }
    return count;
}

void order_for_drawing_changes_the_order_alone(void**) {
    Triangles mesh = Triangles::shape("blob", 64);
    std::mt19937 random(3);
    std::vector<size_t> order(mesh.indices.size() / 3);
    std::iota(order.begin(), order.end(), size_t(0));
    std::shuffle(order.begin(), order.end(), random);
    std::vector<uint32_t> shuffled;
    for (const size_t t : order) shuffled.insert(shuffled.end(), &mesh.indices[3 * t], &mesh.indices[3 * t] + 3);
    mesh.indices = shuffled;
    // One vertex that no triangle uses.
    mesh.positions.insert(mesh.positions.begin(), {7, 8, 9});
    mesh.normals.insert(mesh.normals.begin(), {0, 0, 1});
    mesh.texcoords.insert(mesh.texcoords.begin(), {0, 0});
    for (uint32_t& i : mesh.indices) ++i;

    Triangles ordered = mesh;
    ordered.order_for_drawing();
    assert_true(corners_of(ordered) == corners_of(mesh));
    assert_int_equal(ordered.vertex_count(), mesh.vertex_count());
    check_close("what no triangle uses comes last", double(ordered.positions[3 * ordered.vertex_count() - 1]), 9, 0);
    // A mesh has twice as many triangles as vertices: at best half a transformation each, at worst three, which random order comes to
    // but for the sixteen in some two thousand. Strips of a grid take one each; 0.8 is beyond what those could.
    const double triangles = double(mesh.indices.size()) / 3;
    assert_true(double(transformed(mesh)) > 2.5 * triangles);
    assert_true(double(transformed(ordered)) < 0.8 * triangles);
    // Vertices are used as they lie.
    uint32_t next = 0;
    for (const uint32_t i : ordered.indices) {
        assert_true(i <= next);
        next = std::max(next, i + 1);
    }
    Triangles bare = mesh;
    bare.texcoords.clear();  // which a mesh may lack
    bare.order_for_drawing();
    assert_true(bare.texcoords.empty() && bare.positions == ordered.positions && bare.normals == ordered.normals);
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
}

// ---- Shapes ------------------------------------------------------------------------------------------

const char* const closed_shapes[] = {"sphere", "torus", "knot", "blob"};

Vec3 vertex(const std::vector<float>& values, uint32_t i) {
    return {values[3 * size_t(i)], values[3 * size_t(i) + 1], values[3 * size_t(i) + 2]};
}

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// A facet's normal is, by the mean value theorem, close to a mean of the surface's over the triangle: it differs from
// each corner's by no more than they differ among themselves, up to the next order of the triangle's size, for which a
// factor two is allowed. Floats tilt a facet by 2^-24 of a metre over its height; slivers at the poles, thinner than
// 1e-3, are left out.
void normals_agree_with_facets(void**) {
    for (const char* name : {"sphere", "torus", "knot", "blob", "plane"}) {
        const Triangles mesh = Triangles::shape(name, 64);
        for (size_t i = 0; i < mesh.vertex_count(); ++i)
            check_close(name, glm::length(vertex(mesh.normals, uint32_t(i))), 1, 2e-7);
        size_t compared = 0;
        for (size_t t = 0; t < mesh.indices.size(); t += 3) {
            Vec3 p[3], n[3];
            for (size_t c = 0; c < 3; ++c) {
                p[c] = vertex(mesh.positions, mesh.indices[t + c]);
                n[c] = vertex(mesh.normals, mesh.indices[t + c]);
            }
            const double longest =
                std::max({glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])});
            const Vec3 facet = glm::cross(p[1] - p[0], p[2] - p[0]);
            const double height = glm::length(facet) / longest;
            if (height < 1e-3) continue;
            const double spread =
                std::max({angle_between(n[0], n[1]), angle_between(n[1], n[2]), angle_between(n[2], n[0])});
            for (const Vec3& normal : n) check_at_most(name, angle_between(facet, normal), 2 * spread + 1e-6 / height);
            ++compared;
        }
        assert_true(compared > mesh.indices.size() / 3 * 9 / 10);
    }
}

// Vertices at one place (to a millionth of a metre) are one: seams and poles close.
std::vector<std::array<size_t, 3>> welded_triangles(const Triangles& mesh, size_t* vertices) {
    std::map<std::array<long, 3>, size_t> places;
    std::vector<size_t> place_of;
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
        const Vec3 p = vertex(mesh.positions, uint32_t(i)) * 1e6;
        // Rounding may part what a seam holds together: a place is also sought among its neighbours.
        const std::array<long, 3> key = {std::lround(p.x), std::lround(p.y), std::lround(p.z)};
        size_t found = places.size();
        for (long n = 0; n < 27 && found == places.size(); ++n) {
            const auto near = places.find({key[0] + n % 3 - 1, key[1] + n / 3 % 3 - 1, key[2] + n / 9 - 1});
            if (near != places.end()) found = near->second;
        }
        if (found == places.size()) places.emplace(key, found);
        place_of.push_back(found);
    }
    *vertices = places.size();
    std::vector<std::array<size_t, 3>> triangles;
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
        const std::array<size_t, 3> corners = {place_of[mesh.indices[t]], place_of[mesh.indices[t + 1]],
                                               place_of[mesh.indices[t + 2]]};
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
            triangles.push_back(corners);
    }
    return triangles;
}

void shapes_are_closed_and_wound_outwards(void**) {
    for (const char* name : closed_shapes) {
        const Triangles mesh = Triangles::shape(name, 32);
        size_t vertices = 0;
        const auto triangles = welded_triangles(mesh, &vertices);
        std::map<std::pair<size_t, size_t>, int> directed;
        for (const auto& corners : triangles)
            for (size_t c = 0; c < 3; ++c) ++directed[{corners[c], corners[(c + 1) % 3]}];
        for (const auto& [edge, count] : directed) {
            assert_int_equal(count, 1);
            assert_int_equal(directed.count({edge.second, edge.first}), 1);
        }
        // Euler and Poincare: V - E + F is 2 for a sphere, 0 for a torus or a knotted tube.
        const long euler = long(vertices) - long(directed.size() / 2) + long(triangles.size());
        assert_int_equal(euler, std::strcmp(name, "sphere") == 0 || std::strcmp(name, "blob") == 0 ? 2 : 0);
        double volume = 0;
        for (size_t t = 0; t < mesh.indices.size(); t += 3)
            volume += glm::dot(vertex(mesh.positions, mesh.indices[t]),
                               glm::cross(vertex(mesh.positions, mesh.indices[t + 1]),
                                          vertex(mesh.positions, mesh.indices[t + 2]))) /
                      6;
        if (!(volume > 0)) fail_msg("%s: its signed volume is %g", name, volume);
    }
}

void shapes_have_their_sizes(void**) {
    const Triangles sphere = Triangles::shape("sphere", 0);
    for (size_t i = 0; i < sphere.vertex_count(); ++i)
        check_close("radius", glm::length(vertex(sphere.positions, uint32_t(i))), 0.5, 1e-7);
    for (const char* name : {"sphere", "torus", "knot", "blob"}) {
        float low[3], high[3];
        Triangles::shape(name, 128).bounds(low, high);
        float widest = 0;
        for (int c = 0; c < 3; ++c) widest = std::max(widest, high[c] - low[c]);
        assert_true(widest > 0.7f && widest < 1.3f);  // "about one metre across"
    }
    expect_error(LB_ERROR_INVALID_ARGUMENT, {"resolution is 7", "8 .. 2048"}, [] { Triangles::shape("sphere", 7); });
    expect_error(LB_ERROR_INVALID_ARGUMENT, {"2049"}, [] { Triangles::shape("sphere", 2049); });
    expect_error(LB_ERROR_INVALID_ARGUMENT, {"teapot", "torus"}, [] { Triangles::shape("teapot", 8); });
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
        cmocka_unit_test(nothing_is_reflected_below_the_horizon),
        cmocka_unit_test(ggx_is_reciprocal_and_known_at_normal_incidence),
        cmocka_unit_test(albedos_are_what_they_must_be),
        cmocka_unit_test(directions_and_maps_round_trip),
        cmocka_unit_test(maps_are_oriented_as_openexr_says),
        cmocka_unit_test(lookups_agree_at_the_centres_and_go_around),
        cmocka_unit_test(bad_radiance_is_named),
        cmocka_unit_test(good_triangles_are_kept),
        cmocka_unit_test(bad_triangles_are_named),
        cmocka_unit_test(empty_triangles_are_dropped_and_normals_computed),
        cmocka_unit_test(computed_normals_weigh_by_area),
        cmocka_unit_test(order_for_drawing_changes_the_order_alone),
        cmocka_unit_test(cameras_have_defaults_and_right_handed_axes),
        cmocka_unit_test(singular_cameras_are_named),
        cmocka_unit_test(normals_agree_with_facets),
        cmocka_unit_test(shapes_are_closed_and_wound_outwards),
        cmocka_unit_test(shapes_have_their_sizes),
    };
    return cmocka_run_group_tests_name("scene", tests, nullptr, nullptr);
}
