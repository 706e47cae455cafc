// Samplers against their densities, the sequence against its definition, pilots against the albedo.
#include <functional>
#include <memory>

#include "brdf_testing.h"
#include "bandwidth/octahedral.h"
#include "numeric_testing.h"
#include "sampling/lobe_sampler.h"
#include "sampling/map_sampler.h"
#include "sampling/pilots.h"
#include "sampling/sequence.h"
#include "scene/environment.h"

namespace lightband {
namespace {

using namespace testing;

struct Case {
    const char* name;
    Brdf brdf;
    LobeSampler sampler;

    Case(const char* title, Brdf reflectance) : name(title), brdf(std::move(reflectance)), sampler(brdf) {}
    bool is_table() const { return std::holds_alternative<BrdfTable>(brdf); }
};

// Kept at fixed places: each sampler refers to its case's BRDF.
const std::vector<std::unique_ptr<const Case>>& cases() {
    static const auto all = [] {
        std::vector<std::unique_ptr<const Case>> list;
        list.push_back(std::make_unique<Case>("table", tabulated(Ggx{0.15, Vec3(0.9, 0.6, 0.3)})));
        list.push_back(std::make_unique<Case>("Lambert", Lambert{Vec3(0.8, 0.5, 0.2)}));
        list.push_back(std::make_unique<Case>("GGX", Ggx{0.3, Vec3(0.9, 0.6, 0.3)}));
        return list;
    }();
    return all;
}

constexpr double view_angles[] = {0.2, 0.9, 1.4};
const double views_tested = std::size(view_angles);

Vec3 outgoing(double theta) {
    return {std::sin(theta), 0, std::cos(theta)};
}

// wi of the half vector with theta_half = x^2 pi / 2; an opposing pair where wo lies behind it.
Vec3 incident(const Vec3& wo, double x, double phi) {
    const double theta = x * x * pi / 2;
    const Vec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    return 2 * glm::dot(wo, h) * h - wo;
}

// Solid angle of wi per unit of x and phi, by central differences: truncation step^2 = 1e-10, rounding 1e-16 / step =
// 1e-11.
double solid_angle(const Vec3& wo, double x, double phi) {
    constexpr double step = 1e-5;
    const Vec3 dx = incident(wo, x + step, phi) - incident(wo, x - step, phi);
    const Vec3 dphi = incident(wo, x, phi + step) - incident(wo, x, phi - step);
    return glm::length(glm::cross(dx, dphi)) / (4 * step * step);
}

// Density of half vectors over (x, phi), from the density of wi.
double density_at(const LobeSampler& sampler, const Vec3& wo, double x, double phi) {
    const double theta = x * x * pi / 2;
    if (wo.x * std::sin(theta) * std::cos(phi) + wo.z * std::cos(theta) <= 0) return 0;
    return sampler.pdf(incident(wo, x, phi), wo) * solid_angle(wo, x, phi);
}

// ---- Densities ---------------------------------------------------------------------------------------

// The part of a fine lattice of random numbers whose samples fall below the horizon.
double part_below_horizon(const LobeSampler& sampler, const Vec3& wo, int side) {
    int below = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) below += !(sampler.sample(wo, Vec2((x + 0.5) / side, (y + 0.5) / side)).pdf > 0);
    return double(below) / (double(side) * side);
}

// Everything that is drawn is either above the horizon, where pdf speaks, or below it. The horizon's curve cuts about 2
// side of the side^2 cells of the lattice and of the quadrature, each wrong by at most half of itself: 2 / side
// together. A table's density jumps between its steps, whose borders cut the quadrature's cells in the same way; jumps
// are of the density's own size, 128 + 32 borders of random sign: another sqrt(160) / side.
void densities_integrate_to_one(void**) {
    constexpr int side = 512;
    for (const auto& one : cases())
        for (const double theta : view_angles) {
            const Vec3 wo = outgoing(theta);
            double above = 0;
            for (int i = 0; i < side; ++i)
                for (int j = 0; j < side; ++j)
                    above += density_at(one->sampler, wo, (i + 0.5) / side, 2 * pi * (j + 0.5) / side);
            above *= 2 * pi / (double(side) * side);
            const double below = part_below_horizon(one->sampler, wo, side);
            check_close(one->name, above + below, 1, (one->is_table() ? 2 + std::sqrt(160.0) : 2.0) / side);
        }
}

// The steps of a table tile [0, 1] and, for each, [0, pi]: floats near 1 round by 2^-25 at each end.
void table_steps_tile_their_domain(void**) {
    const LobeTable& table = cases()[0]->sampler.table();
    const auto check_tiles = [](const std::vector<LobeTable::Step>& steps, size_t first, int count, double end) {
        double at = 0;
        for (int k = 0; k < count; ++k) {
            const LobeTable::Step& step = steps[first + size_t(k)];
            assert_true(step.width > 0);
            check_close("start of a step", double(step.start), at, 0x1p-22 * end);
            at = double(step.start) + double(step.width);
        }
        check_close("end of the steps", at, end, 0x1p-22 * end);
    };
    for (int view = 0; view < LobeTable::views; ++view) {
        const size_t row = size_t(view) * LobeTable::radial;
        check_tiles(table.x, row, LobeTable::radial, 1);
        for (size_t k = row; k < row + LobeTable::radial; ++k)
            check_tiles(table.phi, k * LobeTable::azimuthal, LobeTable::azimuthal, pi);
    }
}

// Beyond the part that LobeTable::denser tells, no sample is drawn more densely; and where some are, that part is not empty. Densities
// are those that shaders weigh samples by: in proportion to f cos(theta_i), and an even part. The table's grid looks into each cell once
// or more, and a smooth lobe's density changes by less than a quarter from there to the cell's corners.
void dense_samples_come_first(void**) {
    constexpr int side = 128;
    constexpr double grid = 1.25;
    const Case& one = *cases()[0];
    const LobeTable& table = one.sampler.table();
    for (const int view : {0, 8, 40, 60}) {
        const Vec3 wo = outgoing((view + 0.5) / LobeTable::views * pi / 2);
        double most = 0;
        for (int cell = 0; cell < side * side; ++cell) {
            const Vec2 u((cell % side + 0.5) / side, (cell / side + 0.5) / side);
            const LobeSample sample = one.sampler.sample(wo, u);
            if (!(sample.pdf > 0)) continue;
            const Vec3 value = evaluate(one.brdf, sample.wi, wo) * sample.wi.z;
            const double theta = std::acos(std::min(sample.half.z, 1.0));
            const double angle = solid_angle(wo, std::sqrt(theta / (pi / 2)), std::atan2(sample.half.y, sample.half.x));
            const double followed = (value.x + value.y + value.z) / 3 / double(table.albedo[size_t(view)]);
            const double own = (1 - LobeTable::defensive_part) * followed + LobeTable::defensive_part / (2 * pi) / angle;
            most = std::max(most, own);
            for (int octave = 0; octave < LobeTable::octaves; ++octave) {
                const double part = double(table.denser[size_t(view * LobeTable::octaves + octave)]);
                const double density = std::ldexp(1.0, LobeTable::first_octave + octave);
                if (u.x > part && own > grid * density)
                    fail_msg("view %d: density %g beyond the part %g that is denser than %g", view, own, part, density);
            }
        }
        // An octave below the densest sample of all there are some; and nearly all are denser than the lowest octave.
        const int peak = int(std::floor(std::log2(most))) - LobeTable::first_octave;
        assert_true(table.denser[size_t(view * LobeTable::octaves + peak - 1)] > 0);
        assert_true(table.denser[size_t(view) * LobeTable::octaves] > 1 - LobeTable::defensive_part);
    }
}

// The half vector's angle is found again from wi to a few 1e-16; a table's density goes with its power -1.5 near the
// pole.
void samples_know_their_own_density(void**) {
    Random random(11);
    for (const auto& one : cases())
        for (const double theta : view_angles)
            for (int i = 0; i < 10000; ++i) {
                const Vec3 wo = outgoing(theta);
                const LobeSample sample = one->sampler.sample(wo, Vec2(random.uniform(), random.uniform()));
                const double pdf = one->sampler.pdf(sample.wi, wo);
                const double theta_half = std::hypot(sample.half.x, sample.half.y);
                check_close(one->name, sample.pdf, pdf, pdf * (1e-12 + (one->is_table() ? 1e-15 / theta_half : 0)));
                if (!(pdf > 0)) continue;
                check_close("length of wi", glm::length(sample.wi), 1, rounding);
                check_vector("half vector", sample.half, glm::normalize(sample.wi + wo), 1e-12);
            }
}

// ---- Chi-square --------------------------------------------------------------------------------------

// Bins of the half vector over (x, phi), and one for all that falls below the horizon.
class Histogram {
public:
    static constexpr int radial = 20, azimuthal = 12;

