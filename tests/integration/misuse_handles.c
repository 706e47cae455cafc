/* Every public call that takes a handle, given none, a released one and one of each other kind. */
#include <stdlib.h>
#include <string.h>

#include "support.h"

enum kind { CONTEXT, BRDF, ENVIRONMENT, LIGHT, MESH, SCENE, FRAME, BUFFER, KINDS };

/* Where the calls below leave their results: on a failure it must stay as it was. */
static struct outputs {
    lb_brdf brdf;
    lb_environment environment;
    lb_light light;
    lb_mesh mesh;
    lb_scene scene;
    lb_frame frame;
    lb_buffer buffer;
    lb_buffer_view view;
    lb_mesh_stats mesh_stats;
    lb_frame_stats frame_stats;
    const char* text;
    double number;
    size_t needed;
    uint32_t index;
    float rgb[3];
} out;

static const float grey[3] = {0.5f, 0.5f, 0.5f};
static const float up[3] = {0, 0, 1};
static const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const uint32_t corners[3] = {0, 1, 2};
static const lb_mesh_desc mesh_desc = {sizeof(lb_mesh_desc), 3, triangle, NULL, NULL, corners, 1};
static const lb_sun_desc sun_desc = {sizeof(lb_sun_desc), {0, 1, 0}, 0, {1, 1, 1}};
static const lb_camera_desc camera = {sizeof(lb_camera_desc), {0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 0, 0, 0};

/* The calls, all arguments but the handle valid. */
#define CALL(name, arguments)                    \
    static lb_result with_##name(void* handle) { \
        return name arguments;                   \
    }

CALL(lb_context_retain, (handle))
CALL(lb_context_device_name, (handle, &out.text))
CALL(lb_context_is_software, (handle, &out.index))
CALL(lb_brdf_load, (handle, "never_read.binary", &out.brdf))
CALL(lb_brdf_load_as_measured, (handle, "never_read.binary", &out.brdf))
CALL(lb_brdf_builtin, (handle, lb_brdf_builtin_name(0), &out.brdf))
CALL(lb_brdf_create_table, (handle, grey, 3, &out.brdf))
CALL(lb_brdf_create_lambert, (handle, grey, &out.brdf))
CALL(lb_brdf_create_ggx, (handle, 0.5f, grey, &out.brdf))
CALL(lb_environment_load, (handle, LIGHTBAND_TEST_MAP, &out.environment))
CALL(lb_environment_create, (handle, 1, 1, grey, &out.environment))
CALL(lb_sun_create, (handle, &sun_desc, &out.light))
CALL(lb_mesh_create, (handle, &mesh_desc, &out.mesh))
CALL(lb_mesh_builtin, (handle, "plane", 8, &out.mesh))
CALL(lb_scene_create, (handle, &out.scene))
CALL(lb_frame_create, (handle, 8, 8, &out.frame))
CALL(lb_brdf_retain, (handle))
CALL(lb_brdf_evaluate, (handle, up, up, out.rgb))
CALL(lb_brdf_albedo, (handle, 0.5f, out.rgb))
CALL(lb_brdf_map, (handle, "bandwidth", &out.buffer, &out.view))
CALL(lb_environment_retain, (handle))
CALL(lb_environment_map, (handle, "radiance", &out.buffer, &out.view))
CALL(lb_light_retain, (handle))
CALL(lb_sun_set, (handle, &sun_desc))
CALL(lb_mesh_retain, (handle))
CALL(lb_mesh_info, (handle, &out.mesh_stats))
CALL(lb_scene_retain, (handle))
CALL(lb_scene_set_environment, (handle, world.environment))
CALL(lb_scene_add_light, (handle, NULL))
CALL(lb_scene_remove_light, (handle, NULL))
CALL(lb_scene_set_camera, (handle, &camera))
CALL(lb_scene_add, (handle, world.mesh, world.brdf, NULL, &out.index))
CALL(lb_scene_set_transform, (handle, 0, identity))
CALL(lb_scene_set_double_sided, (handle, 0, 1))
CALL(lb_frame_retain, (handle))
CALL(lb_frame_set_number, (handle, "accumulate", 1))
CALL(lb_frame_get_number, (handle, "accumulate", &out.number))
CALL(lb_frame_get_choice, (handle, "method", &out.text))
CALL(lb_frame_set_choice, (handle, "method", "reference"))
CALL(lb_frame_render, (handle, world.scene, NULL, NULL))
CALL(lb_frame_info, (handle, &out.frame_stats))
CALL(lb_frame_plan, (handle, world.scene, NULL, 0, &out.needed))
CALL(lb_frame_explain, (handle, NULL, 0, &out.needed))
CALL(lb_frame_map, (handle, "color", &out.buffer, &out.view))
CALL(lb_frame_save, (handle, "never_written.exr", NULL))
CALL(lb_buffer_retain, (handle))

