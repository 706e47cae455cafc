/* What hosts do with their process: forks, and ends while threads are inside the library. */
#include <dlfcn.h>
#include <pthread.h>
#include <stdatomic.h>

#include "process.h"

static float picture[PICTURE_FLOATS];

/* ---- Fork
 * ------------------------------------------------------------------------------------------------------------------------
 */

static void must_be_refused_for_fork(lb_result result) {
    must(result == LB_ERROR_INVALID_STATE && strstr(lb_error_message(), "fork") != NULL);
}

static void call_in_fork(void) {
    lb_context context = NULL;
    lb_mesh mesh = NULL;
    lb_buffer buffer = NULL;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    float rgb[3];
    must_be_refused_for_fork(lb_frame_render(world.frame, world.scene, NULL, NULL));
    must_be_refused_for_fork(lb_frame_map(world.frame, "color", &buffer, &view));
    must_be_refused_for_fork(lb_mesh_builtin(world.context, "plane", 8, &mesh));
    must_be_refused_for_fork(lb_brdf_albedo(world.brdf, 0.5f, rgb));
    must_be_refused_for_fork(lb_brdf_retain(world.brdf));
    must_be_refused_for_fork(lb_context_create(NULL, &context));
    release_picture_objects(&world); /* each LB_OK */
}

/* The parent goes on unharmed, and so it is with a child that ends by exit, with all exit handlers. */
static void a_fork_is_refused_every_call_child(void) {
    make_picture_objects(&world);
    draw_picture(&world, picture, NULL);
    const pid_t child = fork();
    if (child == 0) {
        alarm(PATIENCE / 4);
        call_in_fork();
        exit(0);
    }
    must(status_of(child) == 0);
    float after[PICTURE_FLOATS];
    draw_picture(&world, after, NULL);
    must(memcmp(after, picture, sizeof picture) == 0);
    release_picture_objects(&world);
}
IN_PROCESS(a_fork_is_refused_every_call)

static void a_fork_is_refused_after_the_last_release_child(void) {
    make_picture_objects(&world);
    release_picture_objects(&world);
    const pid_t child = fork();
    if (child == 0) {
        alarm(PATIENCE / 4);
        lb_context context = NULL;
        must_be_refused_for_fork(lb_context_create(NULL, &context));
        exit(0);
    }
    must(status_of(child) == 0);
}
IN_PROCESS(a_fork_is_refused_after_the_last_release)

/* run_in_process forks already: here, both of two generations make contexts, the parent after its child. */
static void a_fork_of_a_process_without_contexts_may_make_one_child(void) {
    const pid_t child = fork();
    make_picture_objects(&world);
    draw_picture(&world, picture, NULL);
    release_picture_objects(&world);
    if (child != 0) must(status_of(child) == 0);
}
IN_PROCESS(a_fork_of_a_process_without_contexts_may_make_one)

static void* render_for_ever(void* unused) {
    while (lb_frame_render(world.frame, world.scene, NULL, NULL) == LB_OK) {
    }
    return unused;
}

static void* call_for_ever(void* unused) {
    lb_mesh mesh = NULL;
    while (lb_mesh_builtin(world.context, "plane", 8, &mesh) == LB_OK && lb_mesh_release(mesh) == LB_OK) {
    }
    return unused;
}

/* Whatever locks other threads hold. */
static void a_fork_while_threads_call_does_not_hang_child(void) {
    pthread_t thread;
    make_picture_objects(&world);
    must(pthread_create(&thread, NULL, render_for_ever, NULL) == 0);
    must(pthread_create(&thread, NULL, call_for_ever, NULL) == 0);
    for (int i = 0; i < 50; ++i) {
        const pid_t child = fork();
        if (child == 0) {
            alarm(PATIENCE / 4);
            call_in_fork();
            _exit(0);
        }
        must(status_of(child) == 0);
    }
}
IN_PROCESS(a_fork_while_threads_call_does_not_hang)

static int32_t fork_in_callback(void* unused, double fraction) {
    (void)unused;
    if (fraction > 0) return 0;
    const pid_t child = fork();
    if (child != 0)
        must(status_of(child) == 0);
    else
        alarm(PATIENCE / 4);
    return 0;
}

static void a_callback_may_fork_child(void) {
    make_picture_objects(&world);
    const pid_t parent = getpid();
    const lb_result result = lb_frame_render(world.frame, world.scene, fork_in_callback, NULL);
    if (getpid() == parent)
        must(result == LB_OK);
    else
        must_be_refused_for_fork(result);
}
IN_PROCESS(a_callback_may_fork)

/* ---- The end of the process
 * ------------------------------------------------------------------------------------------------------ */

static void* create_for_ever(void* unused) {
    lb_context_desc desc = LB_CONTEXT_DESC_INIT;
    lb_context context = NULL;
    desc.device = LB_DEVICE_SOFTWARE;
    desc.cache_path = "";
    while (lb_context_create(&desc, &context) == LB_OK && lb_context_release(context) == LB_OK) {
    }
    return unused;
}

/* A new built-in material each time, whose tables of constants must outlive the exit handlers. */
static void* compute_for_ever(void* unused) {
    for (uint32_t i = 0;; ++i) {
        lb_brdf brdf = NULL;
        if (lb_brdf_builtin(world.context, lb_brdf_builtin_name(i % lb_brdf_builtin_count()), &brdf) != LB_OK)
            return unused;
        lb_brdf_release(brdf);
    }
}

static int32_t sleep_in_callback(void* unused, double fraction) {
    (void)unused;
    (void)fraction;
    pause(); /* for a signal that does not come */
    return 0;
}

