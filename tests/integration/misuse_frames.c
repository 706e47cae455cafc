/* Scenes, cameras, frames, settings, fields and files: asked too early, out of range, by names that are none. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

static const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/* ---- Camera ---- */

static lb_camera_desc sound_camera(void) {
    lb_camera_desc camera = LB_CAMERA_DESC_INIT;
    camera.eye[2] = 2.0f;
    return camera;
}

#define assert_camera_refused(camera, ...) \
    assert_refused(lb_scene_set_camera(world.scene, &(camera)), LB_ERROR_INVALID_ARGUMENT, __VA_ARGS__)

static void camera_looks_somewhere(void** state) {
    (void)state;
    lb_camera_desc camera = sound_camera();
    camera.target[2] = 2.0f; /* the eye itself */
    assert_camera_refused(camera, "target", "eye");
    camera = sound_camera();
    camera.up[2] = -3.0f; /* along the view */
    assert_camera_refused(camera, "up");
    camera = sound_camera();
    camera.eye[1] = 5.0f; /* from above, and the default up is +Y */
    camera.eye[2] = 0.0f;
    assert_camera_refused(camera, "up");
    const float wrong[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; ++i) {
        camera = sound_camera();
        camera.eye[0] = wrong[i];
        assert_camera_refused(camera, "eye");
        camera = sound_camera();
        camera.target[1] = wrong[i];
        assert_camera_refused(camera, "target");
        camera = sound_camera();
        camera.up[2] = wrong[i];
        assert_camera_refused(camera, "up");
    }
}

static void camera_field_of_view_has_a_range(void** state) {
    (void)state;
    const float wrong[] = {-0.7f, 3.1415927f /* the float above pi */, 7.0f, INFINITY, NAN};
    for (int i = 0; i < 5; ++i) {
        lb_camera_desc camera = sound_camera();
        camera.fov_y = wrong[i];
        assert_camera_refused(camera, "fov_y");
    }
}

static void camera_planes_are_in_order(void** state) {
    (void)state;
    lb_camera_desc camera = sound_camera();
    camera.near_plane = 1.0f;
    camera.far_plane = 1.0f;
    assert_camera_refused(camera, "far_plane");
    camera.far_plane = 0.5f;
    assert_camera_refused(camera, "far_plane");
    const float wrong[] = {-1.0f, INFINITY, NAN};
    for (int i = 0; i < 3; ++i) {
        camera = sound_camera();
        camera.near_plane = wrong[i];
        assert_camera_refused(camera, "near_plane");
        camera = sound_camera();
        camera.far_plane = wrong[i];
        assert_camera_refused(camera, "far_plane");
    }
}

/* ---- Scene ---- */

static void transform_must_be_finite_and_invertible(void** state) {
    (void)state;
    uint32_t index = 77;
    for (int element = 0; element < 12; ++element) {
        float transform[12];
        memcpy(transform, identity, sizeof(transform));
        transform[element] = NAN;
        assert_refused(lb_scene_add(world.scene, world.mesh, world.brdf, transform, &index), LB_ERROR_INVALID_ARGUMENT,
                       "transform");
        assert_refused(lb_scene_set_transform(world.scene, 0, transform), LB_ERROR_INVALID_ARGUMENT, "transform");
    }
    const float zero[12] = {0}, flat[12] = {1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0};
    assert_refused(lb_scene_add(world.scene, world.mesh, world.brdf, zero, &index), LB_ERROR_INVALID_ARGUMENT,
                   "transform");
    assert_refused(lb_scene_set_transform(world.scene, 0, flat), LB_ERROR_INVALID_ARGUMENT, "transform");
    assert_refused(lb_scene_set_transform(world.scene, 1, identity), LB_ERROR_INVALID_ARGUMENT, "index", "1");
    assert_refused(lb_scene_set_transform(world.scene, UINT32_MAX, identity), LB_ERROR_INVALID_ARGUMENT, "index");
    assert_int_equal(index, 77);
}

