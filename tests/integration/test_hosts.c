/* What hosts do with their threads: floating-point traps, signals, OpenGL contexts of their own. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fenv.h>
#include <pthread.h>
#include <signal.h>
#include <sys/time.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "process.h"

static float picture[PICTURE_FLOATS];

/* ---- Floating point -------------------------------------------------------------------------------------------------------------- */

static const int traps = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW;

static void set_unusual_environment(void) {
    must(feenableexcept(traps) != -1);
    must(fesetround(FE_DOWNWARD) == 0);
#if defined(__SSE__)
    _mm_setcsr(_mm_getcsr() | 0x8040); /* denormals are flushed to zero, and taken for it */
#endif
}

static void must_be_in_unusual_environment(void) {
    must(fegetexcept() == traps);
    must(fegetround() == FE_DOWNWARD);
#if defined(__SSE__)
    must((_mm_getcsr() & 0x8040) == 0x8040);
#endif
}

static int32_t check_environment(void* unused, double fraction) {
    (void)unused;
    (void)fraction;
    must_be_in_unusual_environment();
    return 0;
}

/* One call of each kind that computes. */
static void compute_everything(struct world* objects, float results[6]) {
    lb_brdf gold = NULL, ggx = NULL;
    lb_environment map = NULL;
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    const float f0[3] = {1, 1, 1}, up[3] = {0, 0, 1};
    lb_frame adaptive = NULL;
    must_ok(lb_brdf_builtin(objects->context, "rough-gold", &gold));
    must_ok(lb_brdf_create_ggx(objects->context, 1e-4f, f0, &ggx));
    must_ok(lb_brdf_albedo(gold, 1.5f, results));
    must_ok(lb_brdf_evaluate(ggx, up, up, results + 3));
    must_ok(lb_environment_load(objects->context, LIGHTBAND_TEST_MAP, &map));
    must_ok(lb_environment_map(map, "bandwidth", &buffer, &view));
    must_ok(lb_buffer_release(buffer));
    must_ok(lb_brdf_map(ggx, "bandwidth", &buffer, &view));
    must_ok(lb_buffer_release(buffer));
    must_ok(lb_frame_create(objects->context, PICTURE_SIZE, PICTURE_SIZE, &adaptive));
    must_ok(lb_frame_set_number(adaptive, "target_error", 0.1));
    must_ok(lb_frame_render(adaptive, objects->scene, NULL, NULL));
    must_ok(lb_frame_save(adaptive, "traps.exr", NULL));
    must_ok(lb_frame_save(adaptive, "traps.png", NULL));
    remove("traps.exr");
    remove("traps.png");
    must(lb_brdf_create_ggx(objects->context, -1, f0, &ggx) == LB_ERROR_INVALID_ARGUMENT); /* numbers in a message */
    must_ok(lb_frame_release(adaptive));
    must_ok(lb_environment_release(map));
    must_ok(lb_brdf_release(gold));
    must_ok(lb_brdf_release(ggx));
}

static void the_floating_point_environment_of_the_host_stays_outside_child(void) {
    struct world usual;
    float expected[PICTURE_FLOATS], expected_results[6], results[6];
    make_picture_objects(&usual);
    draw_picture(&usual, expected, NULL);
    compute_everything(&usual, expected_results);
    release_picture_objects(&usual);
    set_unusual_environment();
    make_picture_objects(&world);
    draw_picture(&world, picture, check_environment);
    compute_everything(&world, results);
    release_picture_objects(&world);
    must_be_in_unusual_environment();
    must(memcmp(picture, expected, sizeof expected) == 0);
    must(memcmp(results, expected_results, sizeof results) == 0);
}
IN_PROCESS(the_floating_point_environment_of_the_host_stays_outside)

/* ---- Signals --------------------------------------------------------------------------------------------------------------------- */

static pthread_t main_thread;
static volatile sig_atomic_t handled, handled_elsewhere;