    Histogram() : drawn_(size_t(radial * azimuthal) + 1), expected_(drawn_.size()) {}

    void count(const Vec3& wi, const Vec3& wo, bool above) {
        ++total_;
        if (!above) {
            ++drawn_.back();
            return;
        }
        const Vec3 h = glm::normalize(wi + wo);
        const double x = std::sqrt(std::atan2(std::hypot(h.x, h.y), h.z) / (pi / 2));
        const double turn = std::atan2(h.y, h.x) / (2 * pi);
        const int i = std::min(int(x * radial), radial - 1);
        const int j = std::min(int((turn < 0 ? turn + 1 : turn) * azimuthal), azimuthal - 1);
        ++drawn_[size_t(i * azimuthal + j)];
    }

    // Integrates a density over every bin by the midpoint rule.
    void expect(const std::function<double(double x, double phi)>& density) {
        constexpr int fine = 48;
        const double area = 2 * pi / (radial * fine) / (azimuthal * fine);
        double all = 0;
        for (int i = 0; i < radial * fine; ++i)
            for (int j = 0; j < azimuthal * fine; ++j) {
                const double part =
                    density((i + 0.5) / (radial * fine), 2 * pi * (j + 0.5) / (azimuthal * fine)) * area;
                expected_[size_t(i / fine * azimuthal + j / fine)] += part;
                all += part;
            }
        expected_.back() = std::max(0.0, 1 - all);
    }

