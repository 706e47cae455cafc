// Tables with black or unmeasured parts: their light must be drawn as often as it deserves, wherever it lies.
#include <functional>

#include "numeric_testing.h"
#include "sampling/lobe_sampler.h"

namespace lightband {
namespace {

using namespace testing;

// A table that holds one value in some cells and another in all others.
BrdfTable table_of(float elsewhere, const std::function<bool(uint32_t, uint32_t, uint32_t)>& is_bright) {
    BrdfTable table;
    for (uint32_t h = 0; h < BrdfTable::theta_half_cells; ++h)
        for (uint32_t d = 0; d < BrdfTable::theta_diff_cells; ++d)
            for (uint32_t p = 0; p < BrdfTable::phi_diff_cells; ++p)
                table.rgb.insert(table.rgb.end(), 3, is_bright(h, d, p) ? 0.3f : elsewhere);
    return table;
}

struct Named {
    const char* name;
    BrdfTable table;
};

std::vector<Named> tables() {
    std::vector<Named> all;
    for (const float elsewhere : {-1.0f, 1e-3f}) {
        all.push_back({"ring of half vectors",
                       table_of(elsewhere, [](uint32_t h, uint32_t, uint32_t) { return h == 40 || h == 41; })});
        all.push_back({"slice of azimuths",
                       table_of(elsewhere, [](uint32_t, uint32_t, uint32_t p) { return p >= 60 && p < 70; })});
        all.push_back(
            {"unmeasured beyond an angle", table_of(elsewhere, [](uint32_t, uint32_t d, uint32_t) { return d < 50; })});
        all.push_back({"block", table_of(elsewhere, [](uint32_t h, uint32_t d, uint32_t p) {
                           return h >= 40 && h < 48 && d >= 20 && d < 60 && p >= 50 && p < 70;
                       })});
    }
    return all;
}

// E[w^2] / E[w]^2 of the weights w = f cos / pdf: 1 + the relative variance of one sample; 0 where the view sees no
// light.
double relative_second_moment(const Brdf& brdf, const LobeSampler& sampler, double view) {
    constexpr int side = 128;
    const double theta = view / LobeTable::views * pi / 2;
    const Vec3 wo(std::sin(theta), 0, std::cos(theta));
    double sum = 0, squares = 0;
    for (int i = 0; i < side * side; ++i) {
        const LobeSample drawn = sampler.sample(wo, Vec2((i % side + 0.5) / side, (i / side + 0.5) / side));
        if (!(drawn.pdf > 0)) continue;
        const double weight = evaluate(brdf, drawn.wi, wo).y * drawn.wi.z / drawn.pdf;
        sum += weight;
        squares += weight * weight;
    }
    return sum > 0 ? squares * side * side / (sum * sum) : 0;
}

// What a density costs that gives some of its samples to other light: the even part takes a sixteenth, and what is
// given to neighbours may be as much again as the light itself.
constexpr double given_away = 2 * 16.0 / 15;

// If the density is nowhere below a quarter of what follows the light (lobe_grid's share of a neighbour), the second
// moment is at most 4.
void no_light_is_drawn_too_rarely(void**) {
    for (const Named& one : tables()) {
        const Brdf brdf = one.table;
        const LobeSampler sampler(brdf);
        // Within a view's interval, not in its middle.
        for (const double view : {7.2, 28.4, 47.9, 57.1})
            check_at_most(one.name, relative_second_moment(brdf, sampler, view), 4 * given_away);
    }
}

// Light narrower than a cell of the grid is hit by few of the 18 lookups in a cell. Where one of them hits, the root of
// the mean square is the light divided by sqrt(18); where none does, the cell has a quarter of that from its neighbour.
// Without the neighbour's share, the second moment is 73 at the first view and 58 at the second.
void narrow_light_is_drawn_in_cells_whose_lookups_miss_it(void**) {
    const Brdf brdf = table_of(-1, [](uint32_t, uint32_t, uint32_t p) { return p == 75 || p == 76; });
    const LobeSampler sampler(brdf);
    for (const double view : {7.2, 9.9})
        check_at_most("slice of two degrees", relative_second_moment(brdf, sampler, view),
                      4 * std::sqrt(18.0) * given_away);
}

// What a density is divided by: the integral of f cos, whichever side of the plane of incidence the light lies on.
// Midpoints of 180 x 64 cells miss what a table's edges cut off them: 2.8 degrees of azimuth, three lookups each, of a
// slice of 10: 0.1.
void both_sides_count(void**) {
    const Brdf left = table_of(0, [](uint32_t, uint32_t, uint32_t p) { return p >= 60 && p < 70; });
    const Brdf right =
        table_of(0, [](uint32_t, uint32_t, uint32_t p) { return p >= 110 && p < 120; });  // its mirror image
    const LobeTable a = lobe_table(left), b = lobe_table(right);
    constexpr int steep = 56;  // beyond, f cos changes by more over one view's interval of angles than edges cut off
    for (int view = 0; view < steep; ++view) {
        check_close("mirrored", a.albedo[size_t(view)], b.albedo[size_t(view)], 1e-6);
        if (view % 8 != 0 || view == 0)
            continue;  // at normal incidence the slice is black but for what the interval adds
        const double theta = (view + 0.5) / LobeTable::views * pi / 2, expected = directional_albedo(left, theta).y;
        check_close("albedo", a.albedo[size_t(view)], expected, 0.1 * expected);
    }
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(no_light_is_drawn_too_rarely),
        cmocka_unit_test(narrow_light_is_drawn_in_cells_whose_lookups_miss_it),
        cmocka_unit_test(both_sides_count),
    };
    return cmocka_run_group_tests_name("uneven tables", tests, nullptr, nullptr);
}
