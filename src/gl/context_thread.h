// The thread on which one OpenGL context lives.
#pragma once

#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <exception>
#include <type_traits>

namespace lightband::gl {

// A context is made, used and destroyed on a thread of the library's own, where it stays current. Calls of the host hand their work over
// and wait. The host's thread keeps whatever context it has current, made by whatever window system, and no call pays for
// eglMakeCurrent.
//
// The thread blocks all signals, so that no handler of the host runs on it, and has the default floating-point environment.
//
// One call at a time: whoever hands work over holds the lock of the device.
class ContextThread {
public:
    ContextThread();
    ~ContextThread();
    ContextThread(const ContextThread&) = delete;
    ContextThread& operator=(const ContextThread&) = delete;

    bool is_current() const { return pthread_equal(thread_, pthread_self()) != 0; }

    // Whether the caller can leave the wait by an exception or by the end of its thread: a destructor cannot.
    enum class Callbacks { run, refused };

    // Runs work on the thread and waits for it; what it throws, this throws. Where a callback throws, or ends the calling thread, the
    // work is given up at its next checkpoint, and the stack of the caller is unwound when the work has ended.
    template <class Work>
    void run(Work&& work, Callbacks callbacks = Callbacks::run) {
        hand_over(Call::of(work), callbacks);
    }

    // From within work: runs callback on the thread that waits for the work. Throws Error where it is refused or did not return.
    template <class Callback>
    void call_back(Callback&& callback) {
        call_host(Call::of(callback));
    }

    // From within work, where it may be left off: throws Error where a callback did not return or the process ends.
    void checkpoint() const;

    // From now on, exit lets no context work while the driver's own exit handlers take apart what contexts use. To be called when the
    // driver is loaded, and again when it may have registered further ones: exit handlers run in reverse order.
    static void rest_at_exit();

private:
    // A callable that outlives its call: std::function would allocate.
    struct Call {
        void (*invoke)(void* object) = nullptr;
        void* object = nullptr;

        template <class Callable>
        static Call of(Callable& callable) {
            return {[](void* object) { (*static_cast<Callable*>(object))(); }, &callable};
        }
    };
    enum class State { idle, works, waits_for_callback };

    static void* main(void* self);
    static void rest_all();
    void serve();
    void hand_over(Call work, Callbacks callbacks);
    void answer();
    void give_up();
    void call_host(Call callback);

    pthread_t thread_{};
    sem_t work_given_, caller_needed_;
    // Passed to and fro by the semaphores: one thread at a time uses them.
    Call work_, callback_;
    std::exception_ptr thrown_;
    Callbacks callbacks_ = Callbacks::run;
    bool given_up_ = false;  // a callback did not return
    std::atomic<State> state_{State::idle};

    struct Registry;
    ContextThread *previous_ = nullptr, *next_ = nullptr;
};

}  // namespace lightband::gl
