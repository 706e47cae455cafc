/* Threads: contexts are independent, calls on one context wait for each other, messages belong to their thread. */
#include <pthread.h>
#include <string.h>

#include "support.h"

enum { ROUNDS = 3, THREADS = 2 };

static float expected[PICTURE_FLOATS];

/* CMocka's assertions hold on the main thread alone: a worker counts what went wrong. */
struct worker {
    pthread_t thread;
    lb_context context; /* NULL: one of its own */
    int failures;
};

static void try_call(struct worker* worker, lb_result result) {
    worker->failures += result != LB_OK;
}

/* What make_objects builds, in a context that is given. */
static void build_scene(struct worker* worker, lb_context context, lb_scene* scene) {
    lb_brdf brdf = NULL;
    lb_mesh mesh = NULL;
    const float f0[3] = {0.9f, 0.6f, 0.3f};
    lb_camera_desc camera = LB_CAMERA_DESC_INIT;
    camera.eye[2] = 2.0f;
    try_call(worker, lb_brdf_create_ggx(context, 0.2f, f0, &brdf));
    try_call(worker, lb_mesh_builtin(context, "sphere", 16, &mesh));
    try_call(worker, lb_scene_create(context, scene));
    try_call(worker, lb_scene_set_camera(*scene, &camera));
    try_call(worker, lb_scene_add(*scene, mesh, brdf, NULL, NULL));
    try_call(worker, lb_mesh_release(mesh));
    try_call(worker, lb_brdf_release(brdf));
}

static void compare_picture(struct worker* worker, lb_frame frame) {
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    try_call(worker, lb_frame_map(frame, "color", &buffer, &view));
    worker->failures += view.data == NULL || memcmp(view.data, expected, sizeof(expected)) != 0;
    try_call(worker, lb_buffer_release(buffer));
}

/* Builds and renders the picture over and over; a failing call in between must not reach the other thread. */
static void* render_rounds(void* argument) {
    struct worker* worker = argument;
    for (int round = 0; round < ROUNDS; ++round) {
        lb_context context = worker->context;
        lb_scene scene = NULL;
        lb_frame frame = NULL;
        if (context == NULL) {
            lb_context_desc desc = LB_CONTEXT_DESC_INIT;
            desc.device = LB_DEVICE_SOFTWARE;
            desc.cache_path = "";
            try_call(worker, lb_context_create(&desc, &context));
        } else {
            try_call(worker, lb_context_retain(context));
        }
        build_scene(worker, context, &scene);
        lb_environment environment = NULL;
        const float rgb[3] = {1.0f, 0.5f, 0.25f};
        try_call(worker, lb_environment_create(context, 1, 1, rgb, &environment));
        try_call(worker, lb_scene_set_environment(scene, environment));
        try_call(worker, lb_frame_create(context, PICTURE_SIZE, PICTURE_SIZE, &frame));
        try_call(worker, lb_frame_render(frame, scene, NULL, NULL));
        compare_picture(worker, frame);
        try_call(worker, lb_frame_release(frame));
        try_call(worker, lb_scene_release(scene));
        try_call(worker, lb_environment_release(environment));
        try_call(worker, lb_context_release(context));
    }
    return NULL;
}

static void run_workers(lb_context context) {
    struct worker workers[THREADS];
    for (int i = 0; i < THREADS; ++i) {
        workers[i].context = context;
        workers[i].failures = 0;
        assert_int_equal(pthread_create(&workers[i].thread, NULL, render_rounds, &workers[i]), 0);
    }
    for (int i = 0; i < THREADS; ++i) {
        assert_int_equal(pthread_join(workers[i].thread, NULL), 0);
        assert_int_equal(workers[i].failures, 0);
    }
}

/* The picture that one thread alone gets. */
static int render_expected(void** state) {
    const float rgb[3] = {1.0f, 0.5f, 0.25f};
    lb_environment environment = NULL;
    make_world(state);
    assert_ok(lb_environment_create(world.context, 1, 1, rgb, &environment));
    assert_ok(lb_scene_set_environment(world.scene, environment));
    assert_ok(lb_environment_release(environment));
    render_picture(&world, expected);
    return 0;
}