static void handle(int number) {
    (void)number;
    ++handled;
    if (!pthread_equal(main_thread, pthread_self())) ++handled_elsewhere;
}

/* Signals of the process go to any thread that does not block them: often while the main thread waits in a call. */
static void handlers_run_on_threads_of_the_host_alone_child(void) {
    main_thread = pthread_self();
    make_picture_objects(&world);
    signal(SIGPROF, handle);
    const struct itimerval millisecond = {{0, 1000}, {0, 1000}}, never = {{0, 0}, {0, 0}};
    setitimer(ITIMER_PROF, &millisecond, NULL);
    for (int i = 0; i < 20; ++i) draw_picture(&world, picture, NULL);
    setitimer(ITIMER_PROF, &never, NULL);
    must(handled > 0);
    must(handled_elsewhere == 0);
}
IN_PROCESS(handlers_run_on_threads_of_the_host_alone)

/* ---- OpenGL of the host ---------------------------------------------------------------------------------------------------------- */

static EGLDisplay display;
static EGLContext context;

static int make_context_of_the_host(EGLenum platform) {
    const PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    const PFNEGLQUERYDEVICESEXTPROC query_devices = (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
    EGLDeviceEXT device = NULL;
    EGLint devices = 0;
    if (platform == EGL_PLATFORM_DEVICE_EXT && (query_devices == NULL || !query_devices(1, &device, &devices) || devices == 0)) return 0;
    display = get_display(platform, device, NULL);
    if (!eglInitialize(display, NULL, NULL)) return 0;
    eglBindAPI(EGL_OPENGL_ES_API);
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 2, EGL_NONE};
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

static void must_be_current(void) {
    must(eglGetCurrentContext() == context && eglGetCurrentDisplay() == display && eglQueryAPI() == EGL_OPENGL_ES_API);
}

static int32_t check_current(void* unused, double fraction) {
    (void)unused;
    (void)fraction;
    must_be_current();
    return 0;
}

static EGLenum platform_of_the_host;

static void keep_a_context_current(void) {
    if (!make_context_of_the_host(platform_of_the_host)) return; /* the driver has no such platform */
    make_picture_objects(&world);
    must_be_current();
    draw_picture(&world, picture, check_current);
    must_be_current();
    release_picture_objects(&world);
    must_be_current();
}

static void use_contexts_of_a_terminated_display(void) {
    if (!make_context_of_the_host(platform_of_the_host)) return;
    make_picture_objects(&world);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    must(eglTerminate(display));
    float after[PICTURE_FLOATS];
    draw_picture(&world, picture, NULL);  /* what is current stays until it is no longer */
    must_ok(lb_frame_release(world.frame));
    must_ok(lb_frame_create(world.context, PICTURE_SIZE, PICTURE_SIZE, &world.frame));
    release_picture_objects(&world);
    make_picture_objects(&world);
    draw_picture(&world, after, NULL);
    must(memcmp(after, picture, sizeof picture) == 0);
    release_picture_objects(&world);
}

static void on_each_platform(void (*test)(void)) {
    const EGLenum platforms[] = {EGL_PLATFORM_DEVICE_EXT, EGL_PLATFORM_SURFACELESS_MESA};
    for (int i = 0; i < 2; ++i) {
        platform_of_the_host = platforms[i];
        run_in_process(test);
    }
}

static void the_context_of_the_host_stays_current(void** state) {
    (void)state;
    on_each_platform(keep_a_context_current);
}

static void the_host_may_terminate_the_display(void** state) {
    (void)state;
    on_each_platform(use_contexts_of_a_terminated_display);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_floating_point_environment_of_the_host_stays_outside),
        cmocka_unit_test(handlers_run_on_threads_of_the_host_alone),
        cmocka_unit_test(the_context_of_the_host_stays_current),
        cmocka_unit_test(the_host_may_terminate_the_display),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
