// Meshes: what is asked of a description, the order they are drawn in, and the shapes that are computed.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include "numeric_testing.h"
#include "scene/triangles.h"

namespace lightband {
namespace {

using namespace testing;

const float not_a_number = std::numeric_limits<float>::quiet_NaN();
const float infinite_float = std::numeric_limits<float>::infinity();

// ---- Triangles ---------------------------------------------------------------------------------------

Vec3 vertex(const std::vector<float>& values, uint32_t i) {
    return {values[3 * size_t(i)], values[3 * size_t(i) + 1], values[3 * size_t(i) + 2]};
}

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

// A sheet that was given two sides, of the same corners: their sum says nothing, and may be anything where it does not vanish to the bit.
void two_windings_cancel_no_normal(void**) {
    Description description;
    description.normals.clear();
    description.positions = {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1};
    description.indices = {0, 1, 2, 2, 1, 3, 0, 2, 1, 2, 3, 1};
    const Triangles mesh = Triangles::from(description.desc());
    for (size_t i = 0; i < mesh.vertex_count(); ++i) check_close("normal", std::abs(double(mesh.normals[3 * i])), 1, 0);
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

// ---- Shapes ------------------------------------------------------------------------------------------

const char* const closed_shapes[] = {"sphere", "torus", "knot", "blob"};

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// As lightband.h has it: every point of the torus is a tube's radius away from a circle around the Y axis.
void the_torus_lies_around_the_y_axis(void**) {
    constexpr double ring = 0.34, tube = 0.14, float_rounding = 1e-7;
    const Triangles mesh = Triangles::shape("torus", 64);
    double highest = 0;
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
        const Vec3 p = vertex(mesh.positions, uint32_t(i));
        check_close("radius of the tube", std::hypot(std::hypot(p.x, p.z) - ring, p.y), tube, float_rounding);
        highest = std::max(highest, p.y);
    }
    check_close("half the height", highest, tube, float_rounding);
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
        cmocka_unit_test(good_triangles_are_kept),
        cmocka_unit_test(bad_triangles_are_named),
        cmocka_unit_test(empty_triangles_are_dropped_and_normals_computed),
        cmocka_unit_test(computed_normals_weigh_by_area),
        cmocka_unit_test(two_windings_cancel_no_normal),
        cmocka_unit_test(order_for_drawing_changes_the_order_alone),
        cmocka_unit_test(the_torus_lies_around_the_y_axis),
        cmocka_unit_test(normals_agree_with_facets),
        cmocka_unit_test(shapes_are_closed_and_wound_outwards),
        cmocka_unit_test(shapes_have_their_sizes),
    };
    return cmocka_run_group_tests_name("triangles", tests, nullptr, nullptr);
}
