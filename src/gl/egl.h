// A windowless OpenGL 4.5 core context through EGL, which is loaded at run time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gl/functions.h"

namespace lightband::gl {

struct EglApi;

// Owns one EGL context, which is current on the thread that made it until that destroys it. The display is shared by the whole process
// (EGL hands out the same one for the same device), so it is never terminated: the host may be using it. A host that terminates it
// leaves a context that is current alone (EGL 1.5, section 3.2).
class EglContext {
public:
    // device: LB_DEVICE_*. Throws LB_ERROR_DEVICE with a line per attempt.
    static std::unique_ptr<EglContext> create(uint32_t device);
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    const Functions& functions() const { return functions_; }
    const std::string& name() const { return name_; }
    bool software() const { return software_; }

private:
    EglContext(const EglApi& api, void* display, void* context);
    EglContext(const EglApi& api, void* display);
    void make_current();
    void load_functions();

    const EglApi& api_;
    void* display_;
    void* context_;
    Functions functions_;
    std::string name_;
    bool software_ = false;
};

}  // namespace lightband::gl
