// Extremes of every input, each against the oracle or a closed form in double precision. A row is one figure with its
// bound; `test_extremes` prints them all (bench/extremes.py collects them).
#include "base/text.h"
#include "brdf_testing.h"
#include "quadrature.h"
#include "surfaces.h"

namespace lightband {
namespace {

using namespace testing;

// ---- Rows --------------------------------------------------------------------------------------------

void row(const std::string& name, const char* figure, double measured, double bound) {
    print_message("row | %s | %s | %.3g | %.3g\n", name.c_str(), figure, measured, bound);
    check_at_most((name + ", " + figure).c_str(), measured, bound);
}

// Numbers that are neither NaN nor infinite, in every field that a frame has; depth is infinite where nothing is seen.
void row_of_finite_fields(const std::string& name, const Frame& frame) {
    int wrong = 0;
    const std::vector<uint8_t> material = field<uint8_t>(frame, "material");
    for (uint32_t i = 0; i < lb_frame_buffer_count(); ++i) {
        const std::string field_name = lb_frame_buffer_name(i);
        const Buffer buffer = frame.map(field_name);
        if (buffer.view().type != LB_TYPE_FLOAT32) continue;
        const std::vector<float> values = field<float>(frame, field_name.c_str());
        for (size_t k = 0; k < values.size(); ++k)
            wrong += !std::isfinite(values[k]) && !(field_name == "depth" && material[k] == 0);
    }
    row(name, "values that are not finite", wrong, 0);
}

// ---- Frames ------------------------------------------------------------------------------------------

const Vec3 usual_eye{eye[0], eye[1], eye[2]};
constexpr uint32_t side = 24;  // about 370 pixels of it see the sphere

// Every pixel is shaded, by independent points: the measured variance is that of the mean.
Frame sampled_frame(uint32_t width, uint32_t height, double samples) {
    Frame frame = software().frame(width, height);
    frame.set("coarsest_level", 0);
    frame.set("samples", samples);
    frame.set("sampler", "combined");  // unbiased: its deviations are counted in standard errors
    frame.set("sequence", "random");
    set_lookups(frame, nearest);
    return frame;
}

// Light from the lobe alone and the same everywhere: every sample of a white lobe carries exactly albedo times radiance.
Frame exact_frame(uint32_t width, uint32_t height, double samples) {
    Frame frame = software().frame(width, height);
    frame.set("samples", samples);
    frame.set("max_samples", samples);
    frame.set("sampler", "brdf");
    return frame;
}

// Largest |L / expected - 1| of the covered pixels.
double relative_deviation(const Frame& frame, double expected) {
    double largest = 0;
    const std::vector<double> found = luminances(frame);
    for (const size_t pixel : covered_pixels(frame))
        largest = std::max(largest, std::fabs(found[pixel] / expected - 1));
    return largest;
}

struct Subject {
    const char* name;
    wrapper::Brdf rendered;
    Reflectance expected;
    int oracle_rows;  // see Expectation; lobes seen at grazing angles and steps between cells need more
    size_t pixels;    // that many are compared
};

const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all = [] {
        const BrdfTable table = tabulated(Ggx{0.3, Vec3(0.9, 0.6, 0.3)});
        return std::vector<Subject>{
            {"table", software().table_brdf(table.rgb.data(), table.rgb.size()), table, 384, 24},
            {"Lambert", software().lambert({0.75f, 0.5f, 0.25f}), Lambert{Vec3(0.75, 0.5, 0.25)}, 96, 200},
            {"GGX", software().ggx(0.25f, {0.875f, 0.5f, 0.25f}), Ggx{0.25, Vec3(0.875, 0.5, 0.25)}, 192, 100},
        };
    }();
    return all;
}

// Standard normal deviations: the mean of n has the deviation 1 / sqrt(n), of which three are allowed; one in two million
// exceeds 5, and the light's own distribution leaves tails that are somewhat longer.
void rows_against_oracle(const std::string& name, const Frame& frame, const Subject& subject, const RgbImage& map,
                         const Vec3& seen_from) {
    const Deviations found =
        deviations(frame, {subject.expected, map, nearest, seen_from, subject.oracle_rows}, subject.pixels);
    row(name, "mean deviation, standard errors", std::fabs(found.mean), 3 / std::sqrt(found.compared));
    row(name, "largest deviation, standard errors", found.largest, 5);
}

// ---- Views, curvatures, sizes ------------------------------------------------------------------------

// From 1 down to 1e-6 by the column.
void view_cosines(void**) {
    constexpr int columns = 32, rows = 16;
    const RgbImage map = patched_map(64, 32);
    for (const Subject& subject : subjects()) {
        Patches patches(columns, rows);
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x)
                patches.add(x, y, normal_under(std::pow(10, -6.0 * x / (columns - 1)), patches.to_eye(x, y)));
        Frame frame = sampled_frame(columns, rows, 1024);
        frame.render(patches.scene(subject.rendered, environment(map)));
        assert_int_equal(frame.stats().covered_pixels, columns * rows);
        assert_int_equal(frame.stats().bent_normals, 0);
        const std::string name = std::string("view cosines 1 .. 1e-6, ") + subject.name;
        rows_against_oracle(name, frame, subject, map, Vec3(0));
        row_of_finite_fields(name, frame);
    }
}

