// The way into the library and back.
//
// Calls on one context wait for each other, and a callback needs Python's interpreter lock. A thread that waited for
// the context while it holds the interpreter lock could wait for ever: so no thread holds that lock inside the
// library, not even to release a handle.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <utility>

#if defined(__GLIBCXX__)
#include <cxxabi.h>
#endif

namespace lightband_python {

namespace py = pybind11;

// Waits until the process has ended.
[[noreturn]] void wait_for_process_end();

// Runs work, which takes the interpreter lock or runs Python code. Before version 3.14 an interpreter that is ending
// lets every other thread that asks for its lock exit: by pthread_exit, whose forced unwinding would meet noexcept
// functions and C code here, and abort the process. Such a thread waits for the end of the process instead, as
// Python 3.14 lets it do itself.
template <typename Work>
auto surviving_finalization(const Work& work) -> decltype(work()) {
#if defined(__GLIBCXX__)
    try {
        return work();
    } catch (abi::__forced_unwind&) {
        wait_for_process_end();
    }
#else
    return work();
#endif
}

// Stands around code that runs without the interpreter lock.
class UnlockedScope {
public:
    UnlockedScope();
    ~UnlockedScope();
    UnlockedScope(const UnlockedScope&) = delete;
    UnlockedScope& operator=(const UnlockedScope&) = delete;

private:
    PyThreadState* state_;
};

// Stands around every call into the library, without the interpreter lock. Refuses (LB_ERROR_INVALID_STATE) inside a
// callback, where the library must not be called.
class LibraryCall {
public:
    LibraryCall();
    ~LibraryCall();
    LibraryCall(const LibraryCall&) = delete;
    LibraryCall& operator=(const LibraryCall&) = delete;

private:
    struct Permission {
        Permission();
    };
    Permission permission_;
    UnlockedScope unlocked_;
};

// The result of work, done as a LibraryCall.
template <typename Work>
auto in_library(const Work& work) {
    LibraryCall call;
    return work();
}

// Stands around the Python code of a callback, with the interpreter lock.
class CallbackScope {
public:
    CallbackScope();
    ~CallbackScope();
    CallbackScope(const CallbackScope&) = delete;
    CallbackScope& operator=(const CallbackScope&) = delete;

private:
    struct Lock {
        Lock();
        ~Lock();
        const PyGILState_STATE state;
    };
    Lock locked_;
    py::error_scope pending_error_;  // an exception under way when a destructor led here
};

// The result of function(arguments...).
py::object call_python(py::handle function, const py::tuple& arguments);

// Runs destroy without the interpreter lock; inside a callback, later: when the interrupted library call is over.
// While Python is ending and another thread is inside the library, never: that thread may be stopped for good while
// the library works for it, and whoever waited for its context would never end.
void destroy_outside(std::function<void()> destroy);

// Releases what the handle refers to, as destroy_outside does.
template <typename Handle>
void release_outside(Handle&& handle) {
    if (handle) {
        auto* const last = new Handle(std::move(handle));
        destroy_outside([last] { delete last; });
    }
}

// An object with a handle, as Python holds it; destroyed with the interpreter lock.
template <typename Object>
std::shared_ptr<Object> held(Object&& object) {
    return std::shared_ptr<Object>(new Object(std::move(object)), [](Object* last) {
        release_outside(std::move(last->handle));
        delete last;
    });
}

// A Python object that C++ code may drop without the interpreter lock.
std::shared_ptr<py::object> unlocked_reference(py::object object);

// Text of the library, which may hold a path in another encoding, as str.
py::str to_str(const char* text);

}  // namespace lightband_python
