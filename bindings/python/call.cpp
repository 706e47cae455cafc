#include "call.h"

#include <unistd.h>

#include <atomic>
#include <vector>

#include "lightband/lightband.hpp"

namespace lightband_python {

namespace {

thread_local int running_callbacks = 0;
thread_local std::vector<std::function<void()>> postponed;

// Threads that are inside the library or in a callback of it. One that Python's end stopped there counts for ever.
std::atomic<int> threads_inside = 0;

bool is_finalizing() {
#if PY_VERSION_HEX >= 0x030D0000
    return Py_IsFinalizing() != 0;
#else
    return _Py_IsFinalizing() != 0;
#endif
}

// Whether a call could wait for a thread that Python's end has stopped.
bool could_wait_for_ever() { return is_finalizing() && threads_inside > 0; }

void run_postponed() {
    while (!postponed.empty()) {
        const std::vector<std::function<void()>> batch = std::exchange(postponed, {});
        for (const std::function<void()>& destroy : batch) {
            destroy();
        }
    }
}

}  // namespace

void wait_for_process_end() {
    for (;;) {
        pause();
    }
}

UnlockedScope::UnlockedScope() : state_((++threads_inside, PyEval_SaveThread())) {}

UnlockedScope::~UnlockedScope() {
    surviving_finalization([&] { PyEval_RestoreThread(state_); });
    --threads_inside;
}

LibraryCall::Permission::Permission() {
    if (running_callbacks > 0) {
        throw lightband::Exception(
            LB_ERROR_INVALID_STATE,
            "a progress or log callback must not call the library: keep what it needs beforehand, "
            "or do the work after the call returned");
    }
    if (could_wait_for_ever()) {
        throw lightband::Exception(LB_ERROR_INVALID_STATE,
                                   "Python is ending while another thread is inside the library: no call is possible");
    }
}

LibraryCall::LibraryCall() = default;

LibraryCall::~LibraryCall() { run_postponed(); }

CallbackScope::Lock::Lock() : state(surviving_finalization([] { return PyGILState_Ensure(); })) {}

CallbackScope::Lock::~Lock() { PyGILState_Release(state); }

CallbackScope::CallbackScope() { ++running_callbacks; }

CallbackScope::~CallbackScope() { --running_callbacks; }

py::object call_python(py::handle function, const py::tuple& arguments) {
    PyObject* const result = surviving_finalization([&] { return PyObject_CallObject(function.ptr(), arguments.ptr()); });
    if (result == nullptr) {
        throw py::error_already_set();
    }
    return py::reinterpret_steal<py::object>(result);
}

void destroy_outside(std::function<void()> destroy) {
    if (running_callbacks > 0) {
        postponed.push_back(std::move(destroy));
    } else if (PyGILState_Check() == 0) {
        destroy();
    } else if (!could_wait_for_ever()) {
        UnlockedScope unlocked;
        destroy();
        run_postponed();
    }
}

std::shared_ptr<py::object> unlocked_reference(py::object object) {
    return std::shared_ptr<py::object>(new py::object(std::move(object)), [](py::object* last) {
        CallbackScope locked;
        const py::handle dropped = last->release();
        delete last;
        surviving_finalization([&] { dropped.dec_ref(); });
    });
}

py::str to_str(const char* text) {
    PyObject* decoded =
        PyUnicode_DecodeUTF8(text, static_cast<Py_ssize_t>(std::char_traits<char>::length(text)), "replace");
    if (decoded == nullptr) {
        throw py::error_already_set();
    }
    return py::reinterpret_steal<py::str>(decoded);
}

}  // namespace lightband_python