// Cosines that rounding may turn to either side of 0 are bent towards the eye, and counted.
void view_cosines_about_zero(void**) {
    constexpr int columns = 64, rows = 32;
    Patches patches(columns, rows);
    Random random(71);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            patches.add(x, y, normal_under(random.uniform(-1e-7, 1e-7), patches.to_eye(x, y)));
    for (const Subject& subject : subjects()) {
        Frame frame = sampled_frame(columns, rows, 16);
        frame.render(patches.scene(subject.rendered, environment(patched_map(64, 32))));
        const std::string name = std::string("view cosines within 1e-7 of 0, ") + subject.name;
        row(name, "normals that were not bent", columns * rows - double(frame.stats().bent_normals), 0);
        row_of_finite_fields(name, frame);
    }
}

// Chords of a sphere and differences of its normals are in exact proportion, and so they are nearly on its facets: the
// bounds of test_prediction, for radii of 1e-6 to 1e6 metres. Under a cosine below 0.5 facets show.
void curvatures(void**) {
    for (const double radius : {1e-6, 1.0, 1e6}) {
        Frame frame = software().frame(128, 128);
        frame.set("samples", 4);
        const float scale = float(2 * radius);
        frame.render(scene_of("sphere", software().lambert({1, 1, 1}), environment(constant_map(1)), scale));
        const std::vector<float> curvature = field<float>(frame, "curvature");
        const std::vector<float> position = field<float>(frame, "position"), normal = field<float>(frame, "normal");
        std::vector<double> deviation;
        for (const size_t pixel : covered_pixels(frame)) {
            const ShadingPoint at = shading_point(position, normal, pixel, double(scale) * usual_eye);
            if (glm::dot(at.wo, at.normal) < 0.5) continue;
            deviation.push_back(std::fabs(double(curvature[pixel]) * radius - 1));
        }
        const std::string name = text("curvature of a sphere of radius ", radius, " m");
        row(name, "median relative deviation", percentile(deviation, 0.5), 0.01);
        row(name, "98th percentile of it", percentile(deviation, 0.98), 0.02);
        row_of_finite_fields(name, frame);
    }
}

// A wall in one plane: every normal the same float, so differences vanish to the last bit.
void curvature_of_a_plane(void**) {
    constexpr int columns = 32, rows = 24;
    for (const double unit : {1e-6, 1.0, 1e6}) {
        Patches patches(columns, rows, unit);
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) patches.add(x, y, Vec3(0, 0, 1));
        Frame frame = software().frame(columns, rows);
        frame.render(patches.scene(software().lambert({1, 1, 1}), environment(constant_map(1))));
        double largest = 0;
        for (const float curvature : field<float>(frame, "curvature")) largest = std::max(largest, double(curvature));
        // Rasterisation interpolates equal normals with weights whose sum rounds by up to 2^-22; normalising leaves 2^-23 of
        // that in each component, over a pixel of 0.73 / 24 of the distance.
        row(text("curvature of a plane ", unit, " m away"), "curvature times distance", largest * unit, 0x1p-22 / 0.03);
    }
}

