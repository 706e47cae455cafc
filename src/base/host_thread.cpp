#include "base/host_thread.h"

#include <pthread.h>

namespace lightband {
namespace {

thread_local HostThread* inside = nullptr;
thread_local bool callback_runs = false;

}  // namespace

HostThread::HostThread() {
    enter();
    inside = this;
}

HostThread::~HostThread() {
    inside = nullptr;
    leave();
}

void HostThread::enter() {
    pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &cancel_state_);
    std::fegetenv(&environment_);
    std::fesetenv(FE_DFL_ENV);
}

void HostThread::leave() {
    std::fesetenv(&environment_);
    pthread_setcancelstate(cancel_state_, nullptr);
}

HostThread::Callback::Callback() : interrupted_(*inside) {
    callback_runs = true;
    interrupted_.leave();
}

HostThread::Callback::~Callback() {
    interrupted_.enter();
    callback_runs = false;
}

bool HostThread::in_callback() { return callback_runs; }

}  // namespace lightband
