#include "support.h"

#include <math.h>
#include <string.h>

struct world world;
static float first_picture[PICTURE_FLOATS];

void check_ok(lb_result result, const char* call, const char* file, int line) {
    if (result != LB_OK) {
        print_error("%s\n  gave %s: %s\n", call, lb_result_name(result), lb_error_message());
        _fail(file, line);
    }
}

void check_refused(lb_result result, lb_result code, const char* const* words, const char* call, const char* file,
                   int line) {
    if (result != code) {
        print_error("%s\n  gave %s instead of %s; last message: %s\n", call, lb_result_name(result),
                    lb_result_name(code), lb_error_message());
        _fail(file, line);
    }
    for (; *words != NULL; ++words) {
        if (strstr(lb_error_message(), *words) == NULL) {
            print_error("%s\n  the message does not say \"%s\": %s\n", call, *words, lb_error_message());
            _fail(file, line);
        }
    }
}

lb_context make_software_context(void) {
    lb_context_desc desc = LB_CONTEXT_DESC_INIT;
    desc.device = LB_DEVICE_SOFTWARE;
    desc.cache_path = "";
    lb_context context = NULL;
    assert_ok(lb_context_create(&desc, &context));
    return context;
}

lb_environment make_flat_environment(lb_context context, float radiance) {
    const float rgb[2 * 1 * 3] = {radiance, radiance, radiance, radiance, radiance, radiance};
    lb_environment environment = NULL;
    assert_ok(lb_environment_create(context, 2, 1, rgb, &environment));
    return environment;
}

/* A map with a bright side, so that the picture depends on directions. */
static lb_environment make_environment(lb_context context) {
    enum { WIDTH = 16, HEIGHT = 8 };
    float rgb[HEIGHT][WIDTH][3];
    for (int y = 0; y < HEIGHT; ++y) {
        for (int x = 0; x < WIDTH; ++x) {
            rgb[y][x][0] = 0.1f + (float)x;
            rgb[y][x][1] = 1.0f;
            rgb[y][x][2] = 0.1f + (float)y;
        }
    }
    lb_environment environment = NULL;
    assert_ok(lb_environment_create(context, WIDTH, HEIGHT, &rgb[0][0][0], &environment));
    return environment;
}

void make_objects(struct world* objects) {
    const float f0[3] = {0.9f, 0.6f, 0.3f};
    lb_camera_desc camera = LB_CAMERA_DESC_INIT;
    camera.eye[2] = 2.0f;
    objects->context = make_software_context();
    objects->environment = make_environment(objects->context);
    assert_ok(lb_brdf_create_ggx(objects->context, 0.2f, f0, &objects->brdf));
    assert_ok(lb_mesh_builtin(objects->context, "sphere", 16, &objects->mesh));
    assert_ok(lb_scene_create(objects->context, &objects->scene));
    assert_ok(lb_scene_set_environment(objects->scene, objects->environment));
    assert_ok(lb_scene_set_camera(objects->scene, &camera));
    assert_ok(lb_scene_add(objects->scene, objects->mesh, objects->brdf, NULL, NULL));
    assert_ok(lb_frame_create(objects->context, PICTURE_SIZE, PICTURE_SIZE, &objects->frame));
}

void release_objects(struct world* objects) {
    assert_ok(lb_frame_release(objects->frame));
    assert_ok(lb_scene_release(objects->scene));
    assert_ok(lb_mesh_release(objects->mesh));
    assert_ok(lb_brdf_release(objects->brdf));
    assert_ok(lb_environment_release(objects->environment));
    assert_ok(lb_context_release(objects->context));
}

lb_frame render_frame(struct world* objects, uint32_t width, uint32_t height) {
    lb_frame frame = NULL;
    assert_ok(lb_frame_create(objects->context, width, height, &frame));
    assert_ok(lb_frame_render(frame, objects->scene, NULL, NULL));
    return frame;
}

void render_picture(struct world* objects, float picture[PICTURE_FLOATS]) {
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    assert_ok(lb_frame_render(objects->frame, objects->scene, NULL, NULL));
    assert_ok(lb_frame_map(objects->frame, "color", &buffer, &view));
    assert_int_equal(view.dimensions, 3);
    assert_int_equal(view.strides[2], sizeof(float));
    assert_int_equal(view.strides[1], 4 * sizeof(float));
    for (int y = 0; y < PICTURE_SIZE; ++y) {
        const char* row = (const char*)view.data + y * view.strides[0];
        memcpy(picture + (size_t)y * PICTURE_SIZE * 4, row, PICTURE_SIZE * 4 * sizeof(float));
    }
    assert_ok(lb_buffer_release(buffer));
}

int make_world(void** state) {
    (void)state;
    make_objects(&world);
    render_picture(&world, first_picture);
    return 0;
}

int release_world(void** state) {
    (void)state;
    release_objects(&world);
    return 0;
}

int world_renders_as_before(void** state) {
    (void)state;
    float picture[PICTURE_FLOATS];
    render_picture(&world, picture);
    assert_memory_equal(picture, first_picture, sizeof(picture));
    return 0;
}

void assert_finite_field(lb_frame frame, const char* name) {
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    assert_ok(lb_frame_map(frame, name, &buffer, &view));
    assert_int_equal(view.type, LB_TYPE_FLOAT32);
    const uint64_t depth = view.dimensions == 3 ? view.shape[2] : 1;
    for (uint64_t y = 0; y < view.shape[0]; ++y) {
        for (uint64_t x = 0; x < view.shape[1]; ++x) {
            for (uint64_t channel = 0; channel < depth; ++channel) {
                const char* element = (const char*)view.data + (int64_t)y * view.strides[0] +
                                      (int64_t)x * view.strides[1] + (int64_t)channel * view.strides[2];
                if (!isfinite(*(const float*)element)) {
                    print_error("%s, row %d, column %d, channel %d: not finite\n", name, (int)y, (int)x, (int)channel);
                    fail();
                }
            }
        }
    }
    assert_ok(lb_buffer_release(buffer));
}
