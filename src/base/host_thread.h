// The host's thread while it is inside the library, and the host's callbacks on it.
#pragma once

#include <cfenv>

namespace lightband {

// Stands around every call of the interface. Within it
// - the floating-point environment is the default one (to nearest, no traps, denormals kept), whatever the host has set;
// - pthread_cancel waits: the thread ends after the call.
class HostThread {
public:
    HostThread();
    ~HostThread();
    HostThread(const HostThread&) = delete;
    HostThread& operator=(const HostThread&) = delete;

    // Stands around each callback, within a HostThread: gives the host its own state back and marks the thread, so that what the
    // callback calls of the library is refused.
    class Callback {
    public:
        Callback();
        ~Callback();
        Callback(const Callback&) = delete;
        Callback& operator=(const Callback&) = delete;

    private:
        HostThread& interrupted_;
    };

    // Whether a callback runs on this thread.
    static bool in_callback();

private:
    void enter();
    void leave();

    std::fenv_t environment_;  // the host's
    int cancel_state_;         // the host's
};

}  // namespace lightband
