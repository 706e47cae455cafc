#include "call.h"

#include <vector>

#include "lightband/lightband.hpp"

namespace lightband_python {

namespace {

thread_local int running_callbacks = 0;
thread_local std::vector<std::function<void()>> postponed;

}  // namespace

LibraryCall::Permission::Permission() {
    if (running_callbacks > 0) {
        throw lightband::Exception(
            LB_ERROR_INVALID_STATE,
            "a progress or log callback must not call the library: keep what it needs beforehand, "
            "or do the work after the call returned");
    }
}

LibraryCall::LibraryCall() = default;

LibraryCall::~LibraryCall() {
    while (!postponed.empty()) {
        const std::vector<std::function<void()>> batch = std::exchange(postponed, {});
        for (const std::function<void()>& destroy : batch) {
            destroy();
        }
    }
}

CallbackScope::CallbackScope() {
    ++running_callbacks;
}

CallbackScope::~CallbackScope() {
    --running_callbacks;
}

void destroy_outside(std::function<void()> destroy) {
    if (running_callbacks > 0) {
        postponed.push_back(std::move(destroy));
    } else if (PyGILState_Check()) {
        py::gil_scoped_release unlocked;
        destroy();
    } else {
        destroy();
    }
}

std::shared_ptr<py::object> unlocked_reference(py::object object) {
    return std::shared_ptr<py::object>(new py::object(std::move(object)), [](py::object* last) {
        py::gil_scoped_acquire locked;
        delete last;
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