static void sides_are_those_of_an_instance(void** state) {
    (void)state;
    assert_refused(lb_scene_set_double_sided(world.scene, 1, 0), LB_ERROR_INVALID_ARGUMENT, "index", "1");
    assert_refused(lb_scene_set_double_sided(world.scene, UINT32_MAX, 0), LB_ERROR_INVALID_ARGUMENT, "index");
}

static void scene_holds_254_instances(void** state) {
    (void)state;
    lb_scene scene = NULL;
    uint32_t index = 0;
    assert_ok(lb_scene_create(world.context, &scene));
    for (uint32_t i = 0; i < 254; ++i) {
        assert_ok(lb_scene_add(scene, world.mesh, world.brdf, NULL, &index));
        assert_int_equal(index, i);
    }
    assert_refused(lb_scene_add(scene, world.mesh, world.brdf, NULL, &index), LB_ERROR_LIMIT, "254");
    assert_int_equal(index, 253);
    assert_ok(lb_scene_release(scene));
    assert_refused(lb_scene_create(world.context, NULL), LB_ERROR_INVALID_ARGUMENT, "scene");
}

static void unfinished_scene_is_not_rendered(void** state) {
    (void)state;
    lb_scene scene = NULL;
    lb_frame frame = NULL;
    const lb_camera_desc camera = sound_camera();
    assert_ok(lb_scene_create(world.context, &scene));
    assert_ok(lb_frame_create(world.context, 8, 8, &frame));
    assert_ok(lb_scene_set_camera(scene, &camera));
    assert_ok(lb_frame_render(frame, scene, NULL, NULL)); /* without any light */
    assert_finite_field(frame, "color");
    assert_ok(lb_scene_release(scene));

    assert_ok(lb_scene_create(world.context, &scene));
    assert_ok(lb_scene_set_environment(scene, world.environment));
    assert_refused(lb_frame_render(frame, scene, NULL, NULL), LB_ERROR_INVALID_STATE, "camera");
    assert_ok(lb_scene_set_camera(scene, &camera));
    assert_ok(lb_frame_render(frame, scene, NULL, NULL)); /* without any mesh */
    assert_finite_field(frame, "color");
    lb_frame_stats stats = LB_FRAME_STATS_INIT;
    assert_ok(lb_frame_info(frame, &stats));
    assert_int_equal(stats.covered_pixels, 0);
    assert_ok(lb_scene_release(scene));
    assert_ok(lb_frame_release(frame));
}

