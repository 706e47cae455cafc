// The shading integral of the renderer against a quadrature in double precision that shares no sampler with it, and the
// statistics of its samples.
#include "brdf_testing.h"
#include "quadrature.h"

namespace lightband {
namespace {

using namespace testing;

constexpr uint32_t side = 24;  // about 370 pixels of it see the sphere

struct Subject {
    const char* name;
    wrapper::Brdf rendered;
    Reflectance expected;
};

const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all = [] {
        const BrdfTable table = tabulated(Ggx{0.3, Vec3(0.9, 0.6, 0.3)});
        const float alpha = 0.25f;
        return std::vector<Subject>{
            {"table", software().table_brdf(table.rgb.data(), table.rgb.size()), table},
            {"Lambert", software().lambert({0.75f, 0.5f, 0.25f}), Lambert{Vec3(0.75, 0.5, 0.25)}},
            {"GGX", software().ggx(alpha, {0.875f, 0.5f, 0.25f}), Ggx{alpha, Vec3(0.875, 0.5, 0.25)}},
        };
    }();
    return all;
}

// ---- The integral ------------------------------------------------------------------------------------

// Deviations of 200 random pixels from the quadrature, in standard errors. If the renderer is right they are standard
// normal but for the tails that the light's own distribution leaves: 99.73 % within 3, demanded is 99 %, and all
// within 5. Their mean has the deviation 1 / sqrt(200): beyond three of that the renderer is biased.
void check_against_quadrature(const Frame& frame, const Subject& subject, const RgbImage& map, const Lookups& lookups) {
    constexpr int compared = 200;
    const Vec3 seen_from{eye[0], eye[1], eye[2]};
    const Deviations found = deviations(frame, {subject.expected, map, lookups, seen_from}, compared);
    assert_int_equal(found.compared, compared);
    print_message("%s, %s: mean %.3f standard errors, largest %.2f, %d beyond three\n", subject.name, lookups.name,
                  found.mean, found.largest, found.beyond_three);
    check_close("mean deviation", found.mean, 0, 3 / std::sqrt(compared));
    check_at_most("largest deviation", found.largest, 5);
    check_at_most("pixels beyond three standard errors", found.beyond_three, 0.01 * compared);
}

void reference_meets_the_quadrature(void**) {
    const RgbImage map = patched_map(64, 32);
    for (const Subject& subject : subjects()) {
        const Scene scene = scene_of("sphere", subject.rendered, environment(map));
        for (const Lookups& lookups : {nearest, linear}) {
            Frame frame = reference_frame(side, 4096);
            set_lookups(frame, lookups);
            frame.render(scene);
            check_against_quadrature(frame, subject, map, lookups);
        }
    }
}

// Every pixel shaded: what is left of the adaptive method are its samplers and its budget. Random points, so that the
// measured variance is that of the mean, or more: half of the combined samples always come from either side.
void adaptive_samples_meet_the_quadrature(void**) {
    const RgbImage map = patched_map(64, 32);
    for (const Subject& subject : subjects()) {
        const Scene scene = scene_of("sphere", subject.rendered, environment(map));
        for (const Lookups& lookups : {nearest, linear}) {
            Frame frame = software().frame(side, side);
            frame.set("coarsest_level", 0);
            frame.set("samples", 2048);
            frame.set("sampler", "combined");
            frame.set("sequence", "random");
            set_lookups(frame, lookups);
            frame.render(scene);
            check_against_quadrature(frame, subject, map, lookups);
        }
    }
}

double mean_square_difference(const std::vector<double>& a, const std::vector<double>& b,
                              const std::vector<size_t>& pixels) {
    double sum = 0;
    for (const size_t pixel : pixels) sum += (a[pixel] - b[pixel]) * (a[pixel] - b[pixel]);
    return sum / double(pixels.size());
}

// The shifted sequence is unbiased, and no worse than random points: half the mean square difference of two seeds
// against the variance that random points would have. The ratio of a mean of 370 squares is known to sqrt(2 / 370) = 7
// %.
void sequences_do_no_worse_than_random_points(void**) {
    const Scene scene = scene_of("sphere", subjects()[1].rendered, environment(patched_map(64, 32)));
    const auto render = [&](double seed) {
        Frame frame = software().frame(side, side);
        frame.set("coarsest_level", 0);
        frame.set("samples", 256);
        frame.set("seed", seed);
        frame.render(scene);
        return frame;
    };
    const Frame one = render(1), two = render(2);
    const std::vector<size_t> covered = covered_pixels(one);
    const std::vector<float> variance = field<float>(one, "variance_measured");
    const std::vector<uint32_t> samples = field<uint32_t>(one, "sample_count");
    double expected = 0;
    for (const size_t pixel : covered) expected += double(variance[pixel]) / samples[pixel] / double(covered.size());
    check_at_most("variance of the sequence's means",
                  0.5 * mean_square_difference(luminances(one), luminances(two), covered), 1.3 * expected);
}

// ---- Light that needs no sampling --------------------------------------------------------------------

Scene white_furnace() {
    return scene_of("blob", software().lambert({1, 1, 1}), environment(constant_map(1)));
}

// Albedo 1 under light of 1 everywhere reflects 1: samples of the cosine carry exactly that, and so do all weighted
// means.
void white_furnace_is_white(void**) {
    for (const char* method : {"reference", "adaptive"}) {
        Frame frame = software().frame(48, 48);
        frame.set("method", method);
        frame.set("sampler", "brdf");
        frame.render(white_furnace());
        const std::vector<float> color = field<float>(frame, "color");
        const std::vector<size_t> covered = covered_pixels(frame);
        assert_true(covered.size() > 500);
        for (const size_t pixel : covered) check_vector(method, vector_at(color, pixel, 4), Vec3(1), 1e-3);
    }
}

// Samples of the map scatter; the mean over all pixels is 1 within five standard errors of its own.
void white_furnace_is_white_on_average_by_both_samplers(void**) {
    Frame frame = software().frame(48, 48);
    frame.set("coarsest_level", 0);
    frame.set("sampler", "combined");
    frame.render(white_furnace());
    const std::vector<float> variance = field<float>(frame, "variance_measured");
    const std::vector<uint32_t> samples = field<uint32_t>(frame, "sample_count");
    const std::vector<double> found = luminances(frame);
    double sum = 0, error = 0;
    for (const size_t pixel : covered_pixels(frame)) {
        sum += found[pixel] - 1;
        error += double(variance[pixel]) / samples[pixel];
    }
    check_at_most("deviation of the sum", std::fabs(sum), 5 * std::sqrt(error));
    check_at_most("standard error of the mean", std::sqrt(error) / double(covered_pixels(frame).size()), 5e-3);
}

void black_maps_give_black_and_every_field_is_finite(void**) {
    for (const float light : {0.0f, 1.0f})
        for (const char* method : {"reference", "adaptive"})
            for (const Subject& subject : subjects()) {
                const RgbImage map = light == 0 ? constant_map(0) : patched_map(64, 32);
                Frame frame = software().frame(side, side);
                frame.set("method", method);
                frame.set("samples", 16);
                frame.set("background", "environment");
                frame.render(scene_of("knot", subject.rendered, environment(map)));
                for (uint32_t i = 0; i < lb_frame_buffer_count(); ++i) {
                    const std::string name = lb_frame_buffer_name(i);
                    lb_buffer raw = nullptr;
                    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
                    if (lb_frame_map(frame.get(), name.c_str(), &raw, &view) == LB_ERROR_INVALID_STATE) continue;
                    const Buffer buffer(raw, view, nullptr);
                    if (view.type != LB_TYPE_FLOAT32 || name == "depth") continue;
                    for (const float value : field<float>(frame, name.c_str()))
                        if (!std::isfinite(value))
                            fail_msg("%s, %s, %s: %g", subject.name, method, name.c_str(), double(value));
                }
                if (light == 0)
                    for (const double value : luminances(frame)) check_close("black", value, 0, 0);
                // Infinite where nothing is seen, and only there.
                const std::vector<float> depth = field<float>(frame, "depth");
                const std::vector<uint8_t> material = field<uint8_t>(frame, "material");
                for (size_t i = 0; i < depth.size(); ++i) assert_true(std::isfinite(depth[i]) == (material[i] != 0));
            }
}

// ---- Counts and seeds --------------------------------------------------------------------------------

// 10,000 samples run in three parts. Half the mean square difference of two seeds is the variance of the mean, measured
// / N: known to sqrt(2 / 370) = 7 %, four of which are allowed.
void many_samples_are_drawn_and_pay(void**) {
    const Scene scene = scene_of("sphere", subjects()[2].rendered, environment(patched_map(64, 32)));
    for (const uint32_t asked : {500u, 10000u}) {
        Frame one = reference_frame(side, asked, 1), two = reference_frame(side, asked, 2);
        one.render(scene);
        two.render(scene);
        const std::vector<size_t> covered = covered_pixels(one);
        const std::vector<uint32_t> samples = field<uint32_t>(one, "sample_count");
        const std::vector<float> variance = field<float>(one, "variance_measured");
        double expected = 0;
        for (const size_t pixel : covered) {
            assert_int_equal(samples[pixel], asked);
            expected += double(variance[pixel]) / asked / double(covered.size());
        }
        assert_int_equal(one.stats().samples, covered.size() * asked);
        const double found = 0.5 * mean_square_difference(luminances(one), luminances(two), covered);
        check_close("variance of the mean over its prediction", found / expected, 1,
                    4 * std::sqrt(2.0 / double(covered.size())));
    }
}

// Four seeds give two differences that share nothing: their correlation over n pixels is 0 within 4 / sqrt(n).
void seeds_repeat_and_differ(void**) {
    const Scene scene = scene_of("sphere", subjects()[1].rendered, environment(patched_map(64, 32)));
    for (const char* method : {"reference", "adaptive"}) {
        const auto render = [&](double seed) {
            Frame frame = software().frame(side, side);
            frame.set("method", method);
            frame.set("coarsest_level", 0);
            frame.set("seed", seed);
            frame.render(scene);
            return frame;
        };
        const Frame first = render(1);
        assert_true(field<float>(first, "color") == field<float>(render(1), "color"));
        const std::vector<double> a = luminances(first), b = luminances(render(2)), c = luminances(render(3)),
                                  d = luminances(render(4));
        double ab = 0, cd = 0, both = 0;
        const std::vector<size_t> covered = covered_pixels(first);
        for (const size_t i : covered) {
            ab += (a[i] - b[i]) * (a[i] - b[i]);
            cd += (c[i] - d[i]) * (c[i] - d[i]);
            both += (a[i] - b[i]) * (c[i] - d[i]);
        }
        assert_true(ab > 0 && cd > 0);
        check_close("correlation of seeds", both / std::sqrt(ab * cd), 0, 4 / std::sqrt(double(covered.size())));
    }
}

// Accumulation is the mean of successive seeds; each mean is a float.
void accumulated_frames_are_means_of_seeds(void**) {
    const Scene scene = scene_of("sphere", subjects()[2].rendered, environment(patched_map(64, 32)));
    Frame accumulated = reference_frame(side, 16, 10);
    accumulated.set("accumulate", 4);
    accumulated.render(scene);
    std::vector<double> mean(size_t(side) * side);
    for (int i = 0; i < 4; ++i) {
        Frame frame = reference_frame(side, 16, 10 + i);
        frame.render(scene);
        const std::vector<double> one = luminances(frame);
        for (size_t pixel = 0; pixel < mean.size(); ++pixel) mean[pixel] += one[pixel] / 4;
    }
    const std::vector<double> found = luminances(accumulated);
    for (size_t pixel = 0; pixel < mean.size(); ++pixel)
        check_close("mean", found[pixel], mean[pixel], 0x1p-22 * mean[pixel]);
    assert_int_equal(accumulated.stats().samples, covered_pixels(accumulated).size() * 16 * 4);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(reference_meets_the_quadrature),
        cmocka_unit_test(adaptive_samples_meet_the_quadrature),
        cmocka_unit_test(sequences_do_no_worse_than_random_points),
        cmocka_unit_test(white_furnace_is_white),
        cmocka_unit_test(white_furnace_is_white_on_average_by_both_samplers),
        cmocka_unit_test(black_maps_give_black_and_every_field_is_finite),
        cmocka_unit_test(many_samples_are_drawn_and_pay),
        cmocka_unit_test(seeds_repeat_and_differ),
        cmocka_unit_test(accumulated_frames_are_means_of_seeds),
    };
    return cmocka_run_group_tests_name("method", tests, nullptr, nullptr);
}
