// The thread on which a context lives: its state, what it hands back, and the time that handing over takes.
#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <cfenv>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/host_thread.h"
#include "gl/device.h"

extern "C" {
// clang-format off
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
// clang-format on
}

namespace {

using lightband::Error;
using lightband::HostThread;
using lightband::gl::ContextThread;
using lightband::gl::Device;

void signals_are_blocked(void**) {
    ContextThread thread;
    sigset_t blocked;
    thread.run([&] { pthread_sigmask(SIG_SETMASK, nullptr, &blocked); });
    for (const int signal : {SIGINT, SIGTERM, SIGALRM, SIGPROF, SIGCHLD, SIGUSR1, SIGSEGV, SIGFPE, SIGRTMIN})
        assert_int_equal(sigismember(&blocked, signal), 1);
}

void a_thread_has_a_name_and_a_stack_for_compilers(void**) {
    ContextThread thread;
    char name[16] = "";
    size_t stack = 0;
    thread.run([&] {
        pthread_getname_np(pthread_self(), name, sizeof name);
        pthread_attr_t attributes;
        pthread_getattr_np(pthread_self(), &attributes);
        pthread_attr_getstacksize(&attributes, &stack);
        pthread_attr_destroy(&attributes);
    });
    assert_string_equal(name, "lightband");
    assert_true(stack >= size_t(8) << 20);
}

void the_floating_point_environment_is_the_default(void**) {
    std::fenv_t before;
    std::fegetenv(&before);
    feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    std::fesetround(FE_DOWNWARD);
    ContextThread thread;
    int traps = -1, rounding = -1;
    thread.run([&] {
        traps = fegetexcept();
        rounding = std::fegetround();
    });
    std::fesetenv(&before);
    assert_int_equal(traps, 0);
    assert_int_equal(rounding, FE_TONEAREST);
}

void what_work_throws_comes_back(void**) {
    ContextThread thread;
    for (int round = 0; round < 3; ++round) {
        bool caught = false;
        try {
            thread.run([] { throw Error(LB_ERROR_LIMIT, "too much"); });
        } catch (const Error& error) {
            caught = error.code() == LB_ERROR_LIMIT && std::strcmp(error.what(), "too much") == 0;
        }
        assert_true(caught);
    }
    int answer = 0;
    thread.run([&] { answer = 42; });
    assert_int_equal(answer, 42);
}

void callbacks_run_on_the_waiting_thread(void**) {
    ContextThread thread;
    const HostThread inside;
    const pthread_t caller = pthread_self();
    int right = 0;
    thread.run([&] {
        for (int i = 0; i < 100; ++i)
            thread.call_back([&] { right += pthread_equal(caller, pthread_self()) != 0 && HostThread::in_callback(); });
    });
    assert_int_equal(right, 100);
    assert_false(HostThread::in_callback());
}

// The exception passes the waiting caller, whose stack the work may refer to until it has ended.
void an_exception_of_a_callback_passes_when_the_work_has_ended(void**) {
    ContextThread thread;
    const HostThread inside;
    bool given_up = false, ended = false, caught = false;
    try {
        thread.run([&] {
            struct AtEnd {
                bool* flag;
                ~AtEnd() { *flag = true; }
            } at_end{&ended};
            try {
                thread.call_back([] { throw 7; });
            } catch (const Error& error) {
                given_up = error.code() == LB_ERROR_CANCELLED;
                throw;
            }
        });
    } catch (int number) {
        caught = number == 7 && ended;
    }
    assert_true(given_up);
    assert_true(caught);
    int answer = 0;
    thread.run([&] { thread.call_back([&] { answer = 1; }); });
    assert_int_equal(answer, 1);
}

// ---- Errors of OpenGL --------------------------------------------------------------------------------

struct Failure {
    lb_result code;
    std::string message;
};

template <class Work>
Failure failure_of(Device& device, Work&& work) {
    try {
        device.run(work);
        return {LB_OK, ""};
    } catch (const Error& error) {
        return {error.code(), error.what()};
    }
}

void an_error_of_opengl_fails_the_call_that_caused_it(void**) {
    Device device(LB_DEVICE_SOFTWARE, nullptr, nullptr);
    constexpr GLenum no_capability = 0xffff;
    assert_int_equal(failure_of(device, [&] { device.gl().Enable(no_capability); }).code, LB_ERROR_DEVICE);
    assert_int_equal(failure_of(device, [] {}).code, LB_OK);
}

void an_error_of_a_failed_call_is_not_left_to_the_next(void**) {
    Device device(LB_DEVICE_SOFTWARE, nullptr, nullptr);
    constexpr GLenum no_capability = 0xffff;
    const Failure failed = failure_of(device, [&] {
        device.gl().Enable(no_capability);
        throw Error(LB_ERROR_LIMIT, "for another reason");
    });
    assert_int_equal(failed.code, LB_ERROR_LIMIT);
    assert_string_equal(failed.message.c_str(), "for another reason");
    assert_int_equal(failure_of(device, [] {}).code, LB_OK);
}

// What fails for want of memory says so, whatever noticed it first.
void device_memory_that_runs_out_is_a_limit(void**) {
    Device device(LB_DEVICE_SOFTWARE, nullptr, nullptr);
    const Failure failed = failure_of(device, [&] {
        GLuint buffer = 0;
        device.gl().CreateBuffers(1, &buffer);
        device.gl().NamedBufferStorage(buffer, GLsizeiptr(1) << 46, nullptr, 0);
        device.gl().DeleteBuffers(1, &buffer);
        throw Error(LB_ERROR_DEVICE, "the framebuffer is incomplete");
    });
    assert_int_equal(failed.code, LB_ERROR_LIMIT);
    assert_non_null(std::strstr(failed.message.c_str(), "out of memory"));
    assert_int_equal(failure_of(device, [] {}).code, LB_OK);
}

// ---- Time --------------------------------------------------------------------------------------------

// Printed, not asserted: it depends on the machine and on what else it does.
void hand_over_takes_microseconds(void**) {
    using Clock = std::chrono::steady_clock;
    ContextThread thread;
    for (const int pause : {0, 2000}) {  // microseconds between calls: the thread is awake, or asleep
        std::vector<double> times;
        for (int i = 0; i < (pause > 0 ? 300 : 20'000); ++i) {
            const auto start = Clock::now();
            thread.run([] {});
            times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
            if (pause > 0) std::this_thread::sleep_for(std::chrono::microseconds(pause));
        }
        std::sort(times.begin(), times.end());
        print_message("hand-over, %d us between calls: median %.1f us, 99 %% %.1f us\n", pause, times[times.size() / 2],
                      times[times.size() * 99 / 100]);
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(signals_are_blocked),
        cmocka_unit_test(a_thread_has_a_name_and_a_stack_for_compilers),
        cmocka_unit_test(the_floating_point_environment_is_the_default),
        cmocka_unit_test(what_work_throws_comes_back),
        cmocka_unit_test(callbacks_run_on_the_waiting_thread),
        cmocka_unit_test(an_exception_of_a_callback_passes_when_the_work_has_ended),
        cmocka_unit_test(an_error_of_opengl_fails_the_call_that_caused_it),
        cmocka_unit_test(an_error_of_a_failed_call_is_not_left_to_the_next),
        cmocka_unit_test(device_memory_that_runs_out_is_a_limit),
        cmocka_unit_test(hand_over_takes_microseconds),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