// Lambert's light is the same all over one side, and nothing may be interpolated across.
void creases(void**) {
    constexpr int columns = 32, rows = 32;
    const RgbImage map = patched_map(64, 32);
    const Subject& subject = subjects()[1];
    Scene scene = software().scene();
    scene.add(ridge(), subject.rendered);
    scene.set_environment(environment(map));
    scene.set_camera({{0, 0, 0}, {0, 0, -1}});
    Frame frame = software().frame(columns, rows);
    frame.set("samples", 16384);
    frame.set("bandwidth_scale", 1);  // as sparse as the prediction allows
    set_lookups(frame, nearest);
    frame.render(scene);
    assert_true(frame.stats().shaded_pixels < columns * rows / 2);  // or nothing could be smeared

    const Vec3 sides[2] = {glm::normalize(Vec3(-1, 0, 1)), glm::normalize(Vec3(1, 0, 1))};
    OracleSettings settings;
    settings.environment_lookup = Lookup::nearest;
    double expected[2];
    for (int i = 0; i < 2; ++i)
        expected[i] = luminance(reflected_radiance(subject.expected, map, {sides[i], Vec3(0, 0, 1)}, settings));
    const double step = std::fabs(expected[1] - expected[0]);
    const std::vector<double> found = luminances(frame);
    const std::vector<float> variance = field<float>(frame, "variance_measured");
    const std::vector<uint32_t> samples = field<uint32_t>(frame, "sample_count");
    double noise = 0, largest = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        if (samples[i] > 0) noise = std::max(noise, std::sqrt(double(variance[i]) / samples[i]));
        largest = std::max(largest, std::fabs(found[i] - expected[i % columns >= columns / 2]));
    }
    // A parent from beyond has a quarter of the weight at least (of four; half of two), and brings as much of the step. Five
    // deviations of one pixel are below half of that, or the row says nothing; means over parents vary less.
    check_at_most("noise over the step", 5 * noise, 0.125 * step);
    // Each side is a plane, and the flatter neighbour tells: see curvature_of_a_plane.
    const std::vector<float> curvature = field<float>(frame, "curvature");
    row("crease of 90 degrees", "curvature beside it, 1/m", double(*std::max_element(curvature.begin(), curvature.end())),
        0x1p-22 / 0.02);
    row("crease of 90 degrees", "largest deviation over the step", largest / step, 5 * noise / step);
}

// Every pixel's normal is at a right angle to its neighbours': a curvature of the normals' distance over the pixel's width.
void nothing_but_creases(void**) {
    constexpr int columns = 32, rows = 32;
    Patches patches(columns, rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) patches.add(x, y, glm::normalize(Vec3(x % 2 == 0 ? -1 : 1, 0, 1)));
    Frame frame = software().frame(columns, rows);
    frame.render(patches.scene(subjects()[2].rendered, environment(patched_map(64, 32))));
    const double pixel = 2 * std::tan(0.7 / 2) / rows;
    double largest = 0;
    for (const float curvature : field<float>(frame, "curvature"))
        largest = std::max(largest, std::fabs(double(curvature) * pixel / std::sqrt(2.0) - 1));
    // Both positions of a step round by up to 10 * 2^-24 of the distance, 1 metre (see near_and_far_planes).
    row("crease at every pixel", "relative deviation of curvature", largest, 2 * 10 * 0x1p-24 / pixel);
    row_of_finite_fields("crease at every pixel", frame);
}

void scenes_of_any_size(void**) {
    const RgbImage map = patched_map(64, 32);
    for (const float scale : {1e-6f, 1e6f})
        for (const Subject& subject : subjects()) {
            Frame frame = sampled_frame(side, side, 1024);
            frame.render(scene_of("sphere", subject.rendered, environment(map), scale));
            const std::string name = text("scene of ", scale, " m, ", subject.name);
            rows_against_oracle(name, frame, subject, map, double(scale) * usual_eye);
            row_of_finite_fields(name, frame);
        }
}

