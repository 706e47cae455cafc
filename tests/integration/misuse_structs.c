/* Descriptors whose struct_size is that of no version, of this one, or of one yet to come. */
#include <stdlib.h>
#include <string.h>

#include "support.h"

/* What a later version might add behind the fields that this one knows. */
enum { TAIL = 40 };

/* One struct of the interface and a call that takes it; everything else about the call is valid. */
struct versioned {
    const char* name;
    size_t size;
    const void* valid; /* an instance that the call accepts */
    lb_result (*with)(void* instance);
};

static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const uint32_t corners[3] = {0, 1, 2};

static const lb_context_desc context_desc = {sizeof(lb_context_desc), LB_DEVICE_SOFTWARE, NULL, NULL, ""};
static const lb_mesh_desc mesh_desc = {sizeof(lb_mesh_desc), 3, triangle, NULL, NULL, corners, 1};
static const lb_camera_desc camera_desc = {sizeof(lb_camera_desc), {0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 0, 0, 0};
static const lb_sun_desc sun_desc = {sizeof(lb_sun_desc), {0, 1, 0}, 0, {1, 1, 1}};
static const lb_mesh_stats mesh_stats = LB_MESH_STATS_INIT;
static const lb_setting_info setting_info = LB_SETTING_INFO_INIT;
static const lb_frame_stats frame_stats = LB_FRAME_STATS_INIT;
static const lb_buffer_view buffer_view = LB_BUFFER_VIEW_INIT;

static lb_result create_context(void* desc) {
    lb_context context = NULL;
    const lb_result result = lb_context_create(desc, &context);
    assert_ok(lb_context_release(context));
    return result;
}

static lb_result create_mesh(void* desc) {
    lb_mesh mesh = NULL;
    const lb_result result = lb_mesh_create(world.context, desc, &mesh);
    assert_ok(lb_mesh_release(mesh));
    return result;
}

/* A scene of its own: the world's keeps its camera. */
static lb_result set_camera(void* desc) {
    lb_scene scene = NULL;
    assert_ok(lb_scene_create(world.context, &scene));
    const lb_result result = lb_scene_set_camera(scene, desc);
    assert_ok(lb_scene_release(scene));
    return result;
}

static lb_result create_sun(void* desc) {
    lb_light light = NULL;
    const lb_result result = lb_sun_create(world.context, desc, &light);
    assert_ok(lb_light_release(light));
    return result;
}

static lb_result describe_mesh(void* stats) {
    return lb_mesh_info(world.mesh, stats);
}
static lb_result describe_setting(void* info) {
    return lb_setting_at(0, info);
}
static lb_result describe_frame(void* stats) {
    return lb_frame_info(world.frame, stats);
}

static lb_result map_frame(void* view) {
    lb_buffer buffer = NULL;
    const lb_result result = lb_frame_map(world.frame, "color", &buffer, view);
    assert_ok(lb_buffer_release(buffer));
    return result;
}

static lb_result map_environment(void* view) {
    lb_buffer buffer = NULL;
    const lb_result result = lb_environment_map(world.environment, "radiance", &buffer, view);
    assert_ok(lb_buffer_release(buffer));
    return result;
}

static lb_result map_brdf(void* view) {
    lb_buffer buffer = NULL;
    const lb_result result = lb_brdf_map(world.brdf, "bandwidth", &buffer, view);
    assert_ok(lb_buffer_release(buffer));
    return result;
}

static const struct versioned structs[] = {
    {"lb_context_desc", sizeof(lb_context_desc), &context_desc, create_context},
    {"lb_mesh_desc", sizeof(lb_mesh_desc), &mesh_desc, create_mesh},
    {"lb_sun_desc", sizeof(lb_sun_desc), &sun_desc, create_sun},
    {"lb_camera_desc", sizeof(lb_camera_desc), &camera_desc, set_camera},
    {"lb_mesh_stats", sizeof(lb_mesh_stats), &mesh_stats, describe_mesh},
    {"lb_setting_info", sizeof(lb_setting_info), &setting_info, describe_setting},
    {"lb_frame_stats", sizeof(lb_frame_stats), &frame_stats, describe_frame},
    {"lb_buffer_view", sizeof(lb_buffer_view), &buffer_view, map_frame},
    {"lb_buffer_view", sizeof(lb_buffer_view), &buffer_view, map_environment},
    {"lb_buffer_view", sizeof(lb_buffer_view), &buffer_view, map_brdf},
};
enum { STRUCTS = sizeof(structs) / sizeof(structs[0]) };

/* Calls with a valid instance, but struct_size as told and one byte marked (0: none). */
static lb_result call_with_size(const struct versioned* it, uint32_t struct_size, size_t marked_byte) {
    const size_t bytes = it->size + TAIL;
    unsigned char* instance = calloc(1, bytes);
    assert_non_null(instance);
    memcpy(instance, it->valid, it->size);
    memcpy(instance, &struct_size, sizeof(struct_size));
    if (marked_byte != 0) {
        instance[marked_byte] = 1;
    }
    const lb_result result = it->with(instance);
    free(instance);
    return result;
}

static void expect_refused(const struct versioned* it, uint32_t struct_size, size_t marked_byte, const char* word) {
    const lb_result result = call_with_size(it, struct_size, marked_byte);
    if (result != LB_ERROR_INVALID_ARGUMENT || strstr(lb_error_message(), word) == NULL) {
        fail_msg("%s of %u bytes: %s, %s", it->name, struct_size, lb_result_name(result), lb_error_message());
    }
}

static void expect_size_refused(const struct versioned* it, uint32_t struct_size) {
    expect_refused(it, struct_size, 0, "struct_size");
}

static void no_size_is_refused(void** state) {
    (void)state;
    for (int i = 0; i < STRUCTS; ++i) {
        expect_size_refused(&structs[i], 0);
    }
}

static void smaller_size_is_refused(void** state) {
    (void)state;
    for (int i = 0; i < STRUCTS; ++i) {
        expect_size_refused(&structs[i], 1);
        expect_size_refused(&structs[i], sizeof(uint32_t));
        expect_size_refused(&structs[i], (uint32_t)structs[i].size - 1);
    }
}

/* A program built against a later header, which leaves the new fields at their defaults. */
static void larger_size_with_zeros_is_accepted(void** state) {
    (void)state;
    for (int i = 0; i < STRUCTS; ++i) {
        const lb_result same = call_with_size(&structs[i], (uint32_t)structs[i].size, 0);
        const lb_result larger = call_with_size(&structs[i], (uint32_t)structs[i].size + TAIL, 0);
        if (same != LB_OK || larger != LB_OK) {
            fail_msg("%s: %s, larger %s: %s", structs[i].name, lb_result_name(same), lb_result_name(larger),
                     lb_error_message());
        }
    }
}

/* A program that sets a field which this version does not know must hear of it. */
static void larger_size_with_content_is_refused(void** state) {
    (void)state;
    for (int i = 0; i < STRUCTS; ++i) {
        const size_t size = structs[i].size;
        expect_refused(&structs[i], (uint32_t)(size + TAIL), size, "not zero");
        expect_refused(&structs[i], (uint32_t)(size + TAIL), size + TAIL - 1, "not zero");
    }
}

/* The size of memory that nobody set: the library must not go looking for its end. */
static void absurd_size_is_refused(void** state) {
    (void)state;
    for (int i = 0; i < STRUCTS; ++i) {
        expect_size_refused(&structs[i], UINT32_MAX);
        expect_size_refused(&structs[i], 0xA5A5A5A5u);
    }
}

/* An output keeps the caller's struct_size and is written no further than this version knows. */
static void larger_output_keeps_its_tail(void** state) {
    (void)state;
    struct {
        lb_mesh_stats known;
        unsigned char tail[TAIL];
    } larger;
    const unsigned char zeros[TAIL] = {0};
    memset(&larger, 0, sizeof(larger));
    larger.known.struct_size = sizeof(larger);
    assert_ok(lb_mesh_info(world.mesh, &larger.known));
    assert_int_equal(larger.known.struct_size, sizeof(larger));
    assert_memory_equal(larger.tail, zeros, TAIL);
    assert_true(larger.known.triangles > 0);
}

static void no_struct_is_refused(void** state) {
    (void)state;
    lb_mesh mesh = NULL;
    lb_buffer buffer = NULL;
    assert_refused(lb_mesh_create(world.context, NULL, &mesh), LB_ERROR_INVALID_ARGUMENT, "desc");
    assert_refused(lb_scene_set_camera(world.scene, NULL), LB_ERROR_INVALID_ARGUMENT, "camera");
    assert_refused(lb_mesh_info(world.mesh, NULL), LB_ERROR_INVALID_ARGUMENT, "stats");
    assert_refused(lb_setting_at(0, NULL), LB_ERROR_INVALID_ARGUMENT, "info");
    assert_refused(lb_frame_info(world.frame, NULL), LB_ERROR_INVALID_ARGUMENT, "stats");
    assert_refused(lb_frame_map(world.frame, "color", &buffer, NULL), LB_ERROR_INVALID_ARGUMENT, "view");
    assert_refused(lb_environment_map(world.environment, "radiance", &buffer, NULL), LB_ERROR_INVALID_ARGUMENT, "view");
    assert_refused(lb_brdf_map(world.brdf, "bandwidth", &buffer, NULL), LB_ERROR_INVALID_ARGUMENT, "view");
    assert_null(mesh);
    assert_null(buffer);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(no_size_is_refused, world_renders_as_before),
        cmocka_unit_test_teardown(smaller_size_is_refused, world_renders_as_before),
        cmocka_unit_test_teardown(larger_size_with_zeros_is_accepted, world_renders_as_before),
        cmocka_unit_test_teardown(larger_size_with_content_is_refused, world_renders_as_before),
        cmocka_unit_test_teardown(absurd_size_is_refused, world_renders_as_before),
        cmocka_unit_test_teardown(larger_output_keeps_its_tail, world_renders_as_before),
        cmocka_unit_test_teardown(no_struct_is_refused, world_renders_as_before),
    };
    return cmocka_run_group_tests_name("misuse of structs", tests, make_world, release_world);
}
