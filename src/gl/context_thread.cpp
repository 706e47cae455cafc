#include "gl/context_thread.h"

#include <csignal>
#include <cerrno>
#include <cfenv>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/host_thread.h"
#include "base/process.h"

namespace lightband::gl {
namespace {

// Drivers compile shaders on the thread: LLVM needs more than the 128 KiB that some C libraries give. This is glibc's usual size.
constexpr size_t stack_bytes = 8u << 20;

// At most so long the end of a process waits for a context to come to rest, which it does at the next pass. The slowest step of one, the
// compilation of a shader by LLVM, takes about a second on an idle machine.
constexpr std::chrono::seconds longest_wait_at_exit{15};

// Not a cancellation point inside the library (HostThread); a signal handler that ran on a host's thread interrupts it.
void wait(sem_t* semaphore) {
    while (sem_wait(semaphore) != 0 && errno == EINTR) {
    }
}

}  // namespace

// All threads of the process. Never destroyed: threads of the host may be inside the library while the process ends.
struct ContextThread::Registry {
    std::mutex mutex;
    ContextThread* first = nullptr;

    static Registry& get() {
        static auto& registry = *new Registry;
        return registry;
    }
};

ContextThread::ContextThread() {
    sem_init(&work_given_, 0, 0);
    sem_init(&caller_needed_, 0, 0);
    sigset_t all, before;
    sigfillset(&all);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, stack_bytes);
    pthread_sigmask(SIG_SETMASK, &all, &before);  // the new thread inherits the mask
    const int error = pthread_create(&thread_, &attributes, main, this);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    pthread_attr_destroy(&attributes);
    if (error != 0)
        throw Error(LB_ERROR_OUT_OF_MEMORY, text("no thread can be started for the context (error ", error,
                                                 "): memory, or the number of threads that the process may have, is used up"));
    pthread_setname_np(thread_, "lightband");
    Registry& registry = Registry::get();
    const std::lock_guard<std::mutex> lock(registry.mutex);
    next_ = registry.first;
    if (next_ != nullptr) next_->previous_ = this;
    registry.first = this;
}

ContextThread::~ContextThread() {
    if (process_was_forked()) return;  // there is no such thread in this process
    {
        Registry& registry = Registry::get();
        const std::lock_guard<std::mutex> lock(registry.mutex);
        (previous_ != nullptr ? previous_->next_ : registry.first) = next_;
        if (next_ != nullptr) next_->previous_ = previous_;
    }
    work_ = {};
    sem_post(&work_given_);
    pthread_join(thread_, nullptr);
    sem_destroy(&work_given_);
    sem_destroy(&caller_needed_);
}

void* ContextThread::main(void* self) {
    std::fesetenv(FE_DFL_ENV);  // traps, rounding and flushing of denormals are inherited from the thread that started this one
    static_cast<ContextThread*>(self)->serve();
    return nullptr;
}

void ContextThread::serve() {
    for (;;) {
        wait(&work_given_);
        if (work_.invoke == nullptr) return;
        try {
            checkpoint();
            work_.invoke(work_.object);
        } catch (...) {
            thrown_ = std::current_exception();
        }
        state_ = State::idle;
        sem_post(&caller_needed_);
    }
}

void ContextThread::hand_over(Call work, Callbacks callbacks) {
    if (process_was_forked()) throw Error(LB_ERROR_INVALID_STATE, "the context belongs to the process that this one was forked from");
    work_ = work;
    callbacks_ = callbacks;
    given_up_ = false;
    state_ = State::works;
    sem_post(&work_given_);
    for (;;) {
        wait(&caller_needed_);
        if (callback_.invoke == nullptr) break;
        answer();
    }
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void ContextThread::answer() {
    // The work refers to the caller's stack: where the callback does not return, that is unwound when the work has ended.
    struct Unwinding {
        ContextThread* thread;
        ~Unwinding() {
            if (thread != nullptr) thread->give_up();
        }
    } unwinding{this};
    {
        const HostThread::Callback running;
        callback_.invoke(callback_.object);
    }
    if (process_was_forked()) throw Error(LB_ERROR_INVALID_STATE, "the callback forked the process: a call does not go on in the child");
    unwinding.thread = nullptr;
    callback_ = {};
    state_ = State::works;
    sem_post(&work_given_);
}

void ContextThread::give_up() {
    if (process_was_forked()) return;  // the thread that works is the parent's
    callback_ = {};
    given_up_ = true;
    state_ = State::works;
    sem_post(&work_given_);
    wait(&caller_needed_);  // no further callback is asked for: the work has ended
    thrown_ = nullptr;
}

void ContextThread::call_host(Call callback) {
    checkpoint();
    if (callbacks_ == Callbacks::refused) throw Error(LB_ERROR_INTERNAL, "a callback from within a destructor");
    callback_ = callback;
    state_ = State::waits_for_callback;
    sem_post(&caller_needed_);
    wait(&work_given_);
    checkpoint();
}

void ContextThread::checkpoint() const {
    if (given_up_) throw Error(LB_ERROR_CANCELLED, "a callback did not return");
    if (process_ends()) throw Error(LB_ERROR_INVALID_STATE, "the process ends");
}

void ContextThread::rest_at_exit() {
    if (std::atexit(rest_all) != 0) throw Error(LB_ERROR_OUT_OF_MEMORY, "out of memory");
}

void ContextThread::rest_all() {
    if (process_was_forked()) return;
    begin_process_end();
    const auto last = std::chrono::steady_clock::now() + longest_wait_at_exit;
    Registry& registry = Registry::get();
    const std::lock_guard<std::mutex> lock(registry.mutex);
    for (const ContextThread* thread = registry.first; thread != nullptr; thread = thread->next_)
        while (thread->state_ == State::works && std::chrono::steady_clock::now() < last)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace lightband::gl
