/* What the integration tests share. They see the library as any C program does: through its header alone. */
#ifndef LIGHTBAND_TESTS_SUPPORT_H
#define LIGHTBAND_TESTS_SUPPORT_H

/* cmocka.h wants these four first. */
/* clang-format off */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
/* clang-format on */

#include "lightband/lightband.h"

/* One small object of each kind, enough to render a picture. */
struct world {
    lb_context context;
    lb_environment environment;
    lb_brdf brdf;
    lb_mesh mesh;
    lb_scene scene;
    lb_frame frame;
};
extern struct world world;

enum { PICTURE_SIZE = 24, PICTURE_FLOATS = PICTURE_SIZE * PICTURE_SIZE * 4 };

/* For cmocka_run_group_tests: makes and releases the world. Rendering is by software. */
int make_world(void** state);
int release_world(void** state);

/* For each test's teardown: whatever was refused, the world renders the same picture as at first. */
int world_renders_as_before(void** state);

void make_objects(struct world* objects);
void release_objects(struct world* objects);
lb_context make_software_context(void);
lb_environment make_flat_environment(lb_context context, float radiance);
lb_frame render_frame(struct world* objects, uint32_t width, uint32_t height);

/* Renders the objects' scene into their frame and copies its radiance. */
void render_picture(struct world* objects, float picture[PICTURE_FLOATS]);

/* The call succeeds; else the test fails with the library's message. */
#define assert_ok(call) check_ok((call), #call, __FILE__, __LINE__)
void check_ok(lb_result result, const char* call, const char* file, int line);

/* The call fails with this code, and its message holds each of the words. */
#define assert_refused(call, code, ...) \
    check_refused((call), (code), (const char* const[]){__VA_ARGS__, NULL}, #call, __FILE__, __LINE__)
void check_refused(lb_result result, lb_result code, const char* const* words, const char* call, const char* file,
                   int line);

/* No element of the frame's field is NaN or infinite. */
void assert_finite_field(lb_frame frame, const char* name);

#endif
