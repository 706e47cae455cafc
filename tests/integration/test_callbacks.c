/* A callback must not call the library: every entry point, in every callback, fails with LB_ERROR_INVALID_STATE and
 * changes nothing. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/* ---- Every call
 * ------------------------------------------------------------------------------------------------------------------ */

/* What the calls are given: valid objects of the world, so that each would succeed elsewhere. */
static lb_buffer buffer;
static lb_light sun;
static lb_sun_desc sun_desc = LB_SUN_DESC_INIT;
static lb_context_desc software = LB_CONTEXT_DESC_INIT;

#define CALL(function, ...)                  \
    static lb_result call_##function(void) { \
        return function(__VA_ARGS__);        \
    }
static const float some_vector[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static float some_floats[3];
static uint32_t number;
static double real;
static const char* string;
static size_t size;
static void* made;
static lb_buffer_view view = LB_BUFFER_VIEW_INIT;
static lb_frame_stats frame_stats = LB_FRAME_STATS_INIT;
static lb_mesh_stats mesh_stats = LB_MESH_STATS_INIT;
static lb_setting_info setting = LB_SETTING_INFO_INIT;
static lb_camera_desc camera = LB_CAMERA_DESC_INIT;
static lb_mesh_desc triangle = LB_MESH_DESC_INIT;
static float* table;
enum { TABLE_FLOATS = 90 * 90 * 180 * 3 };

CALL(lb_context_create, &software, (lb_context*)&made)
CALL(lb_context_device_name, world.context, &string)
CALL(lb_context_is_software, world.context, &number)
CALL(lb_context_retain, world.context)
CALL(lb_context_release, world.context)
CALL(lb_brdf_retain, world.brdf)
CALL(lb_brdf_release, world.brdf)
CALL(lb_environment_retain, world.environment)
CALL(lb_environment_release, world.environment)
CALL(lb_mesh_retain, world.mesh)
CALL(lb_mesh_release, world.mesh)
CALL(lb_light_retain, sun)
CALL(lb_light_release, sun)
CALL(lb_scene_retain, world.scene)
CALL(lb_scene_release, world.scene)
CALL(lb_frame_retain, world.frame)
CALL(lb_frame_release, world.frame)
CALL(lb_buffer_retain, buffer)
CALL(lb_buffer_release, buffer)
CALL(lb_brdf_load, world.context, LIGHTBAND_TEST_MAP, (lb_brdf*)&made)
CALL(lb_brdf_load_as_measured, world.context, LIGHTBAND_TEST_MAP, (lb_brdf*)&made)
CALL(lb_brdf_builtin, world.context, "rough-gold", (lb_brdf*)&made)
CALL(lb_brdf_create_table, world.context, table, TABLE_FLOATS, (lb_brdf*)&made)
CALL(lb_brdf_create_lambert, world.context, some_vector, (lb_brdf*)&made)
CALL(lb_brdf_create_ggx, world.context, 0.5f, some_vector, (lb_brdf*)&made)
CALL(lb_brdf_evaluate, world.brdf, some_vector, some_vector, some_floats)
CALL(lb_brdf_albedo, world.brdf, 0.5f, some_floats)
CALL(lb_brdf_map, world.brdf, "bandwidth", (lb_buffer*)&made, &view)
CALL(lb_environment_load, world.context, LIGHTBAND_TEST_MAP, (lb_environment*)&made)
CALL(lb_environment_create, world.context, 1, 1, some_vector, (lb_environment*)&made)
CALL(lb_environment_map, world.environment, "radiance", (lb_buffer*)&made, &view)
CALL(lb_mesh_create, world.context, &triangle, (lb_mesh*)&made)
CALL(lb_mesh_builtin, world.context, "plane", 8, (lb_mesh*)&made)
CALL(lb_mesh_info, world.mesh, &mesh_stats)
CALL(lb_sun_create, world.context, &sun_desc, (lb_light*)&made)
CALL(lb_sun_set, sun, &sun_desc)
CALL(lb_scene_create, world.context, (lb_scene*)&made)
CALL(lb_scene_add_light, world.scene, sun)
CALL(lb_scene_remove_light, world.scene, sun)
CALL(lb_scene_set_environment, world.scene, world.environment)
CALL(lb_scene_set_camera, world.scene, &camera)
CALL(lb_scene_add, world.scene, world.mesh, world.brdf, NULL, NULL)
CALL(lb_scene_set_transform, world.scene, 0, some_vector)
CALL(lb_scene_set_double_sided, world.scene, 0, 0)
CALL(lb_frame_create, world.context, 8, 8, (lb_frame*)&made)
CALL(lb_frame_set_number, world.frame, "samples", 3)
CALL(lb_frame_set_choice, world.frame, "method", "reference")
CALL(lb_frame_get_number, world.frame, "samples", &real)
CALL(lb_frame_get_choice, world.frame, "method", &string)
CALL(lb_setting_at, 0, &setting)
CALL(lb_frame_render, world.frame, world.scene, NULL, NULL)
CALL(lb_frame_info, world.frame, &frame_stats)
CALL(lb_frame_plan, world.frame, world.scene, NULL, 0, &size)
CALL(lb_frame_explain, world.frame, NULL, 0, &size)
CALL(lb_frame_map, world.frame, "color", (lb_buffer*)&made, &view)
CALL(lb_frame_save, world.frame, "never-written.exr", NULL)
#undef CALL

#define ENTRY(function) \
    { #function, call_##function }
static const struct {
    const char* name;
    lb_result (*call)(void);
} calls[] = {
    ENTRY(lb_context_create),
    ENTRY(lb_context_device_name),
    ENTRY(lb_context_is_software),
    ENTRY(lb_context_retain),
    ENTRY(lb_context_release),
    ENTRY(lb_brdf_retain),
    ENTRY(lb_brdf_release),
    ENTRY(lb_environment_retain),
    ENTRY(lb_environment_release),
    ENTRY(lb_mesh_retain),
    ENTRY(lb_mesh_release),
    ENTRY(lb_light_retain),
    ENTRY(lb_light_release),
    ENTRY(lb_scene_retain),
    ENTRY(lb_scene_release),
    ENTRY(lb_frame_retain),
    ENTRY(lb_frame_release),
    ENTRY(lb_buffer_retain),
    ENTRY(lb_buffer_release),
    ENTRY(lb_brdf_load),
    ENTRY(lb_brdf_load_as_measured),
    ENTRY(lb_brdf_builtin),
    ENTRY(lb_brdf_create_table),
    ENTRY(lb_brdf_create_lambert),
    ENTRY(lb_brdf_create_ggx),
    ENTRY(lb_brdf_evaluate),
    ENTRY(lb_brdf_albedo),
    ENTRY(lb_brdf_map),
    ENTRY(lb_environment_load),
    ENTRY(lb_environment_create),
    ENTRY(lb_environment_map),
    ENTRY(lb_mesh_create),
    ENTRY(lb_mesh_builtin),
    ENTRY(lb_mesh_info),
    ENTRY(lb_sun_create),
    ENTRY(lb_sun_set),
    ENTRY(lb_scene_create),
    ENTRY(lb_scene_add_light),
    ENTRY(lb_scene_remove_light),
    ENTRY(lb_scene_set_environment),
    ENTRY(lb_scene_set_camera),
    ENTRY(lb_scene_add),
    ENTRY(lb_scene_set_transform),
    ENTRY(lb_scene_set_double_sided),
    ENTRY(lb_frame_create),
    ENTRY(lb_frame_set_number),
    ENTRY(lb_frame_set_choice),
    ENTRY(lb_frame_get_number),
    ENTRY(lb_frame_get_choice),
    ENTRY(lb_setting_at),
    ENTRY(lb_frame_render),
    ENTRY(lb_frame_info),
    ENTRY(lb_frame_plan),
    ENTRY(lb_frame_explain),
    ENTRY(lb_frame_map),
    ENTRY(lb_frame_save),
};
enum { CALLS = sizeof calls / sizeof *calls };

/* Those that return no lb_result: they tell of the library alone and work everywhere. */
static const char* const informing[] = {
    "lb_brdf_builtin_count", "lb_brdf_builtin_name", "lb_error_message", "lb_frame_buffer_count",
    "lb_frame_buffer_name",  "lb_result_name",       "lb_setting_count", "lb_version"};

static int is_known(const char* name) {
    for (size_t i = 0; i < CALLS; ++i)
        if (strcmp(name, calls[i].name) == 0) return 1;
    for (size_t i = 0; i < sizeof informing / sizeof *informing; ++i)
        if (strcmp(name, informing[i]) == 0) return 1;
    return 0;
}

static void every_entry_point_is_here(void** state) {
    (void)state;
    FILE* file = fopen(LIGHTBAND_TEST_SYMBOLS, "r");
    assert_non_null(file);
    char name[128];
    int count = 0;
    while (fscanf(file, "%127s", name) == 1) {
        ++count;
        if (!is_known(name)) fail_msg("%s is not tried in callbacks", name);
    }
    fclose(file);
    assert_int_equal(count, CALLS + sizeof informing / sizeof *informing);
}

/* ---- The callbacks
 * --------------------------------------------------------------------------------------------------------------- */

static int runs;          /* of callbacks */
static char failure[256]; /* of the first call that was not refused */

static void call_everything(void) {
    ++runs;
    for (size_t i = 0; i < CALLS && failure[0] == 0; ++i) {
        made = NULL;
        const lb_result result = calls[i].call();
        if (result != LB_ERROR_INVALID_STATE || strstr(lb_error_message(), "callback") == NULL || made != NULL)
            snprintf(failure, sizeof failure, "%s in a callback: %s, \"%s\"", calls[i].name, lb_result_name(result),
                     lb_error_message());
    }
    if (lb_version() == 0 || strcmp(lb_result_name(LB_OK), "LB_OK") != 0 || lb_setting_count() == 0 ||
        lb_brdf_builtin_count() == 0)
        snprintf(failure, sizeof failure, "the library tells nothing of itself in a callback");
}

static int32_t progress(void* user, double fraction) {
    (void)fraction;
    assert_ptr_equal(user, &world);
    call_everything();
    return 0;
}

static void hear(void* user, const char* message) {
    (void)message;
    assert_ptr_equal(user, &world);
    call_everything();
}

static int begin(void** state) {
    (void)state;
    runs = 0;
    failure[0] = 0;
    return 0;
}

static void assert_all_refused(void) {
    if (failure[0] != 0) fail_msg("%s", failure);
    assert_true(runs > 0);
}

static void from_the_progress_of_a_render(void** state) {
    (void)state;
    assert_ok(lb_frame_render(world.frame, world.scene, progress, &world));
    assert_all_refused();
}

/* The log of another context than the calls': that it is being made. */
static lb_context make_hearing_context(void) {
    lb_context_desc desc = software;
    lb_context context = NULL;
    desc.log = hear;
    desc.log_user = &world;
    assert_ok(lb_context_create(&desc, &context));
    return context;
}

static void from_the_log_of_a_context_being_made(void** state) {
    (void)state;
    assert_ok(lb_context_release(make_hearing_context()));
    assert_all_refused();
}

const char* write_ringing_map(void); /* ringing_map.cpp */

/* The ringing of a lossy map is told while the map is loaded. */
static void from_the_log_of_a_map_being_loaded(void** state) {
    (void)state;
    lb_context context = make_hearing_context();
    lb_environment environment = NULL;
    const char* const name = write_ringing_map();
    assert_non_null(name);
    runs = 0;
    assert_ok(lb_environment_load(context, name, &environment));
    assert_all_refused();
    assert_ok(lb_environment_release(environment));
    assert_ok(lb_context_release(context));
    remove(name);
}

/* A callback of one thread says nothing of another. */
static void* call_meanwhile(void* result) {
    float rgb[3];
    *(lb_result*)result = lb_brdf_albedo(world.brdf, 0.5f, rgb);
    return NULL;
}

static int32_t let_another_call(void* result, double fraction) {
    (void)fraction;
    pthread_t thread;
    if (pthread_create(&thread, NULL, call_meanwhile, result) == 0) pthread_join(thread, NULL);
    return 1;
}

static void another_thread_may_call_meanwhile(void** state) {
    (void)state;
    lb_result result = -1;
    assert_refused(lb_frame_render(world.frame, world.scene, let_another_call, &result), LB_ERROR_CANCELLED,
                   "cancelled");
    assert_int_equal(result, LB_OK);
}

/* ---- A callback that ends its thread
 * --------------------------------------------------------------------------------------------- */

static int32_t end_thread(void* user, double fraction) {
    (void)user;
    (void)fraction;
    pthread_exit(NULL);
}

static void hear_and_end_thread(void* user, const char* message) {
    (void)user;
    (void)message;
    pthread_exit(NULL);
}

static void* render_until_it_ends(void* unused) {
    (void)unused;
    lb_frame_render(world.frame, world.scene, end_thread, NULL);
    return &world; /* not reached */
}

static void* create_until_it_ends(void* unused) {
    (void)unused;
    lb_context_desc desc = software;
    lb_context context = NULL;
    desc.log = hear_and_end_thread;
    lb_context_create(&desc, &context);
    return &world; /* not reached */
}

/* The teardown renders: the lock of the context is free again. */
static void a_thread_may_end_in_a_callback(void** state) {
    (void)state;
    void* (*const workers[])(void*) = {render_until_it_ends, create_until_it_ends};
    for (int i = 0; i < 2; ++i) {
        pthread_t thread;
        void* result = &world;
        assert_int_equal(pthread_create(&thread, NULL, workers[i], NULL), 0);
        assert_int_equal(pthread_join(thread, &result), 0);
        assert_null(result);
    }
}

/* ---- Cancellation
 * ---------------------------------------------------------------------------------------------------------------- */

static int cleaned_up, called_again;

static void clean_up(void* unused) {
    (void)unused;
    cleaned_up = 1;
}

static void* cancel_itself_and_call(void* unused) {
    float rgb[3];
    pthread_cleanup_push(clean_up, NULL);
    pthread_cancel(pthread_self());
    called_again = lb_frame_render(world.frame, world.scene, NULL, NULL) == LB_OK &&
                   lb_brdf_albedo(world.brdf, 0.5f, rgb) == LB_OK;
    pthread_testcancel();
    pthread_cleanup_pop(0);
    return unused;
}

static void a_cancelled_thread_ends_after_the_call(void** state) {
    (void)state;
    pthread_t thread;
    void* result = NULL;
    assert_int_equal(pthread_create(&thread, NULL, cancel_itself_and_call, NULL), 0);
    assert_int_equal(pthread_join(thread, &result), 0);
    assert_ptr_equal(result, PTHREAD_CANCELED);
    assert_true(called_again && cleaned_up);
}

static int make_all(void** state) {
    make_world(state);
    software.device = LB_DEVICE_SOFTWARE;
    software.cache_path = "";
    camera.eye[2] = 3;
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint32_t indices[3] = {0, 1, 2};
    triangle.vertex_count = 3;
    triangle.triangle_count = 1;
    triangle.positions = corners;
    triangle.indices = indices;
    table = calloc(TABLE_FLOATS, sizeof *table);
    sun_desc.direction[1] = 1;
    if (lb_sun_create(world.context, &sun_desc, &sun) != LB_OK) return -1;
    return lb_frame_map(world.frame, "color", &buffer, &view);
}

static int release_all(void** state) {
    free(table);
    assert_ok(lb_buffer_release(buffer));
    assert_ok(lb_light_release(sun));
    return release_world(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_entry_point_is_here),
        cmocka_unit_test_setup_teardown(from_the_progress_of_a_render, begin, world_renders_as_before),
        cmocka_unit_test_setup_teardown(from_the_log_of_a_context_being_made, begin, world_renders_as_before),
        cmocka_unit_test_setup_teardown(from_the_log_of_a_map_being_loaded, begin, world_renders_as_before),
        cmocka_unit_test_setup_teardown(another_thread_may_call_meanwhile, begin, world_renders_as_before),
        cmocka_unit_test_setup_teardown(a_thread_may_end_in_a_callback, begin, world_renders_as_before),
        cmocka_unit_test_setup_teardown(a_cancelled_thread_ends_after_the_call, begin, world_renders_as_before),
    };
    return cmocka_run_group_tests(tests, make_all, release_all);
}
