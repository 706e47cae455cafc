// What the prediction rests on, seen from outside: the bandwidth of maps against double precision, curvature against
// known shapes, independence of the unit of length, and a plan without needless passes.
#include <cstring>

#include "bandwidth/octahedral.h"
#include "bandwidth/wavelet.h"
// clang-format off
#include "lights/environment.h"  // before the wrapper
#include "rendering.h"
// clang-format on

namespace lightband {
namespace {

using namespace testing;

// ---- Bandwidth of a map ------------------------------------------------------------------------------

// Another value in every texel, over five octaves of brightness: wavelet coefficients are of the size of the light
// itself, far above the rounding of float.
RgbImage rough_map(uint32_t width, uint32_t height) {
    Random random(51);
    RgbImage map{width, height, {}};
    for (uint32_t i = 0; i < width * height * 3; ++i) map.rgb.push_back(float(std::exp2(random.uniform(-2, 3))));
    return map;
}

// The octahedral square of the map's luminance, each texel the mean of lookups x lookups texels of the map.
SquareImage resampled(const RgbImage& map, int square_side, int lookups) {
    SquareImage image(square_side);
    for (int y = 0; y < square_side; ++y)
        for (int x = 0; x < square_side; ++x) {
            double sum = 0;
            for (int j = 0; j < lookups; ++j)
                for (int i = 0; i < lookups; ++i) {
                    const Vec2 square((x + (i + 0.5) / lookups) / square_side, (y + (j + 0.5) / lookups) / square_side);
                    sum += luminance(radiance(map, Octahedral::to_direction(square), Lookup::nearest));
                }
            image.at(x, y) = sum / (lookups * lookups);
        }
    return image;
}

// Cycles per radian on the octahedral square, as the renderer's device computes them.
std::vector<float> device_bandwidth(const RgbImage& map, BandRule rule, int* square_side) {
    const auto device = std::make_shared<gl::Device>(LB_DEVICE_SOFTWARE, nullptr, nullptr);
    return device->run([&] {
        const EnvironmentLight light(device, map);
        const EnvironmentBandwidth& bandwidth = light.bandwidth(rule);
        *square_side = int(bandwidth.side);
        std::vector<float> values(size_t(bandwidth.side) * bandwidth.side);
        bandwidth.bandwidth.read(0, GL_RED, GL_FLOAT, values.size() * sizeof(float), values.data());
        return values;
    });
}

// Coefficients of float are good to about 2^-20 of the light, and so is the place of the percentile within its band.
// More comes from the resampling: OpenGL leaves open how exact an arc tangent is, and a lookup within 1e-5 of a texel's
// edge, one in ten thousand, may read its neighbour: one or two of the 16,384. Each changes the coefficients of a band
// k levels up by 4^-k of the finest, whose reach is 8 x 8 texels; every texel sees the coarsest. So 2e-3, but for one
// texel in twenty, which may turn out as the next band: one octave. Map sizes are odd, so that no lookup lies on an
// edge by construction.
void map_bandwidth_is_that_of_double_precision(void**) {
    struct Size {
        uint32_t width, height;
        int lookups;
    };
    for (const Size& size : {Size{51, 25, 1}, Size{97, 49, 2}})
        for (const BandRule rule : {BandRule::energy, BandRule::sum}) {
            const RgbImage map = rough_map(size.width, size.height);
            int square_side = 0;
            const std::vector<float> found = device_bandwidth(map, rule, &square_side);
            const auto limits = local_band_limits(analyse(resampled(map, square_side, size.lookups), octahedral_border),
                                                  square_side, octahedral_border, rule);
            assert_int_equal(found.size(), limits.size());
            int off = 0;
            for (int y = 0; y < square_side; ++y)
                for (int x = 0; x < square_side; ++x) {
                    const size_t i = size_t(y) * size_t(square_side) + size_t(x);
                    const Vec3 d = Octahedral::to_direction({(x + 0.5) / square_side, (y + 0.5) / square_side});
                    const double expected = limits[i].frequency * square_side * stretch(Octahedral{}, d);
                    const double ratio = double(found[i]) / expected;
                    check_close("octaves", std::log2(ratio), 0, 1 + 1e-4);
                    off += std::fabs(ratio - 1) > 2e-3;
                }
            print_message("%u x %u: %d texels off\n", size.width, size.height, off);
            check_at_most("texels that differ", off, 0.05 * square_side * square_side);
        }
}

// ---- Curvature ---------------------------------------------------------------------------------------

Frame adaptive_frame(uint32_t side, const Scene& scene) {
    Frame frame = software().frame(side, side);
    frame.set("samples", 4);
    frame.render(scene);
    return frame;
}

// Pixels whose surface is seen under a cosine of at least this.
std::vector<size_t> facing_pixels(const Frame& frame, double cosine) {
    const std::vector<float> position = field<float>(frame, "position"), normal = field<float>(frame, "normal");
    std::vector<size_t> facing;
    for (const size_t pixel : covered_pixels(frame)) {
        const Vec3 wo = glm::normalize(Vec3(eye[0], eye[1], eye[2]) - vector_at(position, pixel));
        if (glm::dot(wo, vector_at(normal, pixel)) >= cosine) facing.push_back(pixel);
    }
    return facing;
}

// Shapes whose largest principal curvature is the same everywhere: the sphere's 1 / 0.5 m, the torus's tube of 0.14 m.
// Chords of a sphere and differences of its normals are in exact proportion, and so they are nearly on its facets. On
// the torus a step that is no principal direction mixes the two curvatures in the order of the angle it turns by: with
// 192 pixels to a metre, under a cosine of 0.5, 1 / 192 / 0.5 / 0.14 = 0.07.
void curvature_is_that_of_the_shape(void**) {
    const wrapper::Brdf white = software().lambert({1, 1, 1});
    const Environment light = environment(constant_map(1));
    const auto check_shape = [&](const char* shape, double expected, double median_tolerance, double tolerance) {
        const Frame frame = adaptive_frame(192, scene_of(shape, white, light));
        const std::vector<float> curvature = field<float>(frame, "curvature");
        std::vector<double> found;
        for (const size_t pixel : facing_pixels(frame, 0.5)) found.push_back(double(curvature[pixel]));
        assert_true(found.size() > 3000);
        print_message("%s: curvature %.4f .. %.4f .. %.4f\n", shape, percentile(found, 0.02), percentile(found, 0.5),
                      percentile(found, 0.98));
        check_close(shape, percentile(found, 0.5), expected, median_tolerance);
        check_close(shape, percentile(found, 0.02), expected, tolerance);
        check_close(shape, percentile(found, 0.98), expected, tolerance);
    };
    check_shape("sphere", 2, 0.01 * 2, 0.02 * 2);
    check_shape("torus", 1 / 0.14, 0.01 / 0.14, 0.07 / 0.14);
    // Normals of a plane are alike to float's rounding, 2^-23 over a pixel of 0.005 metres.
    check_shape("plane", 0, 5e-5, 5e-5);
}

// ---- The unit of length ------------------------------------------------------------------------------

struct Picture {
    std::vector<uint8_t> level, shaded;
    std::vector<float> color;
    std::vector<uint32_t> samples;
    std::vector<float> variance;
};

Picture scaled_picture(float scale) {
    const Scene scene =
        scene_of("blob", software().ggx(0.1f, {0.9f, 0.6f, 0.3f}), environment(patched_map(64, 32)), scale);
    Frame frame = software().frame(64, 64);
    frame.set("samples", 256);
    frame.render(scene);
    return {field<uint8_t>(frame, "level"), field<uint8_t>(frame, "shaded"), field<float>(frame, "color"),
            field<uint32_t>(frame, "sample_count"), field<float>(frame, "variance_measured")};
}

// Powers of two scale every float exactly. Powers of ten round differently: where a bandwidth lies within 1e-6 of a
// level's border, or a silhouette within 1e-6 of a pixel's centre, one pixel in two hundred may change; the others'
// samples are the same, but for a cell or texel that rounding exchanges, far below their noise.
void pictures_do_not_depend_on_the_unit(void**) {
    const Picture metres = scaled_picture(1);
    for (const float scale : {0x1p-20f, 0x1p20f}) {
        const Picture other = scaled_picture(scale);
        assert_true(other.level == metres.level);
        assert_true(other.shaded == metres.shaded);
        assert_true(other.color == metres.color);
    }
    for (const float scale : {1e-6f, 1e6f}) {
        const Picture other = scaled_picture(scale);
        size_t changed = 0, compared = 0, beyond = 0;
        for (size_t i = 0; i < metres.level.size(); ++i) {
            changed += other.level[i] != metres.level[i] || other.shaded[i] != metres.shaded[i];
            if (metres.shaded[i] == 0 || other.shaded[i] == 0 || metres.samples[i] != other.samples[i]) continue;
            ++compared;
            const double difference =
                luminance(vector_at(other.color, i, 4)) - luminance(vector_at(metres.color, i, 4));
            beyond += std::fabs(difference) > std::sqrt(double(metres.variance[i]) / metres.samples[i]);
        }
        print_message("scale %g: %zu pixels changed, %zu compared, %zu differ\n", double(scale), changed, compared,
                      beyond);
        check_at_most("pixels whose level changed", double(changed), double(metres.level.size()) / 200);
        assert_true(compared > 100);
        check_at_most("pixels that differ by more than noise", double(beyond), double(compared) / 200);
    }
}

// ---- The plan ----------------------------------------------------------------------------------------

bool has_pass(const Frame& frame, const std::string& name) {
    const std::string plan = "\n" + frame.explain();
    return plan.find("\n" + name + " ") != std::string::npos;
}

void plans_hold_no_needless_pass(void**) {
    const Scene scene = scene_of("sphere", software().lambert({1, 1, 1}), environment(patched_map(64, 32)));
    const auto planned = [&](const std::vector<std::pair<std::string, std::string>>& choices, double coarsest) {
        Frame frame = software().frame(16, 16);
        frame.set("samples", 4);
        frame.set("coarsest_level", coarsest);
        for (const auto& [name, value] : choices) frame.set(name, value);
        frame.render(scene);
        return frame;
    };
    const Frame adaptive = planned({}, 3);
    for (const char* pass :
         {"gbuffer", "environment", "bandwidth", "pyramids", "classify", "list", "shade", "upsample", "total"})
        if (!has_pass(adaptive, pass)) fail_msg("no pass %s in\n%s", pass, adaptive.explain().c_str());
    assert_false(has_pass(adaptive, "background"));
    const Frame reference = planned({{"method", "reference"}}, 3);
    for (const char* pass : {"environment", "bandwidth", "pyramids", "upsample", "background"})
        if (has_pass(reference, pass)) fail_msg("needless pass %s in\n%s", pass, reference.explain().c_str());
    for (const char* pass : {"gbuffer", "shade"}) assert_true(has_pass(reference, pass));
    const Frame every_pixel = planned({}, 0);
    assert_false(has_pass(every_pixel, "upsample"));
    assert_true(has_pass(planned({{"background", "environment"}}, 3), "background"));
}

// Levels keep to Nyquist's bound wherever bandwidth says so (eq. 11); interpolated pixels draw nothing, shaded ones do.
void levels_follow_the_bandwidth(void**) {
    const Scene scene = scene_of("blob", software().ggx(0.1f, {0.9f, 0.6f, 0.3f}), environment(patched_map(64, 32)));
    Frame frame = software().frame(64, 64);
    frame.set("bandwidth_scale", 1);
    frame.render(scene);
    const std::vector<float> bandwidth = field<float>(frame, "bandwidth_image");
    const std::vector<uint8_t> level = field<uint8_t>(frame, "level"), shaded = field<uint8_t>(frame, "shaded");
    const std::vector<uint32_t> samples = field<uint32_t>(frame, "sample_count");
    size_t interpolated = 0;
    for (const size_t pixel : covered_pixels(frame)) {
        check_at_most("bandwidth", double(bandwidth[pixel]), 0.5);
        // log2 of a float is good to 2^-22 or so.
        check_at_most("spacing times bandwidth", std::exp2(level[pixel]) * double(bandwidth[pixel]), 0.5 * (1 + 1e-6));
        assert_int_equal(samples[pixel] > 0, shaded[pixel]);
        interpolated += shaded[pixel] == 0;
    }
    assert_true(interpolated > 0);
    assert_int_equal(frame.stats().shaded_pixels, covered_pixels(frame).size() - interpolated);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(map_bandwidth_is_that_of_double_precision),
        cmocka_unit_test(curvature_is_that_of_the_shape),
        cmocka_unit_test(pictures_do_not_depend_on_the_unit),
        cmocka_unit_test(plans_hold_no_needless_pass),
        cmocka_unit_test(levels_follow_the_bandwidth),
    };
    return cmocka_run_group_tests_name("prediction", tests, nullptr, nullptr);
}