// Planes one behind the other by 1e-5 of their distance, the farther drawn last, between near and far planes of 1e-4 and
// 1e6. Reversed depth n / z is a float, 2^-24 of itself: it tells distances apart down to 1e-7.
void near_and_far_planes(void**) {
    const wrapper::Brdf white = software().lambert({1, 1, 1});
    const Mesh plane = software().builtin_mesh("plane", 8);
    for (const float distance : {2e-4f, 1e-2f, 1.0f, 1e3f, 5e5f}) {
        Scene scene = software().scene();
        for (const float factor : {1.0f, 1 + 1e-5f}) {
            const float z = -distance * factor, size = 4 * distance;
            scene.add(plane, white, Transform{size, 0, 0, 0, 0, size, 0, 0, 0, 0, size, z});
        }
        scene.set_environment(environment(constant_map(1)));
        scene.set_camera({{0, 0, 0}, {0, 0, -1}, {0, 0, 0}, 0, 1e-4f, 1e6f});
        Frame frame = software().frame(16, 16);
        frame.set("samples", 1);
        frame.render(scene);
        int behind = 0;
        double deviation = 0;
        for (const uint8_t material : field<uint8_t>(frame, "material")) behind += material != 1;
        for (const float depth : field<float>(frame, "depth"))
            deviation = std::max(deviation, std::fabs(double(depth) / double(distance) - 1));
        const std::string name = text("planes 1e-4 and 1e6 m, seen at ", distance, " m");
        row(name, "pixels that show the farther", behind, 0);
        // The rasteriser interpolates the position by three products and two sums, each rounding by 2^-24, of weights that
        // hold as many.
        row(name, "relative deviation of depth", deviation, 10 * 0x1p-24);
    }
}

// ---- Light -------------------------------------------------------------------------------------------

// Log-uniform over the range of half floats, denormals included.
RgbImage half_range_map() {
    Random random(61);
    RgbImage map{64, 32, {}};
    for (int i = 0; i < 64 * 32 * 3; ++i) map.rgb.push_back(float(random.log_uniform(6e-8, 65504)));
    return map;
}

RgbImage one_bright_texel(float radiance) {
    RgbImage map{64, 32, std::vector<float>(64 * 32 * 3)};
    for (size_t c = 0; c < 3; ++c) map.rgb[3 * (10 * 64 + 26) + c] = radiance;  // 31 degrees up, 30 off +Z: cosine 0.73
    return map;
}

// The plane looks along +Z, so that no texel that matters is cut by its horizon.
void maps_of_any_range(void**) {
    const std::pair<const char*, RgbImage> maps[] = {{"texels of 6e-8 .. 65504", half_range_map()},
                                                     {"one texel of 1e6", one_bright_texel(1e6f)}};
    for (const auto& [map_name, map] : maps)
        for (const Subject& subject : subjects()) {
            Frame frame = sampled_frame(side, side, 1024);
            frame.render(scene_of("plane", subject.rendered, environment(map)));
            const std::string name = std::string(map_name) + ", " + subject.name;
            rows_against_oracle(name, frame, subject, map, usual_eye);
            row_of_finite_fields(name, frame);
        }
}

// Below 2^-126 a float is a whole number of units of 2^-149, and a device may take it for 0. The same map 2^140 times as bright has
// every digit: the picture is that one's, rounded to whole units.
void maps_of_denormals(void**) {
    Random random(62);
    RgbImage map{64, 32, {}}, brighter = map;
    for (int i = 0; i < 64 * 32 * 3; ++i) {
        map.rgb.push_back(float(random.log_uniform(0x1p-149, 0x1p-126)));
        brighter.rgb.push_back(float(double(map.rgb.back()) * 0x1p140));
    }
    for (const Subject& subject : subjects()) {
        const auto render = [&](const RgbImage& light) {
            Frame frame = sampled_frame(side, side, 64);
            frame.render(scene_of("sphere", subject.rendered, environment(light)));
            return frame;
        };
        const Frame frame = render(map);
        const std::vector<double> found = luminances(frame), expected = luminances(render(brighter));
        double largest = 0;
        for (size_t i = 0; i < found.size(); ++i) largest = std::max(largest, std::fabs(found[i] / 0x1p-149 - expected[i] / 0x1p-9));
        const std::string name = std::string("texels below 2^-126, ") + subject.name;
        // Half a unit of each channel, and the rounding of three products and two sums of doubles.
        row(name, "largest deviation of luminance, units of 2^-149", largest, 0.5 + 1e-6);
        row_of_finite_fields(name, frame);
    }
}