/* Shapes and views at the edge of what floats can tell apart: whatever is seen, nothing is NaN. */
static void extreme_scenes_have_no_nan(void** state) {
    (void)state;
    const float scales[] = {1e-6f, 1e-3f, 1e3f, 1e6f};
    struct world mine;
    make_objects(&mine);
    for (int i = 0; i < 4; ++i) {
        const float s = scales[i];
        const float transform[12] = {s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0};
        lb_camera_desc camera = sound_camera();
        camera.eye[2] = 2.0f * s;
        assert_ok(lb_scene_set_transform(mine.scene, 0, transform));
        assert_ok(lb_scene_set_camera(mine.scene, &camera));
        assert_ok(lb_frame_render(mine.frame, mine.scene, NULL, NULL));
        assert_finite_field(mine.frame, "color");
        assert_finite_field(mine.frame, "curvature");
        assert_finite_field(mine.frame, "bandwidth_image");
    }
    const float mirrored[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                thin[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1e-4f, 0};
    const float* transforms[] = {mirrored, thin};
    lb_camera_desc inside = sound_camera();
    inside.eye[2] = 0.1f;
    assert_ok(lb_scene_set_camera(mine.scene, &inside));
    for (int i = 0; i < 2; ++i) {
        assert_ok(lb_scene_set_transform(mine.scene, 0, transforms[i]));
        assert_ok(lb_frame_render(mine.frame, mine.scene, NULL, NULL));
        assert_finite_field(mine.frame, "color");
        assert_finite_field(mine.frame, "bandwidth_image");
    }
    release_objects(&mine);
}

/* ---- Frame ---- */

static void frame_size_has_limits(void** state) {
    (void)state;
    lb_frame frame = NULL;
    assert_refused(lb_frame_create(world.context, 8, 8, NULL), LB_ERROR_INVALID_ARGUMENT, "frame");
    assert_refused(lb_frame_create(world.context, 0, 8, &frame), LB_ERROR_INVALID_ARGUMENT, "width");
    assert_refused(lb_frame_create(world.context, 8, 0, &frame), LB_ERROR_INVALID_ARGUMENT, "height");
    assert_refused(lb_frame_create(world.context, 8193, 8, &frame), LB_ERROR_INVALID_ARGUMENT, "width", "8192");
    assert_refused(lb_frame_create(world.context, 8, UINT32_MAX, &frame), LB_ERROR_INVALID_ARGUMENT, "height", "8192");
    assert_null(frame);
}

static void small_and_odd_frames_render(void** state) {
    (void)state;
    const uint32_t sizes[][2] = {{1, 1}, {1, 9}, {9, 1}, {2, 3}, {17, 5}};
    for (int i = 0; i < 5; ++i) {
        lb_frame frame = render_frame(&world, sizes[i][0], sizes[i][1]);
        assert_finite_field(frame, "color");
        assert_finite_field(frame, "bandwidth_image");
        assert_ok(lb_frame_release(frame));
    }
}

static void nothing_is_told_before_the_first_picture(void** state) {
    (void)state;
    lb_frame frame = NULL;
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    lb_frame_stats stats = LB_FRAME_STATS_INIT;
    size_t needed = 77;
    assert_ok(lb_frame_create(world.context, 8, 8, &frame));
    assert_refused(lb_frame_info(frame, &stats), LB_ERROR_INVALID_STATE, "render");
    assert_refused(lb_frame_explain(frame, NULL, 0, &needed), LB_ERROR_INVALID_STATE, "render");
    assert_refused(lb_frame_map(frame, "color", &buffer, &view), LB_ERROR_INVALID_STATE, "render");
    assert_refused(lb_frame_save(frame, "never_written.exr", NULL), LB_ERROR_INVALID_STATE, "render");
    assert_int_equal(needed, 77);
    assert_null(buffer);
    assert_ok(lb_frame_release(frame));
}

static void plan_is_known_before_the_first_picture(void** state) {
    (void)state;
    lb_frame frame = NULL;
    char text[8192];
    size_t needed = 0;
    assert_ok(lb_frame_create(world.context, 8, 8, &frame));
    assert_ok(lb_frame_plan(frame, world.scene, text, sizeof text, &needed));
    assert_int_equal(needed, strlen(text) + 1);
    assert_non_null(strstr(text, "upsample"));
    assert_ok(lb_frame_set_number(frame, "coarsest_level", 0));
    assert_ok(lb_frame_plan(frame, world.scene, text, sizeof text, &needed));
    assert_null(strstr(text, "upsample"));
    assert_refused(lb_frame_plan(frame, NULL, text, sizeof text, &needed), LB_ERROR_INVALID_HANDLE, "scene");
    assert_ok(lb_frame_release(frame));
}

static void plan_is_written_as_far_as_it_fits(void** state) {
    (void)state;
    size_t needed = 0;
    assert_ok(lb_frame_explain(world.frame, NULL, 0, &needed));
    assert_true(needed > 1);
    char* text = malloc(needed + 1);
    assert_non_null(text);
    memset(text, '#', needed + 1);
    assert_ok(lb_frame_explain(world.frame, text, needed, NULL));
    assert_int_equal(strlen(text), needed - 1);
    assert_int_equal(text[needed], '#');

    char first[4] = {'#', '#', '#', '#'};
    assert_ok(lb_frame_explain(world.frame, first, 3, &needed));
    assert_memory_equal(first, text, 2);
    assert_int_equal(first[2], 0);
    assert_int_equal(first[3], '#');
    assert_refused(lb_frame_explain(world.frame, NULL, 3, &needed), LB_ERROR_INVALID_ARGUMENT, "text");
    free(text);
}

/* ---- Settings ---- */

static lb_setting_info setting_at(uint32_t index) {
    lb_setting_info info = LB_SETTING_INFO_INIT;
    assert_ok(lb_setting_at(index, &info));
    return info;
}

static void settings_describe_themselves(void** state) {
    (void)state;
    assert_true(lb_setting_count() > 0);
    for (uint32_t i = 0; i < lb_setting_count(); ++i) {
        const lb_setting_info info = setting_at(i);
        assert_true(strlen(info.name) > 0);
        assert_true(strlen(info.documentation) > 0);
        if (info.type == LB_SETTING_CHOICE) {
            assert_non_null(strstr(info.choices, info.default_choice));
        } else {
            assert_true(info.minimum <= info.default_number && info.default_number <= info.maximum);
        }
    }
    lb_setting_info info = LB_SETTING_INFO_INIT;
    assert_refused(lb_setting_at(lb_setting_count(), &info), LB_ERROR_INVALID_ARGUMENT, "index");
    assert_refused(lb_setting_at(UINT32_MAX, &info), LB_ERROR_INVALID_ARGUMENT, "index");
}

static void expect_number_kept(lb_frame frame, const lb_setting_info* info) {
    double value = NAN;
    assert_ok(lb_frame_get_number(frame, info->name, &value));
    assert_true(value == info->default_number);
}

static void expect_number_refused(lb_frame frame, const lb_setting_info* info, double value) {
    const lb_result result = lb_frame_set_number(frame, info->name, value);
    if (result != LB_ERROR_INVALID_ARGUMENT || strstr(lb_error_message(), info->name) == NULL) {
        fail_msg("%s = %g: %s, %s", info->name, value, lb_result_name(result), lb_error_message());
    }
    expect_number_kept(frame, info);
}

static void number_must_be_in_range(void** state) {
    (void)state;
    lb_frame frame = NULL;
    assert_ok(lb_frame_create(world.context, 8, 8, &frame));
    for (uint32_t i = 0; i < lb_setting_count(); ++i) {
        const lb_setting_info info = setting_at(i);
        if (info.type == LB_SETTING_CHOICE) {
            continue;
        }
        expect_number_kept(frame, &info);
        const double span = fmax(fabs(info.minimum), fabs(info.maximum));
        const double wrong[] = {info.minimum - fmax(1, span),
                                nextafter(info.minimum, -INFINITY),
                                nextafter(info.maximum, INFINITY),
                                INFINITY,
                                -INFINITY,
                                NAN};
        for (int value = 0; value < 6; ++value) {
            expect_number_refused(frame, &info, wrong[value]);
        }
        if (info.type == LB_SETTING_INTEGER && info.maximum > info.minimum) {
            expect_number_refused(frame, &info, info.minimum + 0.5);
        }
        assert_ok(lb_frame_set_number(frame, info.name, info.minimum));
        assert_ok(lb_frame_set_number(frame, info.name, info.maximum));
    }
    assert_ok(lb_frame_release(frame));
}

static void setting_has_one_type(void** state) {
    (void)state;
    const char* choice = NULL;
    double number = 0;
    for (uint32_t i = 0; i < lb_setting_count(); ++i) {
        const lb_setting_info info = setting_at(i);
        if (info.type == LB_SETTING_CHOICE) {
            assert_refused(lb_frame_set_number(world.frame, info.name, 0), LB_ERROR_INVALID_ARGUMENT, info.name);
            assert_refused(lb_frame_get_number(world.frame, info.name, &number), LB_ERROR_INVALID_ARGUMENT, info.name);
            assert_refused(lb_frame_set_choice(world.frame, info.name, "purple"), LB_ERROR_INVALID_ARGUMENT, info.name,
                           "purple", info.default_choice);
            assert_refused(lb_frame_set_choice(world.frame, info.name, ""), LB_ERROR_INVALID_ARGUMENT, info.name);
            assert_refused(lb_frame_set_choice(world.frame, info.name, info.choices), LB_ERROR_INVALID_ARGUMENT,
                           info.name);
            assert_refused(lb_frame_set_choice(world.frame, info.name, NULL), LB_ERROR_INVALID_ARGUMENT, "value");
            assert_ok(lb_frame_get_choice(world.frame, info.name, &choice));
            assert_string_equal(choice, info.default_choice);
        } else {
            assert_refused(lb_frame_set_choice(world.frame, info.name, "1"), LB_ERROR_INVALID_ARGUMENT, info.name);
            assert_refused(lb_frame_get_choice(world.frame, info.name, &choice), LB_ERROR_INVALID_ARGUMENT, info.name);
        }
    }
}

static void setting_must_be_known(void** state) {
    (void)state;
    const char* choice = NULL;
    double number = 77;
    const char* unknown[] = {"", "no such setting", "%s%n"};
    for (int i = 0; i < 3; ++i) {
        assert_refused(lb_frame_set_number(world.frame, unknown[i], 1), LB_ERROR_INVALID_ARGUMENT, unknown[i]);
        assert_refused(lb_frame_get_number(world.frame, unknown[i], &number), LB_ERROR_INVALID_ARGUMENT, unknown[i]);
        assert_refused(lb_frame_set_choice(world.frame, unknown[i], "x"), LB_ERROR_INVALID_ARGUMENT, unknown[i]);
        assert_refused(lb_frame_get_choice(world.frame, unknown[i], &choice), LB_ERROR_INVALID_ARGUMENT, unknown[i]);
    }
    assert_refused(lb_frame_set_number(world.frame, NULL, 1), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_frame_get_number(world.frame, NULL, &number), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_frame_set_choice(world.frame, NULL, "x"), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_frame_get_choice(world.frame, NULL, &choice), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_frame_get_choice(world.frame, "method", NULL), LB_ERROR_INVALID_ARGUMENT, "value");
    assert_refused(lb_frame_get_number(world.frame, "accumulate", NULL), LB_ERROR_INVALID_ARGUMENT, "value");
    assert_true(number == 77);
    assert_null(choice);
}

/* ---- Progress ---- */

static int32_t stop_after_three(void* calls, double fraction) {
    assert_true(fraction >= 0 && fraction <= 1);
    return ++*(int*)calls >= 3;
}

static int32_t stop_at_once(void* calls, double fraction) {
    (void)fraction;
    ++*(int*)calls;
    return 1;
}

/* A cancelled frame holds the former picture; the next call renders as ever. */
static void cancelled_frame_keeps_its_picture(void** state) {
    (void)state;
    struct world mine;
    int calls = 0;
    float before[PICTURE_FLOATS];
    make_objects(&mine);
    render_picture(&mine, before);

    lb_environment night = make_flat_environment(mine.context, 0.01f);
    assert_ok(lb_scene_set_environment(mine.scene, night));
    assert_int_equal(lb_frame_render(mine.frame, mine.scene, stop_at_once, &calls), LB_ERROR_CANCELLED);
    assert_int_equal(calls, 1);
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    assert_ok(lb_frame_map(mine.frame, "color", &buffer, &view));
    assert_memory_equal(view.data, before, sizeof(before));
    assert_ok(lb_buffer_release(buffer));
    calls = 0;
    lb_frame_render(mine.frame, mine.scene, stop_after_three, &calls);
    assert_in_range(calls, 1, 3);
    assert_ok(lb_environment_release(night));
    release_objects(&mine);
}

/* ---- Fields and files ---- */

static void field_must_be_known(void** state) {
    (void)state;
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    assert_refused(lb_frame_map(world.frame, "colour", &buffer, &view), LB_ERROR_INVALID_ARGUMENT, "colour", "color");
    assert_refused(lb_frame_map(world.frame, "", &buffer, &view), LB_ERROR_INVALID_ARGUMENT, "field");
    assert_refused(lb_frame_map(world.frame, NULL, &buffer, &view), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_frame_map(world.frame, "color", NULL, &view), LB_ERROR_INVALID_ARGUMENT, "buffer");
    assert_refused(lb_environment_map(world.environment, "color", &buffer, &view), LB_ERROR_INVALID_ARGUMENT, "color",
                   "radiance");
    assert_refused(lb_environment_map(world.environment, NULL, &buffer, &view), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_environment_map(world.environment, "radiance", NULL, &view), LB_ERROR_INVALID_ARGUMENT, "buffer");
    assert_refused(lb_brdf_map(world.brdf, "color", &buffer, &view), LB_ERROR_INVALID_ARGUMENT, "color", "bandwidth");
    assert_refused(lb_brdf_map(world.brdf, NULL, &buffer, &view), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_brdf_map(world.brdf, "bandwidth", NULL, &view), LB_ERROR_INVALID_ARGUMENT, "buffer");
    assert_refused(lb_brdf_map(world.brdf, "table", &buffer, &view), LB_ERROR_INVALID_STATE, "table");
    assert_null(buffer);
    assert_null(view.data);
    assert_null(lb_frame_buffer_name(lb_frame_buffer_count()));
    assert_null(lb_frame_buffer_name(UINT32_MAX));
}

static void every_field_can_be_mapped(void** state) {
    (void)state;
    assert_int_equal(lb_frame_buffer_count(), 17); /* those that lightband.h lists */
    for (uint32_t i = 0; i < lb_frame_buffer_count(); ++i) {
        lb_buffer buffer = NULL;
        lb_buffer_view view = LB_BUFFER_VIEW_INIT;
        assert_ok(lb_frame_map(world.frame, lb_frame_buffer_name(i), &buffer, &view));
        assert_true(view.shape[0] >= PICTURE_SIZE && view.shape[1] == PICTURE_SIZE);
        assert_non_null(view.data);
        assert_non_null(view.unit); /* "" of a count */
        assert_ok(lb_buffer_release(buffer));
    }
}

static void reference_predicts_nothing(void** state) {
    (void)state;
    const char* absent[] = {"curvature", "bandwidth_spatial", "bandwidth_angular",  "bandwidth_image",
                            "level",     "level_pyramid",     "variance_predicted", "variance_pyramid"};
    lb_frame frame = NULL;
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    assert_ok(lb_frame_create(world.context, 8, 8, &frame));
    assert_ok(lb_frame_set_choice(frame, "method", "reference"));
    assert_ok(lb_frame_render(frame, world.scene, NULL, NULL));
    assert_finite_field(frame, "color");
    for (int i = 0; i < 8; ++i) {
        assert_refused(lb_frame_map(frame, absent[i], &buffer, &view), LB_ERROR_INVALID_STATE, absent[i], "reference");
        lb_save_desc saving = LB_SAVE_DESC_INIT;
        saving.names = absent[i];
        assert_refused(lb_frame_save(frame, "never_written.exr", &saving), LB_ERROR_INVALID_STATE, absent[i]);
    }
    assert_null(buffer);
    assert_ok(lb_frame_release(frame));
}

static int exists(const char* path) {
    FILE* file = fopen(path, "rb");
    if (file == NULL) {
        return 0;
    }
    fclose(file);
    return 1;
}

static void file_must_be_writable_and_of_a_known_kind(void** state) {
    (void)state;
    const lb_frame frame = world.frame;
    const char* path = "never_written.exr";
    assert_refused(lb_frame_save(frame, NULL, NULL), LB_ERROR_INVALID_ARGUMENT, "path");
    assert_refused(lb_frame_save(frame, "", NULL), LB_ERROR_INVALID_ARGUMENT, "path");
    assert_refused(lb_frame_save(frame, "picture.jpg", NULL), LB_ERROR_INVALID_ARGUMENT, "picture.jpg", ".exr", ".png");
    assert_refused(lb_frame_save(frame, "no/such/folder/a.exr", NULL), LB_ERROR_FILE, "no/such/folder");
    assert_refused(lb_frame_save(frame, "no/such/folder/a.png", NULL), LB_ERROR_FILE, "no/such/folder");

    const struct {
        const char* names;
        const char* word;
    } wrong_names[] = {{"colour", "colour"}, {"color,,depth", "field"}, {"", "names"}, {"color,color", "twice"}};
    lb_save_desc saving = LB_SAVE_DESC_INIT;
    for (int i = 0; i < 4; ++i) {
        saving.names = wrong_names[i].names;
        assert_refused(lb_frame_save(frame, path, &saving), LB_ERROR_INVALID_ARGUMENT, wrong_names[i].word);
    }
    saving.names = "depth";
    assert_refused(lb_frame_save(frame, "never_written.png", &saving), LB_ERROR_INVALID_ARGUMENT, "depth");
    saving.names = NULL;

    const float wrong[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; ++i) {
        saving.exposure = wrong[i];
        assert_refused(lb_frame_save(frame, "never_written.png", &saving), LB_ERROR_INVALID_ARGUMENT, "exposure");
    }
    saving.exposure = 0;
    saving.tone_curve = 2;
    assert_refused(lb_frame_save(frame, "never_written.png", &saving), LB_ERROR_INVALID_ARGUMENT, "tone_curve");
    saving.tone_curve = LB_TONE_FILMIC;
    saving.alpha = 2;
    assert_refused(lb_frame_save(frame, "never_written.png", &saving), LB_ERROR_INVALID_ARGUMENT, "alpha");
    saving.alpha = LB_ALPHA_OPAQUE;
    saving.struct_size = 8;
    assert_refused(lb_frame_save(frame, "never_written.png", &saving), LB_ERROR_INVALID_ARGUMENT, "struct_size");
    assert_false(exists(path));
    assert_false(exists("never_written.png"));
}

static void every_field_can_be_saved(void** state) {
    (void)state;
    char names[512] = "";
    for (uint32_t i = 0; i < lb_frame_buffer_count(); ++i) {
        if (strstr(lb_frame_buffer_name(i), "pyramid") == NULL) { /* of another size than the picture */
            strcat(names, names[0] == 0 ? "" : ",");
            strcat(names, lb_frame_buffer_name(i));
        }
    }
    lb_save_desc saving = LB_SAVE_DESC_INIT;
    saving.names = names;
    assert_ok(lb_frame_save(world.frame, "fields.exr", &saving));
    assert_true(exists("fields.exr"));
    remove("fields.exr");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(camera_looks_somewhere, world_renders_as_before),
        cmocka_unit_test_teardown(camera_field_of_view_has_a_range, world_renders_as_before),
        cmocka_unit_test_teardown(camera_planes_are_in_order, world_renders_as_before),
        cmocka_unit_test_teardown(transform_must_be_finite_and_invertible, world_renders_as_before),
        cmocka_unit_test_teardown(sides_are_those_of_an_instance, world_renders_as_before),
        cmocka_unit_test_teardown(scene_holds_254_instances, world_renders_as_before),
        cmocka_unit_test_teardown(unfinished_scene_is_not_rendered, world_renders_as_before),
        cmocka_unit_test_teardown(extreme_scenes_have_no_nan, world_renders_as_before),
        cmocka_unit_test_teardown(frame_size_has_limits, world_renders_as_before),
        cmocka_unit_test_teardown(small_and_odd_frames_render, world_renders_as_before),
        cmocka_unit_test_teardown(nothing_is_told_before_the_first_picture, world_renders_as_before),
        cmocka_unit_test_teardown(plan_is_known_before_the_first_picture, world_renders_as_before),
        cmocka_unit_test_teardown(plan_is_written_as_far_as_it_fits, world_renders_as_before),
        cmocka_unit_test_teardown(settings_describe_themselves, world_renders_as_before),
        cmocka_unit_test_teardown(number_must_be_in_range, world_renders_as_before),
        cmocka_unit_test_teardown(setting_has_one_type, world_renders_as_before),
        cmocka_unit_test_teardown(setting_must_be_known, world_renders_as_before),
        cmocka_unit_test_teardown(cancelled_frame_keeps_its_picture, world_renders_as_before),
        cmocka_unit_test_teardown(field_must_be_known, world_renders_as_before),
        cmocka_unit_test_teardown(every_field_can_be_mapped, world_renders_as_before),
        cmocka_unit_test_teardown(reference_predicts_nothing, world_renders_as_before),
        cmocka_unit_test_teardown(file_must_be_writable_and_of_a_known_kind, world_renders_as_before),
        cmocka_unit_test_teardown(every_field_can_be_saved, world_renders_as_before),
    };
    return cmocka_run_group_tests_name("misuse of scenes and frames", tests, make_world, release_world);
}
