// A windowless OpenGL 4.5 core context through EGL, which is loaded at run time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gl/functions.h"

namespace lightband::gl {

struct EglApi;

// Owns one EGL context. The display is shared by the whole process (EGL hands out the same one for the same device), so
// it is never terminated: the host may be using it.
class EglContext {
public:
    // device: LB_DEVICE_*. Throws LB_ERROR_DEVICE with a line per attempt.
    static std::unique_ptr<EglContext> create(uint32_t device);
    ~EglContext();

    const Functions& functions() const { return functions_; }
    const std::string& name() const { return name_; }
    bool software() const { return software_; }

    // Makes the context current on this thread for a scope, then brings back what was current before.
    class Current {
    public:
        explicit Current(const EglContext& context);
        ~Current();
        Current(const Current&) = delete;
        Current& operator=(const Current&) = delete;

    private:
        const EglContext& context_;
        void *display_, *draw_, *read_, *previous_;
    };

private:
    EglContext(const EglApi& api, void* display, void* context);
    EglContext(const EglApi& api, void* display);
    void load_functions();

    const EglApi& api_;
    void* display_;
    void* context_;
    Functions functions_;
    std::string name_;
    bool software_ = false;
};

}  // namespace lightband::gl