// The brightest texels that are accepted: their square, 1e30, times the density of a mirror's lobe, D / (4 cos) = 8e8 under
// this cosine, is more than a float holds; what is stored is within.
void brightest_light(void**) {
    constexpr int columns = 8, rows = 8;
    Patches patches(columns, rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) patches.add(x, y, normal_under(0.01, patches.to_eye(x, y)));
    Frame frame = software().frame(columns, rows);
    frame.render(patches.scene(software().ggx(1e-4f, {1, 1, 1}), environment(constant_map(1e15f))));
    row_of_finite_fields("mirror under 1e15 everywhere", frame);
}

// Nothing arrives: all weights of eq. 5 are zero, and nothing is to be resolved.
void black_light_and_black_materials(void**) {
    const std::vector<float> zeros(BrdfTable::cell_count * 3), unmeasured(BrdfTable::cell_count * 3, -1.0f);
    struct Case {
        const char* name;
        wrapper::Brdf brdf;
        RgbImage map;
    };
    const Case cases[] = {
        {"black map, GGX", subjects()[2].rendered, constant_map(0)},
        {"black map, table", subjects()[0].rendered, constant_map(0)},
        {"black Lambert", software().lambert({0, 0, 0}), half_range_map()},
        {"black table", software().table_brdf(zeros.data(), zeros.size()), half_range_map()},
        {"table without a measured cell", software().table_brdf(unmeasured.data(), unmeasured.size()), half_range_map()},
    };
    for (const Case& one : cases) {
        Frame frame = software().frame(48, 48);
        frame.render(scene_of("plane", one.brdf, environment(one.map)));
        double light = 0, bandwidth = 0;
        for (const double value : luminances(frame)) light = std::max(light, value);
        for (const float value : field<float>(frame, "bandwidth_angular")) bandwidth = std::max(bandwidth, double(value));
        row(one.name, "largest luminance", light, 0);
        row(one.name, "largest angular bandwidth", bandwidth, 0);
        row_of_finite_fields(one.name, frame);
    }
}

// ---- Materials ---------------------------------------------------------------------------------------

// Under light of 3 everywhere a table reflects 3 times its directional albedo; that is found by a quadrature over half
// vectors which resolves every cell.
void tables_of_any_shape(void**) {
    BrdfTable flat;
    flat.rgb.assign(BrdfTable::cell_count * 3, float(1 / pi));
    const BrdfTable chrome = tabulated(Ggx{2e-3, Vec3(0.55, 0.56, 0.55)});
    const std::pair<const char*, const BrdfTable*> tables[] = {{"flat table", &flat}, {"chrome-like table", &chrome}};
    for (const auto& [name, table] : tables) {
        Frame frame = sampled_frame(4, 4, 4096);
        frame.render(scene_of("plane", software().table_brdf(table->rgb.data(), table->rgb.size()),
                              environment(constant_map(3))));
        const std::vector<float> position = field<float>(frame, "position"), normal = field<float>(frame, "normal");
        const std::vector<float> variance = field<float>(frame, "variance_measured");
        const std::vector<double> found = luminances(frame);
        double largest = 0;
        for (size_t i = 0; i < found.size(); ++i) {
            const ShadingPoint at = shading_point(position, normal, i, usual_eye);
            const double theta = std::acos(glm::dot(at.wo, at.normal));
            const double expected = 3 * luminance(directional_albedo(*table, theta));
            const double error = std::sqrt(double(variance[i]) / 4096);
            // Cells are kept as half floats, rounded by 2^-12; the quadrature's 1440 x 360 half vectors see the edge of the
            // hemisphere to 1e-3 of the albedo beside it.
            largest = std::max(largest, (std::fabs(found[i] - expected) - (0x1p-12 + 1e-3) * expected) / error);
        }
        row(name, "largest deviation, standard errors", largest, 5);
        row_of_finite_fields(name, frame);
    }
}

