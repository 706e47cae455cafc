// How much of a picture must be shaded as a metal grows rougher? Renders a sphere at four roughnesses under a light
// map, prints a line for each, writes metal-<roughness>.exr.
//
//     ./render courtyard.exr [software]
#include <cstdio>
#include <exception>
#include <lightband/lightband.hpp>
#include <string>

// Mean over the pixels that see the sphere, in cycles per pixel.
static double mean_bandwidth(const lightband::Frame& frame) {
    const lightband::Buffer bandwidth = frame.map("bandwidth_image");
    const lightband::Buffer material = frame.map("material");
    const float* value = bandwidth.data<float>();
    const uint8_t* seen = material.data<uint8_t>();
    const uint64_t pixels = bandwidth.view().shape[0] * bandwidth.view().shape[1];
    double sum = 0;
    uint64_t covered = 0;
    for (uint64_t pixel = 0; pixel < pixels; ++pixel) {
        if (seen[pixel] != 0) {
            sum += value[pixel];
            ++covered;
        }
    }
    return covered == 0 ? 0 : sum / static_cast<double>(covered);
}

static void render(const std::string& map, bool software) {
    lightband::ContextOptions options;
    options.device = software ? LB_DEVICE_SOFTWARE : LB_DEVICE_ANY;
    const lightband::Context context(options);
    std::printf("%s\n", context.device_name().c_str());

    const lightband::Environment environment = context.load_environment(map);
    const lightband::Mesh sphere = context.builtin_mesh("sphere");
    lightband::Frame frame = context.frame(256, 256);
    frame.set("time_budget", 200);  // milliseconds; the first frame also builds its programs

    for (const float roughness : {0.1f, 0.2f, 0.4f, 0.8f}) {
        lightband::Scene scene = context.scene();
        scene.set_environment(environment);
        scene.set_camera({{0, 0, 2}, {0, 0, 0}});
        scene.add(sphere, context.ggx(roughness * roughness, {0.95f, 0.79f, 0.53f}));
        frame.render(scene);

        const lb_frame_stats stats = frame.stats();
        const double shaded = static_cast<double>(stats.shaded_pixels) / static_cast<double>(stats.covered_pixels);
        std::printf("roughness %.1f: bandwidth %.3f cycles/pixel, %4.1f %% of the pixels shaded, error %.2f %% in %.0f ms\n",
                    roughness, mean_bandwidth(frame), 100 * shaded, 100 * stats.error, stats.milliseconds);
        frame.save("metal-" + std::to_string(roughness).substr(0, 3) + ".exr", "color,bandwidth_image");
    }
}

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: %s MAP.exr [software]\n", argv[0]);
        return 1;
    }
    try {
        render(argv[1], argc > 2 && std::string(argv[2]) == "software");
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "%s\n", failure.what());
        return 1;
    }
    return 0;
}
