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

namespace lightband_python {

namespace py = pybind11;

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
    py::gil_scoped_release unlocked_;
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
    py::gil_scoped_acquire locked_;
    py::error_scope pending_error_;  // an exception under way when a destructor led here
};

// Runs destroy without the interpreter lock; inside a callback, later: when the interrupted library call is over.
void destroy_outside(std::function<void()> destroy);

// An object whose destruction releases a handle, as Python holds it.
template <typename Object>
std::shared_ptr<Object> held(Object&& object) {
    return std::shared_ptr<Object>(new Object(std::move(object)),
                                   [](Object* last) { destroy_outside([last] { delete last; }); });
}

// A Python object that C++ code may drop without the interpreter lock.
std::shared_ptr<py::object> unlocked_reference(py::object object);

// Text of the library, which may hold a path in another encoding, as str.
py::str to_str(const char* text);

}  // namespace lightband_python