// A mirror of alpha 1e-4 shows Fresnel's part of the map where wo is mirrored. Light leaves that direction by the mean of
// twice the microfacets' slope, 2 * pi / 2 * alpha = 3e-4 radians; the map's luminance is 2 + cos(latitude) * sin(longitude),
// whose slope is below 1 per radian, and bilinear lookup of texels 0.05 apart keeps within 0.05^2 / 8 = 3e-4 of it.
void mirrors(void**) {
    RgbImage map{128, 64, {}};
    for (uint32_t y = 0; y < map.height; ++y)
        for (uint32_t x = 0; x < map.width; ++x) {
            const Vec3 d = direction_of(Vec2((x + 0.5) / map.width, (y + 0.5) / map.height));
            map.rgb.insert(map.rgb.end(), 3, float(2 + d.x));
        }
    const double f0 = 0.75;
    for (const char* sampler : {"brdf", "combined"}) {
        Frame frame = software().frame(side, side);
        frame.set("coarsest_level", 0);
        frame.set("samples", 256);
        frame.set("sampler", sampler);
        frame.render(scene_of("sphere", software().ggx(1e-4f, {0.75f, 0.75f, 0.75f}), environment(map)));
        const std::vector<float> position = field<float>(frame, "position"), normal = field<float>(frame, "normal");
        const std::vector<float> variance = field<float>(frame, "variance_measured");
        const std::vector<uint32_t> samples = field<uint32_t>(frame, "sample_count");
        const std::vector<double> found = luminances(frame);
        double largest = 0;
        for (const size_t pixel : covered_pixels(frame)) {
            const ShadingPoint at = shading_point(position, normal, pixel, usual_eye);
            const double cosine = glm::dot(at.wo, at.normal);
            if (cosine < 0.1) continue;  // shadowing begins: alpha^2 tan^2 / 2 is below 1e-6 up to here
            const Vec3 mirrored = 2 * cosine * at.normal - at.wo;
            const double expected = (f0 + (1 - f0) * std::pow(1 - cosine, 5)) * (2 + mirrored.x);
            // Only combined samples vary by themselves.
            const double noise = 5 * std::sqrt(double(variance[pixel]) / samples[pixel]);
            largest = std::max(largest, std::fabs(found[pixel] - expected) - noise);
        }
        const std::string name = std::string("mirror of alpha 1e-4, samples ") + sampler;
        row(name, "deviation beyond noise, radiance", largest, 3.2e-4 + 3.1e-4);
        row_of_finite_fields(name, frame);
    }
}

// Noise of a map's finest texels, in a mirror, over pixels of 0.05 radians: its bandwidth at the eye is (1 + 2 * curvature *
// distance) = 6 times the map's 4 and more cycles per radian, over twice the 10 that pixels can show. Not one pixel of the
// sphere escapes, and every one is counted. Under a constant map nothing saturates.
void saturation_is_counted(void**) {
    const wrapper::Brdf mirror = software().ggx(1e-4f, {0.9f, 0.9f, 0.9f});
    for (const bool noisy : {true, false}) {
        Frame frame = software().frame(16, 16);
        frame.render(scene_of("sphere", mirror, environment(noisy ? half_range_map() : constant_map(1))));
        const double covered = double(frame.stats().covered_pixels), saturated = double(frame.stats().saturated_pixels);
        assert_true(covered > 100);
        if (noisy) {
            row("bandwidth saturates", "covered pixels that are not counted", covered - saturated, 0);
            row("bandwidth saturates", "covered pixels that are not shaded", covered - double(frame.stats().shaded_pixels), 0);
        } else {
            row("bandwidth of nothing", "covered pixels that are counted", saturated, 0);
        }
    }
}

// ---- Samples and frames ------------------------------------------------------------------------------

// Each sample is 0.7 * 3. Up to 4096 of them are added before the mean over parts is taken, and each sum rounds by 2^-24;
// each part's mean takes three more roundings.
void numbers_of_samples(void**) {
    const Scene scene = scene_of("plane", software().lambert({0.7f, 0.7f, 0.7f}), environment(constant_map(3)));
    for (const char* method : {"reference", "adaptive"})
        for (const double samples : {1.0, 2.0, 3.0, 4095.0, 4096.0, 4097.0, 0x1p20}) {
            Frame frame = exact_frame(2, 2, samples);
            frame.set("method", method);
            frame.render(scene);
            const double parts = std::ceil(samples / 4096);
            const std::string name = text(samples, " samples, ", method);
            row(name, "relative deviation", relative_deviation(frame, double(0.7f) * 3),
                (std::min(samples, 4096.0) + 3 * parts + 4) * 0x1p-24);
            row(name, "samples that are missing", std::fabs(4 * samples - double(frame.stats().samples)), 0);
        }
}