static void* sleep_in_a_callback(void* unused) {
    lb_frame_render(world.frame, world.scene, sleep_in_callback, NULL);
    return unused;
}

static void* (*thread_at_exit)(void*);
static int milliseconds_to_exit;

static void end_while_a_thread_is_inside(void) {
    pthread_t thread;
    make_picture_objects(&world);
    must(pthread_create(&thread, NULL, thread_at_exit, NULL) == 0);
    usleep((useconds_t)milliseconds_to_exit * 1000);
}

static void a_process_ends_while_threads_are_inside(void** state) {
    (void)state;
    void* (*const threads[])(void*) = {render_for_ever, call_for_ever, create_for_ever, compute_for_ever,
                                       sleep_in_a_callback};
    for (size_t i = 0; i < sizeof threads / sizeof *threads; ++i)
        for (milliseconds_to_exit = 1; milliseconds_to_exit <= 64; milliseconds_to_exit *= 8) {
            thread_at_exit = threads[i];
            run_in_process(end_while_a_thread_is_inside);
        }
}

static int32_t exit_in_callback(void* unused, double fraction) {
    (void)unused;
    (void)fraction;
    exit(0);
}

static void exit_in_a_callback_child(void) {
    make_picture_objects(&world);
    lb_frame_render(world.frame, world.scene, exit_in_callback, NULL);
    _exit(1);
}
IN_PROCESS(exit_in_a_callback)

/* Takes the place of the C library's function, for this program and for all libraries it loads: counts the exit
 * handlers that others than liblightband register. */
static atomic_int foreign_exit_handlers;

__attribute__((visibility("default"))) int __cxa_atexit(void (*function)(void*), void* object, void* library);
int __cxa_atexit(void (*function)(void*), void* object, void* library) {
    int (*next)(void (*)(void*), void*, void*) = NULL;
    *(void**)&next = dlsym(RTLD_NEXT, "__cxa_atexit");
    uint32_t (*const version)(void) = lb_version;
    Dl_info ours, its;
    const int known = dladdr(*(void**)&version, &ours) != 0 && dladdr(library, &its) != 0;
    if (!known || ours.dli_fbase != its.dli_fbase) ++foreign_exit_handlers;
    return next(function, object, library);
}

/* The compiler of the driver registers the destruction of its static objects when it first compiles. If it did so while
 * pictures are drawn, these objects would be destroyed before the library's exit handler has brought the threads to
 * rest that use them. */
static void draw_first_picture(void) {
    make_picture_objects(&world);
    foreign_exit_handlers = 0;
    draw_picture(&world, picture, NULL);
    must(foreign_exit_handlers == 0);
}

static void draw_pictures_of_all_methods(void) {
    draw_first_picture();
    must_ok(lb_frame_set_choice(world.frame, "method", "adaptive"));
    draw_picture(&world, picture, NULL);
    must_ok(lb_frame_set_number(world.frame, "target_error", 0.1));
    draw_picture(&world, picture, NULL);
    must(foreign_exit_handlers == 0);
    release_picture_objects(&world);
}

/* The driver's cache of shaders is empty at first: the first process compiles all of them, the second none. */
static void the_driver_registers_exit_handlers_before_the_first_picture(void** state) {
    (void)state;
    char folder[] = "/tmp/lightband-shaders-XXXXXX";
    assert_non_null(mkdtemp(folder));
    assert_int_equal(setenv("MESA_SHADER_CACHE_DIR", folder, 1), 0);
    run_in_process(draw_pictures_of_all_methods);
    run_in_process(draw_first_picture);
    assert_int_equal(unsetenv("MESA_SHADER_CACHE_DIR"), 0);
    char command[64 + sizeof folder];
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

/* Exit handlers run in reverse order. One that was registered after the first context runs while the driver is whole;
 * to one that was registered before, calls fail and releases do nothing. */
static void draw_at_exit(void) {
    float after[PICTURE_FLOATS];
    draw_picture(&world, after, NULL);
    must(memcmp(after, picture, sizeof picture) == 0);
}

static void release_at_exit(void) {
    must(lb_frame_render(world.frame, world.scene, NULL, NULL) == LB_ERROR_INVALID_STATE);
    must(strstr(lb_error_message(), "exit") != NULL);
    release_picture_objects(&world);
}

static void exit_handlers_may_call_child(void) {
    must(atexit(release_at_exit) == 0);
    make_picture_objects(&world);
    draw_picture(&world, picture, NULL);
    must(atexit(draw_at_exit) == 0);
}
IN_PROCESS(exit_handlers_may_call)

static pthread_t worker;

static void join_worker(void) {
    must(pthread_join(worker, NULL) == 0);
}

static void exit_handlers_may_join_a_calling_thread_child(void) {
    must(atexit(join_worker) == 0);
    make_picture_objects(&world);
    draw_picture(&world, picture, NULL);
    must(pthread_create(&worker, NULL, render_for_ever, NULL) == 0);
    usleep(20000);
}
IN_PROCESS(exit_handlers_may_join_a_calling_thread)

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fork_is_refused_every_call),
        cmocka_unit_test(a_fork_is_refused_after_the_last_release),
        cmocka_unit_test(a_fork_of_a_process_without_contexts_may_make_one),
        cmocka_unit_test(a_fork_while_threads_call_does_not_hang),
        cmocka_unit_test(a_callback_may_fork),
        cmocka_unit_test(a_process_ends_while_threads_are_inside),
        cmocka_unit_test(exit_in_a_callback),
        cmocka_unit_test(the_driver_registers_exit_handlers_before_the_first_picture),
        cmocka_unit_test(exit_handlers_may_call),
        cmocka_unit_test(exit_handlers_may_join_a_calling_thread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