/* Handles that are not the first argument. */
static lb_result light_of_a_scene(void* handle) {
    return lb_scene_add_light(world.scene, handle);
}
static lb_result light_taken_from_a_scene(void* handle) {
    return lb_scene_remove_light(world.scene, handle);
}
static lb_result environment_of_a_scene(void* handle) {
    return lb_scene_set_environment(world.scene, handle);
}
static lb_result mesh_of_an_instance(void* handle) {
    return lb_scene_add(world.scene, handle, world.brdf, NULL, &out.index);
}
static lb_result brdf_of_an_instance(void* handle) {
    return lb_scene_add(world.scene, world.mesh, handle, NULL, &out.index);
}
static lb_result scene_of_a_render(void* handle) {
    return lb_frame_render(world.frame, handle, NULL, NULL);
}

static const struct call {
    const char* name;
    enum kind kind; /* the kind of handle that it wants */
    lb_result (*with)(void* handle);
} calls[] = {
    {"lb_context_retain", CONTEXT, with_lb_context_retain},
    {"lb_context_device_name", CONTEXT, with_lb_context_device_name},
    {"lb_context_is_software", CONTEXT, with_lb_context_is_software},
    {"lb_brdf_load", CONTEXT, with_lb_brdf_load},
    {"lb_brdf_load_as_measured", CONTEXT, with_lb_brdf_load_as_measured},
    {"lb_brdf_builtin", CONTEXT, with_lb_brdf_builtin},
    {"lb_brdf_create_table", CONTEXT, with_lb_brdf_create_table},
    {"lb_brdf_create_lambert", CONTEXT, with_lb_brdf_create_lambert},
    {"lb_brdf_create_ggx", CONTEXT, with_lb_brdf_create_ggx},
    {"lb_environment_load", CONTEXT, with_lb_environment_load},
    {"lb_environment_create", CONTEXT, with_lb_environment_create},
    {"lb_sun_create", CONTEXT, with_lb_sun_create},
    {"lb_mesh_create", CONTEXT, with_lb_mesh_create},
    {"lb_mesh_builtin", CONTEXT, with_lb_mesh_builtin},
    {"lb_scene_create", CONTEXT, with_lb_scene_create},
    {"lb_frame_create", CONTEXT, with_lb_frame_create},
    {"lb_brdf_retain", BRDF, with_lb_brdf_retain},
    {"lb_brdf_evaluate", BRDF, with_lb_brdf_evaluate},
    {"lb_brdf_albedo", BRDF, with_lb_brdf_albedo},
    {"lb_brdf_map", BRDF, with_lb_brdf_map},
    {"lb_environment_retain", ENVIRONMENT, with_lb_environment_retain},
    {"lb_environment_map", ENVIRONMENT, with_lb_environment_map},
    {"lb_light_retain", LIGHT, with_lb_light_retain},
    {"lb_sun_set", LIGHT, with_lb_sun_set},
    {"lb_mesh_retain", MESH, with_lb_mesh_retain},
    {"lb_mesh_info", MESH, with_lb_mesh_info},
    {"lb_scene_retain", SCENE, with_lb_scene_retain},
    {"lb_scene_set_environment", SCENE, with_lb_scene_set_environment},
    {"lb_scene_add_light", SCENE, with_lb_scene_add_light},
    {"lb_scene_remove_light", SCENE, with_lb_scene_remove_light},
    {"lb_scene_set_camera", SCENE, with_lb_scene_set_camera},
    {"lb_scene_add", SCENE, with_lb_scene_add},
    {"lb_scene_set_transform", SCENE, with_lb_scene_set_transform},
    {"lb_scene_set_double_sided", SCENE, with_lb_scene_set_double_sided},
    {"lb_frame_retain", FRAME, with_lb_frame_retain},
    {"lb_frame_set_number", FRAME, with_lb_frame_set_number},
    {"lb_frame_get_number", FRAME, with_lb_frame_get_number},
    {"lb_frame_get_choice", FRAME, with_lb_frame_get_choice},
    {"lb_frame_set_choice", FRAME, with_lb_frame_set_choice},
    {"lb_frame_render", FRAME, with_lb_frame_render},
    {"lb_frame_info", FRAME, with_lb_frame_info},
    {"lb_frame_plan", FRAME, with_lb_frame_plan},
    {"lb_frame_explain", FRAME, with_lb_frame_explain},
    {"lb_frame_map", FRAME, with_lb_frame_map},
    {"lb_frame_save", FRAME, with_lb_frame_save},
    {"lb_buffer_retain", BUFFER, with_lb_buffer_retain},
    {"lb_scene_set_environment, environment", ENVIRONMENT, environment_of_a_scene},
    {"lb_scene_add_light, light", LIGHT, light_of_a_scene},
    {"lb_scene_remove_light, light", LIGHT, light_taken_from_a_scene},
    {"lb_scene_add, mesh", MESH, mesh_of_an_instance},
    {"lb_scene_add, brdf", BRDF, brdf_of_an_instance},
    {"lb_frame_render, scene", SCENE, scene_of_a_render},
};
enum { CALLS = sizeof(calls) / sizeof(calls[0]) };
static const char* const kind_names[KINDS] = {"context", "brdf",  "environment", "light",
                                              "mesh",    "scene", "frame",       "buffer"};

