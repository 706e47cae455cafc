/* Tests that need a process of their own: forked from one that never makes a context. */
#ifndef LIGHTBAND_TESTS_PROCESS_H
#define LIGHTBAND_TESTS_PROCESS_H

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support.h"

enum { PATIENCE = 60 }; /* seconds after which a process that has not ended counts as stuck */

/* ---- Processes ------------------------------------------------------------------------------------------------------------------- */

/* The child's status as a shell would have it; 128 + SIGALRM where it was stuck. */
static inline int status_of(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) == -1 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/* Runs a test in a process of its own, which ends as a program does. */
static inline void run_in_process(void (*test)(void)) {
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        alarm(PATIENCE);
        test();
        exit(0);
    }
    assert_int_equal(status_of(child), 0);
}

#define IN_PROCESS(test)              \
    static void test(void** state) {  \
        (void)state;                  \
        run_in_process(test##_child); \
    }

/* CMocka's assertions would go on with its next test in the child. */
#define must(condition) check_in_child((condition) != 0, #condition, __LINE__)
#define must_ok(call) check_in_child((call) == LB_OK, #call, __LINE__)
static inline void check_in_child(int holds, const char* what, int line) {
    if (holds) return;
    fprintf(stderr, "line %d, %s; last message: %s\n", line, what, lb_error_message());
    _exit(1);
}

/* ---- A picture ------------------------------------------------------------------------------------------------------------------- */

static inline void make_picture_objects(struct world* objects) {
    const float albedo[3] = {0.5f, 0.25f, 1.0f};
    float rgb[8 * 4 * 3];
    for (int i = 0; i < 8 * 4 * 3; ++i) rgb[i] = 0.125f + (float)(i % 7); /* exact, however the host rounds */
    lb_context_desc desc = LB_CONTEXT_DESC_INIT;
    lb_camera_desc camera = LB_CAMERA_DESC_INIT;
    desc.device = LB_DEVICE_SOFTWARE;
    desc.cache_path = "";
    camera.eye[2] = 2.0f;
    must_ok(lb_context_create(&desc, &objects->context));
    must_ok(lb_environment_create(objects->context, 8, 4, rgb, &objects->environment));
    must_ok(lb_brdf_create_lambert(objects->context, albedo, &objects->brdf));
    must_ok(lb_mesh_builtin(objects->context, "sphere", 16, &objects->mesh));
    must_ok(lb_scene_create(objects->context, &objects->scene));
    must_ok(lb_scene_set_environment(objects->scene, objects->environment));
    must_ok(lb_scene_set_camera(objects->scene, &camera));
    must_ok(lb_scene_add(objects->scene, objects->mesh, objects->brdf, NULL, NULL));
    must_ok(lb_frame_create(objects->context, PICTURE_SIZE, PICTURE_SIZE, &objects->frame));
    must_ok(lb_frame_set_number(objects->frame, "samples", 16));
    must_ok(lb_frame_set_choice(objects->frame, "method", "reference"));
}

static inline void draw_picture(struct world* objects, float* picture, lb_progress_callback progress) {
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    must_ok(lb_frame_render(objects->frame, objects->scene, progress, NULL));
    must_ok(lb_frame_map(objects->frame, "color", &buffer, &view));
    memcpy(picture, view.data, PICTURE_FLOATS * sizeof(float));
    must_ok(lb_buffer_release(buffer));
}

static inline void release_picture_objects(struct world* objects) {
    must_ok(lb_frame_release(objects->frame));
    must_ok(lb_scene_release(objects->scene));
    must_ok(lb_mesh_release(objects->mesh));
    must_ok(lb_brdf_release(objects->brdf));
    must_ok(lb_environment_release(objects->environment));
    must_ok(lb_context_release(objects->context));
}

#endif
