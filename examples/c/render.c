/* Renders a metal knot under a light map, prints what was saved by prediction, writes knot.exr and knot.png.
 *
 *     ./render courtyard.exr [software]
 */
#include <lightband/lightband.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Every call returns a result; the text says what went wrong, and where. */
static void check(lb_result result, const char* what) {
    if (result != LB_OK) {
        fprintf(stderr, "%s: %s: %s\n", what, lb_result_name(result), lb_error_message());
        exit(EXIT_FAILURE);
    }
}

/* Mean of the light samples that the shaded pixels drew. */
static double mean_sample_count(lb_frame frame) {
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    check(lb_frame_map(frame, "sample_count", &buffer, &view), "sample_count");
    double sum = 0, shaded = 0;
    for (uint64_t y = 0; y < view.shape[0]; ++y) {
        for (uint64_t x = 0; x < view.shape[1]; ++x) {
            const char* pixel = (const char*)view.data + (int64_t)y * view.strides[0] + (int64_t)x * view.strides[1];
            const uint32_t count = *(const uint32_t*)pixel;
            sum += count;
            shaded += count > 0;
        }
    }
    check(lb_buffer_release(buffer), "release sample_count");
    return shaded > 0 ? sum / shaded : 0;
}

int main(int argc, char** argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: %s MAP.exr [software]\n", argv[0]);
        return EXIT_FAILURE;
    }

    lb_context_desc device = LB_CONTEXT_DESC_INIT;
    device.device = argc > 2 && strcmp(argv[2], "software") == 0 ? LB_DEVICE_SOFTWARE : LB_DEVICE_ANY;
    lb_context context = NULL;
    const char* device_name = NULL;
    check(lb_context_create(&device, &context), "context");
    check(lb_context_device_name(context, &device_name), "device name");

    lb_environment environment = NULL;
    lb_brdf gold = NULL;
    lb_mesh knot = NULL;
    check(lb_environment_load(context, argv[1], &environment), "environment");
    check(lb_brdf_builtin(context, "rough-gold", &gold), "material");
    check(lb_mesh_builtin(context, "knot", 0, &knot), "mesh");

    lb_camera_desc camera = LB_CAMERA_DESC_INIT;
    camera.eye[0] = 0.6f;
    camera.eye[1] = 0.5f;
    camera.eye[2] = 1.6f; /* looking at the origin; up, field of view and planes are the defaults */
    lb_scene scene = NULL;
    check(lb_scene_create(context, &scene), "scene");
    check(lb_scene_set_environment(scene, environment), "environment of the scene");
    check(lb_scene_set_camera(scene, &camera), "camera");
    check(lb_scene_add(scene, knot, gold, NULL, NULL), "mesh of the scene");

    lb_frame frame = NULL;
    check(lb_frame_create(context, 256, 256, &frame), "frame");
    check(lb_frame_set_number(frame, "target_error", 0.02), "target_error");
    check(lb_frame_render(frame, scene, NULL, NULL), "render");

    lb_frame_stats stats = LB_FRAME_STATS_INIT;
    check(lb_frame_info(frame, &stats), "statistics");
    printf("%s\n", device_name);
    printf("error about %.1f %% in %u rounds, %.0f ms: %llu of %llu covered pixels shaded, %.1f light samples of each\n",
           100 * stats.error, stats.rounds, stats.milliseconds, (unsigned long long)stats.shaded_pixels,
           (unsigned long long)stats.covered_pixels, mean_sample_count(frame));

    lb_save_desc saving = LB_SAVE_DESC_INIT;
    saving.names = "color,depth,bandwidth_image,sample_count";
    check(lb_frame_save(frame, "knot.exr", &saving), "knot.exr");
    saving.names = NULL;
    saving.tone_curve = LB_TONE_FILMIC;
    check(lb_frame_save(frame, "knot.png", &saving), "knot.png");

    check(lb_frame_release(frame), "release frame");
    check(lb_scene_release(scene), "release scene");
    check(lb_mesh_release(knot), "release mesh");
    check(lb_brdf_release(gold), "release material");
    check(lb_environment_release(environment), "release environment");
    check(lb_context_release(context), "release context");
    return EXIT_SUCCESS;
}