static lb_buffer make_buffer(void) {
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    assert_ok(lb_environment_map(world.environment, "radiance", &buffer, &view));
    return buffer;
}

/* A new object of the kind, to be released by release_kind. */
static void* make_kind(enum kind kind) {
    struct world made;
    lb_light light = NULL;
    memset(&made, 0, sizeof(made));
    switch (kind) {
        case CONTEXT:
            return make_software_context();
        case BRDF:
            assert_ok(lb_brdf_create_lambert(world.context, grey, &made.brdf));
            return made.brdf;
        case ENVIRONMENT:
            return make_flat_environment(world.context, 1.0f);
        case LIGHT:
            assert_ok(lb_sun_create(world.context, &sun_desc, &light));
            return light;
        case MESH:
            assert_ok(lb_mesh_create(world.context, &mesh_desc, &made.mesh));
            return made.mesh;
        case SCENE:
            assert_ok(lb_scene_create(world.context, &made.scene));
            return made.scene;
        case FRAME:
            return render_frame(&world, 8, 8);
        default:
            return make_buffer();
    }
}

static lb_result release_kind(enum kind kind, void* handle) {
    switch (kind) {
        case CONTEXT:
            return lb_context_release(handle);
        case BRDF:
            return lb_brdf_release(handle);
        case ENVIRONMENT:
            return lb_environment_release(handle);
        case LIGHT:
            return lb_light_release(handle);
        case MESH:
            return lb_mesh_release(handle);
        case SCENE:
            return lb_scene_release(handle);
        case FRAME:
            return lb_frame_release(handle);
        default:
            return lb_buffer_release(handle);
    }
}

/* The call is refused, says which kind it wanted, and leaves every output as it was. */
static void expect_invalid(const struct call* call, void* handle, const char* what) {
    struct outputs before;
    memset(&before, 0xA5, sizeof(before));
    before.view.struct_size = sizeof(lb_buffer_view);
    before.mesh_stats.struct_size = sizeof(lb_mesh_stats);
    before.frame_stats.struct_size = sizeof(lb_frame_stats);
    memcpy(&out, &before, sizeof(out));
    const lb_result result = call->with(handle);
    if (result != LB_ERROR_INVALID_HANDLE || strstr(lb_error_message(), kind_names[call->kind]) == NULL) {
        fail_msg("%s with %s: %s, %s", call->name, what, lb_result_name(result), lb_error_message());
    }
    if (memcmp(&out, &before, sizeof(out)) != 0) {
        fail_msg("%s with %s: an output was written", call->name, what);
    }
}

static void no_handle_is_refused(void** state) {
    (void)state;
    for (int i = 0; i < CALLS; ++i) {
        expect_invalid(&calls[i], NULL, "NULL");
    }
}

static void released_handle_is_refused(void** state) {
    (void)state;
    for (int kind = 0; kind < KINDS; ++kind) {
        void* released = make_kind(kind);
        assert_ok(release_kind(kind, released));
        for (int i = 0; i < CALLS; ++i) {
            if ((int)calls[i].kind == kind) {
                expect_invalid(&calls[i], released, "a released handle");
            }
        }
        assert_refused(release_kind(kind, released), LB_ERROR_INVALID_HANDLE, kind_names[kind]);
    }
}

static void handle_of_another_kind_is_refused(void** state) {
    (void)state;
    for (int kind = 0; kind < KINDS; ++kind) {
        void* handle = make_kind(kind);
        for (int i = 0; i < CALLS; ++i) {
            if ((int)calls[i].kind != kind) {
                expect_invalid(&calls[i], handle, kind_names[kind]);
            }
        }
        for (int other = 0; other < KINDS; ++other) {
            if (other != kind) {
                assert_refused(release_kind(other, handle), LB_ERROR_INVALID_HANDLE, kind_names[other]);
            }
        }
        assert_ok(release_kind(kind, handle));
    }
}