    // Bins that expect fewer than ten are thrown together.
    void check(const char* name, double significance) const {
        double sum = 0, rare_expected = 0, rare_drawn = 0;
        int bins = 0;
        const auto add = [&](double drawn, double expected) {
            sum += (drawn - expected) * (drawn - expected) / expected;
            ++bins;
        };
        for (size_t i = 0; i < drawn_.size(); ++i) {
            const double expected = expected_[i] * total_;
            if (expected >= 10) {
                add(drawn_[i], expected);
            } else {
                rare_expected += expected;
                rare_drawn += drawn_[i];
            }
        }
        if (rare_expected >= 10)
            add(rare_drawn, rare_expected);
        else
            check_at_most("samples where almost none are expected", rare_drawn, 40);
        check_at_most(name, sum, chi_square_quantile(significance, bins - 1));
    }

private:
    std::vector<double> drawn_, expected_;
    double total_ = 0;
};

// One test of significance 1e-4, shared among its cases (Bonferroni). The midpoint rule errs by about one part in 48
// where a step's border crosses a bin, 0.5 % on average: at 100 samples a bin that adds 0.0025 to each bin's 1.
void drawn_directions_follow_the_density(void**) {
    constexpr int samples = 30000;
    const double significance = 1e-4 / (double(cases().size()) * views_tested);
    Random random(12);
    for (const auto& one : cases())
        for (const double theta : view_angles) {
            const Vec3 wo = outgoing(theta);
            Histogram histogram;
            for (int i = 0; i < samples; ++i) {
                const LobeSample sample = one->sampler.sample(wo, Vec2(random.uniform(), random.uniform()));
                histogram.count(sample.wi, wo, sample.pdf > 0);
            }
            histogram.expect([&](double x, double phi) { return density_at(one->sampler, wo, x, phi); });
            histogram.check(one->name, significance);
        }
}

// The mean of f cos(theta_i) / pdf is the albedo, within four standard errors of its own.
void samples_reflect_the_albedo(void**) {
    constexpr int samples = 30000;
    Random random(13);
    for (const auto& one : cases())
        for (const double theta : view_angles) {
            const Vec3 wo = outgoing(theta);
            double sum = 0, squares = 0;
            for (int i = 0; i < samples; ++i) {
                const LobeSample sample = one->sampler.sample(wo, Vec2(random.uniform(), random.uniform()));
                if (!(sample.pdf > 0)) continue;
                const double weight = luminance(evaluate(one->brdf, sample.wi, wo)) * sample.wi.z / sample.pdf;
                sum += weight;
                squares += weight * weight;
            }
            const double mean = sum / samples, variance = std::max(0.0, squares / samples - mean * mean);
            // Lambert's weights are all alike; what is left is the quadrature's error, 1e-5 of a smooth lobe.
            check_close(one->name, mean, luminance(directional_albedo(one->brdf, theta)),
                        4 * std::sqrt(variance / samples) + 1e-5);
        }
}

// One sample in sixteen is spread evenly over half vectors (x, phi), whatever the table knows: no weight is unbounded.
// Its steps are wide, where their rounding to float is lost.
void weights_stay_bounded(void**) {
    BrdfTable spike;
    spike.rgb.assign(BrdfTable::cell_count * 3, 0.0f);
    std::fill_n(spike.rgb.begin() + std::ptrdiff_t(BrdfTable::cell(40, 30, 20) * 3), 3, 1.0f);
    for (const Brdf& brdf : {Brdf(spike), Brdf(BrdfTable{std::vector<float>(BrdfTable::cell_count * 3, -1.0f)})}) {
        const LobeSampler sampler(brdf);
        Random random(14);
        for (int i = 0; i < 10000; ++i) {
            const Vec3 wo = outgoing(random.uniform(0, 1.5));
            const double x = random.uniform(0.01, 1), phi = random.uniform(0, 2 * pi);
            if (!(incident(wo, x, phi).z > 0)) continue;
            const double density = density_at(sampler, wo, x, phi);
            assert_true(std::isfinite(density));
            check_at_most("an even sixteenth", 0.999 / 16 / (2 * pi), density);
        }
    }
}

// ---- The sequence ------------------------------------------------------------------------------------

void aligned_blocks_stratify_every_elementary_interval(void**) {
    for (uint32_t k = 0; k <= 8; ++k)
        for (const uint32_t block : {0u, 1u, 2u, 3u, 7u, 100u, (1u << 20) - 1})
            for (uint32_t columns = 0; columns <= k; ++columns) {
                std::vector<int> points(size_t(1) << k);
                for (uint32_t i = 0; i < 1u << k; ++i) {
                    const Vec2 u = to_unit(sequence_point((block << k) + i));
                    assert_true(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
                    const uint32_t x = uint32_t(std::ldexp(u.x, int(columns)));
                    const uint32_t y = uint32_t(std::ldexp(u.y, int(k - columns)));
                    ++points[(size_t(y) << columns) + x];
                }
                for (int count : points) assert_int_equal(count, 1);
            }
}

// ---- Pilots ------------------------------------------------------------------------------------------

double weight_at(const Case& one, const Vec3& wo, const Vec2& u) {
    const LobeSample sample = one.sampler.sample(wo, u);
    return sample.pdf > 0 ? luminance(evaluate(one.brdf, sample.wi, wo)) * sample.wi.z / sample.pdf : 0;
}

// Multiples k of the golden ratio stay (3 - sqrt(5)) / 2 / k or more away from whole numbers (Hurwitz 1891; least at k = 1), and two
// points k apart are k / n apart in the other coordinate: so far, at least, that the square is the sum of two squares of known product.
void lattice_points_keep_their_distance(void**) {
    for (const uint32_t n : {1u, 2u, 7u, 16u, 100u, 1024u}) {
        const double least = std::sqrt((3 - std::sqrt(5.0)) / n);
        for (uint32_t i = 0; i < n; ++i) {
            const Vec2 here = centred_lattice_point(i, n);
            assert_true(here.x > 0 && here.x < 1 && here.y >= 0 && here.y < 1);
            for (uint32_t j = 0; j < i; ++j) {
                const Vec2 apart = glm::abs(here - centred_lattice_point(j, n));
                // The ratio's 32 bits are wrong by up to 2^-33, n times.
                assert_true(glm::length(Vec2(apart.x, std::min(apart.y, 1 - apart.y))) >= least - n * 0x1p-33);
            }
        }
    }
}

// 256 pilots, one in each of 16 x 16 strata and at random in it, would have a mean of the variance
// sum(variance within a stratum) / 256^2; a lattice is more even than that. Five standard deviations.
void pilots_carry_the_albedo(void**) {
    constexpr int strata = 16, fine = 16;
    constexpr uint32_t count = strata * strata;
    LobeBandwidth constant;
    constant.values.assign(size_t(LobeBandwidth::views) * LobeBandwidth::side * LobeBandwidth::side, 3.0f);
    for (const auto& one : cases()) {
        const std::vector<Pilot> all = pilots(one->brdf, one->sampler, constant, count);
        assert_int_equal(all.size(), LobeTable::views * count);
        for (const int view : {0, 20, 40, 60}) {
            const double theta = (view + 0.5) / LobeTable::views * pi / 2;
            double variance = 0;
            for (int stratum = 0; stratum < strata * strata; ++stratum) {
                double sum = 0, squares = 0;
                for (int i = 0; i < fine * fine; ++i) {
                    const Vec2 corner(stratum % strata, stratum / strata), inside(i % fine, i / fine);
                    const double w =
                        weight_at(*one, outgoing(theta), (corner + (inside + 0.5) / double(fine)) / double(strata));
                    sum += w;
                    squares += w * w;
                }
                variance += squares / (fine * fine) - std::pow(sum / (fine * fine), 2);
            }
            double sum = 0;
            for (uint32_t i = 0; i < count; ++i) sum += double(all[size_t(view) * count + i].weight);
            // Weights are floats: 2^-24 of 1 each.
            check_close(one->name, sum / count, luminance(directional_albedo(one->brdf, theta)),
                        5 * std::sqrt(std::max(0.0, variance)) / count + 1e-5);
        }
    }
}

void pilots_stand_for_their_solid_angles(void**) {
    constexpr uint32_t count = 256;
    LobeBandwidth constant;
    constant.values.assign(size_t(LobeBandwidth::views) * LobeBandwidth::side * LobeBandwidth::side, 3.0f);
    for (const auto& one : cases()) {
        const std::vector<Pilot> all = pilots(one->brdf, one->sampler, constant, count);
        for (size_t i = 0; i < all.size(); ++i) {
            const Pilot& pilot = all[i];
            check_at_most("footprint", double(pilot.footprint), std::log2(2 * pi) + 1e-6);
            if (pilot.weight == 0) continue;
            const Vec3 wo = outgoing((double(i / count) + 0.5) / LobeTable::views * pi / 2);
            const Vec3 h(pilot.half[0], pilot.half[1], pilot.half[2]);
            const Vec3 wi = 2 * glm::dot(wo, h) * h - wo;
            const double pdf = one->sampler.pdf(wi, wo);
            const double footprint = std::min(std::log2(1 / (count * pdf)), std::log2(2 * pi));
            // The half vector is a float: its angle, at least 0.01, rounds by 6e-8; the density of the narrowest step
            // by less than a thousand times that.
            check_close("footprint", double(pilot.footprint), footprint, 1e-4);
            check_close("lobe bandwidth", double(pilot.lobe_bandwidth), 3, 0);
            const double f = luminance(evaluate(one->brdf, wi, wo));
            check_close("square", double(pilot.square), f * f / (2 * pi * pdf), 1e-3 * f * f / (2 * pi * pdf));
        }
    }
}

// ---- Clusters of the map ----------------------------------------------------------------------------------

// A dim sky with two lamps, one of them across the seam.
RgbImage lamps() {
    RgbImage map;
    map.width = 64;
    map.height = 32;
    map.rgb.assign(size_t(map.width) * map.height * 3, 0.1f);
    for (const size_t texel : {size_t(10 * 64), size_t(10 * 64 + 63), size_t(20 * 64 + 30)})
        for (size_t c = 0; c < 3; ++c) map.rgb[3 * texel + c] = 50.0f + 10.0f * float(c);
    return map;
}

void radiance_is_counted_in_a_power_of_two(void**) {
    const std::pair<float, double> units[] = {{1.0f, 1}, {3.0f, 2}, {0.7f, 0.5}, {1e15f, 0x1p49}, {0x1.8p-140f, 0x1p-140}, {0.0f, 1}};
    for (const auto& [radiance, unit] : units) {
        RgbImage map{8, 4, std::vector<float>(8 * 4 * 3, radiance), {}};
        // The mean of equal numbers rounds to either side of them.
        if (radiance > 0) map.rgb[0] *= 1.0001f;
        check_close("unit", MapSampler(map).unit(), unit, 0);
    }
}

// The least mean density of so many cells that are not black, over that of the sphere, looked up at the middles of parts that cut texels and
// cells evenly.
double least_of_cells(const RgbImage& map, const MapSampler& sampler, uint32_t columns, uint32_t rows) {
    const uint32_t across = columns * map.width, down = rows * map.height;
    std::vector<double> density(size_t(columns) * rows), solid_angles(density.size());
    for (uint32_t j = 0; j < down; ++j)
        for (uint32_t i = 0; i < across; ++i) {
            const double solid_angle = 2 * pi / across * (std::cos(pi * j / down) - std::cos(pi * (j + 1.0) / down));
            const size_t cell = size_t(j / map.height) * columns + i / map.width;
            density[cell] += solid_angle * sampler.pdf(direction_of(Vec2((i + 0.5) / across, (j + 0.5) / down)));
            solid_angles[cell] += solid_angle;
        }
    double least = 1e300;
    for (size_t cell = 0; cell < density.size(); ++cell)
        if (density[cell] > 0) least = std::min(least, density[cell] / solid_angles[cell]);
    return 4 * pi * least;
}

void the_dimmest_view_is_that_of_the_density(void**) {
    const std::pair<uint32_t, uint32_t> sizes[] = {{1, 1}, {2, 1}, {6, 3}, {5, 5}, {64, 32}};
    for (const auto& [width, height] : sizes) {
        Random random(width);
        RgbImage map{width, height, {}, {}};
        for (size_t i = 0; i < size_t(width) * height * 3; ++i) map.rgb.push_back(float(random.log_uniform(1e-6, 1)));
        const MapSampler sampler(map);
        check_close("dimmest octant", sampler.dimmest_view() / least_of_cells(map, sampler, 4, 2), 1, 1e-9);
    }
    // Black ground, an even sky that ends a row above it, and a lamp at the zenith, a quarter of it in each octant that is lit.
    RgbImage zenith{64, 32, std::vector<float>(64 * 32 * 3), {}};
    for (size_t i = 0; i < 64 * 15 * 3; ++i) zenith.rgb[i] = i < 64 * 3 ? 1e8f : 1.0f;
    const MapSampler sampler(zenith);
    const double view = sampler.dimmest_view();
    check_close("dimmest cell", view / least_of_cells(zenith, sampler, 32, 16), 1, 1e-9);
    // The lamp is 1 - cos(pi / 32) = 0.0048 of a hemisphere, and as much again of what lies beside it: the mean is 2.4e5 or a little more.
    assert_true(view < 1 / 2.4e5);
}

Vec3 direction_of(const MapPoint& point) { return {point.direction[0], point.direction[1], point.direction[2]}; }

void clusters_hold_all_points_and_equal_light(void**) {
    const RgbImage map = lamps();
    const MapSampler sampler(map);
    constexpr uint32_t count = 4096, parts = 16, each = count / parts;
    const std::vector<MapPoint> drawn = draw_map_points(map, sampler, Lookup::linear, 7, count);
    std::vector<MapPoint> points = drawn;
    const std::vector<MapCluster> clusters = cluster_points(&points, parts);
    assert_int_equal(clusters.size(), parts);

    // The same points in another order: told apart by their directions, summed with weights that no other set shares.
    const auto print = [](const std::vector<MapPoint>& all) {
        double sum = 0;
        for (const MapPoint& p : all) sum += std::sin(1e3 * p.direction[0]) + std::cos(2e3 * p.direction[1]) * p.direction[2];
        return sum;
    };
    check_close("points kept", print(points), print(drawn), 1e-9);  // the order of 4096 additions of doubles

    for (uint32_t k = 0; k < parts; ++k) {
        const Vec3 middle(clusters[k].direction[0], clusters[k].direction[1], clusters[k].direction[2]);
        double solid_angle = 0;
        for (uint32_t i = 0; i < each; ++i) {
            const MapPoint& point = points[k * each + i];
            solid_angle += point.inverse_pdf;
            const double cosine = glm::dot(middle, direction_of(point));
            if (clusters[k].sine < 1) assert_true(std::sqrt(std::max(0.0, 1 - cosine * cosine)) <= clusters[k].sine + 1e-3 && cosine > 0);
        }
        check_close("density", clusters[k].density * solid_angle / each, 1, 1e-5);
    }
}

// Of every two adjoining points of a cluster, one lies in each half of it: below and above the median along its widest extent.
void pairs_of_a_cluster_lie_in_both_halves(void**) {
    const RgbImage map = lamps();
    const MapSampler sampler(map);
    std::vector<MapPoint> points = draw_map_points(map, sampler, Lookup::linear, 8, 4096);
    cluster_points(&points, 16);
    for (size_t cluster = 0; cluster < 16; ++cluster) {
        const MapPoint* own = &points[cluster * 256];
        double extents[3];
        std::vector<double> along[3];
        for (int axis = 0; axis < 3; ++axis) {
            for (size_t i = 0; i < 256; ++i) along[axis].push_back(double(own[i].direction[axis]));
            const auto [low, high] = std::minmax_element(along[axis].begin(), along[axis].end());
            extents[axis] = *high - *low;
        }
        const auto& values = along[std::max_element(extents, extents + 3) - extents];
        std::vector<double> sorted = values;
        std::sort(sorted.begin(), sorted.end());
        for (size_t i = 0; i < 256; i += 2) {
            // The first of a pair comes from the lower half; equal values may stand on either side of the median.
            assert_true(values[i] <= sorted[128]);
            assert_true(values[i + 1] >= sorted[127]);
        }
    }
}

// Summed over the square of incident directions with their solid angles, a view's importance is its albedo.
void importance_adds_up_to_the_albedo(void**) {
    constexpr int side = LobeImportance::side;
    const LobeImportance importance = lobe_importance(Lambert{Vec3(0.8, 0.8, 0.8)});
    assert_int_equal(importance.values.size(), size_t(LobeTable::views) * side * side);
    double sum = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            // d(wi) / d(square): 2 s^3 with s = |x| + |y| + z of the unit direction; the base of the pyramid has area 2.
            const Vec3 wi = HemiOctahedral::to_direction(Vec2(x + 0.5, y + 0.5) / double(side));
            const double s = std::abs(wi.x) + std::abs(wi.y) + wi.z;
            sum += double(importance.values[size_t(y * side + x)]) * 2 * s * s * s / (side * side);
        }
    // Midpoints of 16 cells a side: a relative error of the order of 1 / 16^2.
    check_close("albedo", sum, 0.8, 0.8 * 0.01);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(densities_integrate_to_one),
        cmocka_unit_test(table_steps_tile_their_domain),
        cmocka_unit_test(dense_samples_come_first),
        cmocka_unit_test(samples_know_their_own_density),
        cmocka_unit_test(drawn_directions_follow_the_density),
        cmocka_unit_test(samples_reflect_the_albedo),
        cmocka_unit_test(weights_stay_bounded),
        cmocka_unit_test(aligned_blocks_stratify_every_elementary_interval),
        cmocka_unit_test(lattice_points_keep_their_distance),
        cmocka_unit_test(pilots_carry_the_albedo),
        cmocka_unit_test(pilots_stand_for_their_solid_angles),
        cmocka_unit_test(radiance_is_counted_in_a_power_of_two),
        cmocka_unit_test(the_dimmest_view_is_that_of_the_density),
        cmocka_unit_test(clusters_hold_all_points_and_equal_light),
        cmocka_unit_test(pairs_of_a_cluster_lie_in_both_halves),
        cmocka_unit_test(importance_adds_up_to_the_albedo),
    };
    return cmocka_run_group_tests_name("sampling", tests, nullptr, nullptr);
}