// One pixel, against a quadrature of a million cells.
void a_million_samples(void**) {
    const RgbImage map = patched_map(64, 32);
    for (Subject subject : subjects()) {
        Frame frame = sampled_frame(1, 1, 0x1p20);
        frame.set("max_samples", 0x1p20);
        frame.render(scene_of("plane", subject.rendered, environment(map)));
        subject.oracle_rows = 768;
        rows_against_oracle(std::string("2^20 samples, ") + subject.name, frame, subject, map, usual_eye);
    }
}

// The plane fills every frame, twice over: clipping against the picture's edges is done in floats, and a triangle that reaches
// 2^24 times beyond them is lost. Interpolation takes at most 5 levels of means of 4 whose weights, each rounded by 2^-24, sum to
// 1 within 8 of those; the sample itself takes 4 roundings.
void frames_of_any_size(void**) {
    Scene scene = scene_of("plane", software().lambert({0.7f, 0.7f, 0.7f}), environment(constant_map(3)));
    scene.set_camera({{0, 0, 1}});
    constexpr uint32_t sizes[][2] = {{1, 1}, {1, 4096}, {4096, 1}, {2, 8191}, {37, 41}, {127, 113}, {4096, 4096}};
    for (const auto& [width, height] : sizes) {
        const float size = 1.5f * float(std::max(1u, width / height));
        scene.set_transform(0, Transform{size, 0, 0, 0, 0, size, 0, 0, 0, 0, 1, 0});
        Frame frame = exact_frame(width, height, 1);
        frame.set("pilots", 4);  // all that a constant map needs
        frame.render(scene);
        const std::string name = text("frame of ", width, " x ", height);
        row(name, "pixels that see nothing", double(width) * height - double(frame.stats().covered_pixels), 0);
        row(name, "relative deviation", relative_deviation(frame, double(0.7f) * 3), (5 * 8 + 4) * 0x1p-24);
    }
}

// Every field is 0 where nothing is seen, depth alone is infinite.
void pixels_that_see_nothing(void**) {
    Scene scene = software().scene();
    scene.set_environment(environment(half_range_map()));
    scene.set_camera({{0, 0, 1}});
    Frame frame = software().frame(5, 3);
    frame.render(scene);
    int wrong = 0;
    for (const char* name : {"color", "position", "normal", "curvature", "bandwidth_spatial", "bandwidth_angular",
                             "bandwidth_image", "variance_predicted", "variance_measured"})
        for (const float value : field<float>(frame, name)) wrong += value != 0;
    for (const float value : field<float>(frame, "depth")) wrong += !(std::isinf(value) && value > 0);
    for (const char* name : {"material", "level", "shaded"})
        for (const uint8_t value : field<uint8_t>(frame, name)) wrong += value != 0;
    for (const uint32_t value : field<uint32_t>(frame, "sample_count")) wrong += value != 0;
    const lb_frame_stats stats = frame.stats();
    row("nothing is seen", "values that say otherwise", wrong, 0);
    row("nothing is seen", "pixels and samples counted",
        double(stats.covered_pixels + stats.shaded_pixels + stats.saturated_pixels + stats.bent_normals + stats.samples), 0);
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(view_cosines),
        cmocka_unit_test(view_cosines_about_zero),
        cmocka_unit_test(curvatures),
        cmocka_unit_test(curvature_of_a_plane),
        cmocka_unit_test(creases),
        cmocka_unit_test(nothing_but_creases),
        cmocka_unit_test(scenes_of_any_size),
        cmocka_unit_test(near_and_far_planes),
        cmocka_unit_test(maps_of_any_range),
        cmocka_unit_test(maps_of_denormals),
        cmocka_unit_test(brightest_light),
        cmocka_unit_test(black_light_and_black_materials),
        cmocka_unit_test(tables_of_any_shape),
        cmocka_unit_test(mirrors),
        cmocka_unit_test(saturation_is_counted),
        cmocka_unit_test(numbers_of_samples),
        cmocka_unit_test(a_million_samples),
        cmocka_unit_test(frames_of_any_size),
        cmocka_unit_test(pixels_that_see_nothing),
    };
    return cmocka_run_group_tests_name("extremes", tests, nullptr, nullptr);
}