/* A released handle is not taken for an object made later, even where that got the same memory. */
static void released_handle_stays_released(void** state) {
    (void)state;
    enum { GENERATIONS = 200 };
    lb_brdf released[GENERATIONS];
    for (int i = 0; i < GENERATIONS; ++i) {
        released[i] = make_kind(BRDF);
        assert_ok(lb_brdf_release(released[i]));
    }
    lb_brdf alive = make_kind(BRDF);
    float rgb[3];
    for (int i = 0; i < GENERATIONS; ++i) {
        assert_refused(lb_brdf_evaluate(released[i], up, up, rgb), LB_ERROR_INVALID_HANDLE, "brdf");
    }
    assert_ok(lb_brdf_evaluate(alive, up, up, rgb));
    assert_ok(lb_brdf_release(alive));
}

static void releasing_null_does_nothing(void** state) {
    (void)state;
    for (int kind = 0; kind < KINDS; ++kind) {
        assert_ok(release_kind(kind, NULL));
    }
}

static void references_are_counted(void** state) {
    (void)state;
    float rgb[3];
    lb_brdf brdf = make_kind(BRDF);
    assert_ok(lb_brdf_retain(brdf));
    assert_ok(lb_brdf_release(brdf));
    assert_ok(lb_brdf_evaluate(brdf, up, up, rgb));
    assert_ok(lb_brdf_release(brdf));
    assert_refused(lb_brdf_release(brdf), LB_ERROR_INVALID_HANDLE, "brdf");
}

/* The user's references go first, the frame last: it and its scene keep what they need. */
static void children_keep_their_parents(void** state) {
    (void)state;
    struct world mine;
    float picture[PICTURE_FLOATS], again[PICTURE_FLOATS];
    make_objects(&mine);
    render_picture(&mine, picture);
    assert_ok(lb_context_release(mine.context));
    assert_ok(lb_mesh_release(mine.mesh));
    assert_ok(lb_brdf_release(mine.brdf));
    assert_ok(lb_environment_release(mine.environment));
    render_picture(&mine, again);
    assert_memory_equal(picture, again, sizeof(picture));
    assert_ok(lb_scene_release(mine.scene));

    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    assert_ok(lb_frame_map(mine.frame, "color", &buffer, &view));
    assert_ok(lb_frame_release(mine.frame));
    assert_memory_equal(view.data, picture, sizeof(picture));
    assert_ok(lb_buffer_release(buffer));
}

/* A field that was mapped stays as it is when its frame renders another picture. */
static void buffer_outlives_the_next_picture(void** state) {
    (void)state;
    struct world mine;
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    float picture[PICTURE_FLOATS], darker[PICTURE_FLOATS];
    make_objects(&mine);
    render_picture(&mine, picture);
    assert_ok(lb_frame_map(mine.frame, "color", &buffer, &view));

    lb_environment night = make_flat_environment(mine.context, 0.01f);
    assert_ok(lb_scene_set_environment(mine.scene, night));
    assert_ok(lb_environment_release(night));
    render_picture(&mine, darker);
    assert_memory_not_equal(darker, picture, sizeof(picture));
    assert_memory_equal(view.data, picture, sizeof(picture));
    assert_ok(lb_buffer_release(buffer));
    release_objects(&mine);
}

/* Objects of two contexts do not mix: each lives on its own device. */
static void objects_of_another_context_are_refused(void** state) {
    (void)state;
    struct world mine;
    make_objects(&mine);
    assert_refused(lb_scene_set_environment(world.scene, mine.environment), LB_ERROR_INVALID_ARGUMENT, "environment",
                   "context");
    assert_refused(lb_scene_add(world.scene, mine.mesh, world.brdf, NULL, NULL), LB_ERROR_INVALID_ARGUMENT, "mesh",
                   "context");
    assert_refused(lb_scene_add(world.scene, world.mesh, mine.brdf, NULL, NULL), LB_ERROR_INVALID_ARGUMENT, "brdf",
                   "context");
    assert_refused(lb_frame_render(world.frame, mine.scene, NULL, NULL), LB_ERROR_INVALID_ARGUMENT, "scene", "context");
    release_objects(&mine);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(no_handle_is_refused, world_renders_as_before),
        cmocka_unit_test_teardown(released_handle_is_refused, world_renders_as_before),
        cmocka_unit_test_teardown(handle_of_another_kind_is_refused, world_renders_as_before),
        cmocka_unit_test_teardown(released_handle_stays_released, world_renders_as_before),
        cmocka_unit_test_teardown(releasing_null_does_nothing, world_renders_as_before),
        cmocka_unit_test_teardown(references_are_counted, world_renders_as_before),
        cmocka_unit_test_teardown(children_keep_their_parents, world_renders_as_before),
        cmocka_unit_test_teardown(buffer_outlives_the_next_picture, world_renders_as_before),
        cmocka_unit_test_teardown(objects_of_another_context_are_refused, world_renders_as_before),
    };
    return cmocka_run_group_tests_name("misuse of handles", tests, make_world, release_world);
}