static void two_contexts_in_two_threads(void** state) {
    (void)state;
    run_workers(NULL);
}

static void one_context_in_two_threads(void** state) {
    (void)state;
    run_workers(world.context);
}

/* Many short calls on one object from two threads: no reference is lost, none is left over. */
static void* retain_and_release(void* argument) {
    struct worker* worker = argument;
    float rgb[3];
    for (int i = 0; i < 20000; ++i) {
        try_call(worker, lb_brdf_retain(world.brdf));
        if (i % 100 == 0) {
            try_call(worker, lb_brdf_albedo(world.brdf, 0.5f, rgb));
        }
        try_call(worker, lb_brdf_release(world.brdf));
    }
    return NULL;
}

static void references_are_counted_across_threads(void** state) {
    (void)state;
    struct worker workers[THREADS];
    for (int i = 0; i < THREADS; ++i) {
        workers[i].failures = 0;
        assert_int_equal(pthread_create(&workers[i].thread, NULL, retain_and_release, &workers[i]), 0);
    }
    for (int i = 0; i < THREADS; ++i) {
        assert_int_equal(pthread_join(workers[i].thread, NULL), 0);
        assert_int_equal(workers[i].failures, 0);
    }
    lb_brdf brdf = world.brdf;
    const float f0[3] = {0.9f, 0.6f, 0.3f};
    assert_ok(lb_brdf_create_ggx(world.context, 0.2f, f0, &world.brdf));
    assert_ok(lb_brdf_release(brdf)); /* ours; the scene still holds one */
    assert_refused(lb_brdf_retain(brdf), LB_ERROR_INVALID_HANDLE, "brdf");
}

static void* fail_elsewhere(void* argument) {
    struct worker* worker = argument;
    worker->failures += lb_error_message()[0] != 0; /* a new thread has seen no failure */
    worker->failures += lb_mesh_builtin(world.context, "teapot", 0, NULL) == LB_OK;
    worker->failures += lb_error_message()[0] == 0;
    return NULL;
}

static void message_belongs_to_its_thread(void** state) {
    (void)state;
    struct worker worker = {0};
    assert_refused(lb_brdf_builtin(world.context, "unobtainium", &world.brdf), LB_ERROR_INVALID_ARGUMENT,
                   "unobtainium");
    assert_int_equal(pthread_create(&worker.thread, NULL, fail_elsewhere, &worker), 0);
    assert_int_equal(pthread_join(worker.thread, NULL), 0);
    assert_int_equal(worker.failures, 0);
    assert_non_null(strstr(lb_error_message(), "unobtainium"));
}

/* Made here, used and released there: the context is bound to no thread. */
static void* render_and_release(void* argument) {
    struct worker* worker = argument;
    const lb_scene scene = world.scene;
    lb_frame frame = NULL;
    try_call(worker, lb_frame_create(worker->context, PICTURE_SIZE, PICTURE_SIZE, &frame));
    try_call(worker, lb_frame_render(frame, scene, NULL, NULL));
    compare_picture(worker, frame);
    try_call(worker, lb_frame_release(frame));
    return NULL;
}

static void context_moves_between_threads(void** state) {
    (void)state;
    struct worker worker = {0};
    float picture[PICTURE_FLOATS];
    worker.context = world.context;
    assert_int_equal(pthread_create(&worker.thread, NULL, render_and_release, &worker), 0);
    assert_int_equal(pthread_join(worker.thread, NULL), 0);
    assert_int_equal(worker.failures, 0);
    render_picture(&world, picture);
    assert_memory_equal(picture, expected, sizeof(picture));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_contexts_in_two_threads),           cmocka_unit_test(one_context_in_two_threads),
        cmocka_unit_test(references_are_counted_across_threads), cmocka_unit_test(message_belongs_to_its_thread),
        cmocka_unit_test(context_moves_between_threads),
    };
    return cmocka_run_group_tests_name("threads", tests, render_expected, release_world);
}
