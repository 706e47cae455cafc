// One OpenGL context with its programs. Everything that owns OpenGL objects holds its Device; using or destroying any
// of them needs a Device::Guard on the calling thread.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "gl/egl.h"
#include "lightband/lightband.h"

namespace lightband::gl {

class Program;

class Device : public std::enable_shared_from_this<Device> {
public:
    Device(uint32_t device, lb_log_callback log, void* log_user);
    ~Device();

    const Functions& gl() const { return context_->functions(); }
    const std::string& name() const { return context_->name(); }
    bool software() const { return context_->software(); }
    GLint max_texture_size() const { return max_texture_size_; }
    GLint max_texture_buffer_texels() const { return max_texture_buffer_texels_; }
    void log(const std::string& message) const;

    // A compute program from shaders/<name>.glsl, compiled at first use for these definitions ("A 1\nB 2").
    const Program& compute(const std::string& name, const std::string& definitions = "");
    // A program of shaders/<name>.vert and .frag.
    const Program& graphics(const std::string& name);
    size_t program_count() const { return programs_.size(); }  // of those made so far

    // Throws if OpenGL has recorded an error since the last check.
    void check(const char* where) const;

    // Locks the device for this thread and makes its context current.
    class Guard {
    public:
        explicit Guard(std::shared_ptr<Device> device);

    private:
        std::shared_ptr<Device> device_;  // outlives the lock
        std::unique_lock<std::recursive_mutex> lock_;
        EglContext::Current current_;
    };

private:
    std::unique_ptr<EglContext> context_;
    std::recursive_mutex mutex_;
    lb_log_callback log_;
    void* log_user_;
    GLint max_texture_size_ = 0;
    GLint max_texture_buffer_texels_ = 0;
    std::map<std::string, std::unique_ptr<Program>> programs_;
};

using DevicePtr = std::shared_ptr<Device>;

}  // namespace lightband::gl
