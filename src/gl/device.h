// One OpenGL context with its programs, on a thread of its own. Everything that owns OpenGL objects holds its Device; they are made and
// used within Device::run and destroyed within Device::destroy.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "gl/context_thread.h"
#include "gl/egl.h"
#include "lightband/lightband.h"

namespace lightband::gl {

class Program;

class Device {
public:
    Device(uint32_t device, lb_log_callback log, void* log_user);
    ~Device();

    const Functions& gl() const { return contents_.context->functions(); }
    const std::string& name() const { return contents_.context->name(); }
    bool software() const { return contents_.context->software(); }
    GLint max_texture_size() const { return max_texture_size_; }
    GLint max_texture_buffer_texels() const { return max_texture_buffer_texels_; }
    void log(const std::string& message) const;

    // A compute program from shaders/<name>.glsl, compiled at first use for these definitions ("A 1\nB 2").
    const Program& compute(const std::string& name, const std::string& definitions = "");
    // A program of shaders/<name>.vert and .frag.
    const Program& graphics(const std::string& name);
    size_t program_count() const { return contents_.programs.size(); }  // of those made so far

    // Throws if OpenGL has recorded an error since the last check.
    void check(const char* where) const;

    // Excludes other calls on the device for a scope.
    std::unique_lock<std::recursive_mutex> lock() { return std::unique_lock<std::recursive_mutex>(calls_); }

    // What work returns when it has run on the context's thread, where alone OpenGL may be used. Fails where work throws or OpenGL
    // has recorded an error.
    template <class Work>
    auto run(Work&& work) {
        using Result = decltype(work());
        if constexpr (std::is_void_v<Result>) {
            run_checked([&] { work(); });
        } else {
            std::optional<Result> result;
            run_checked([&] { result.emplace(work()); });
            return std::move(*result);
        }
    }

    // The same for destructors: nothing is thrown, and no callback hears of it.
    template <class Work>
    void destroy(Work&& work) noexcept {
        try {
            if (thread_.is_current()) return work();
            const auto locked = lock();
            thread_.run(work, ContextThread::Callbacks::refused);
        } catch (...) {  // a context that is gone has nothing left to be freed
        }
    }

    // From within run: runs callback on the thread that called, and leaves the work off where that is asked for.
    template <class Callback>
    void call_back(Callback&& callback) {
        thread_.call_back(callback);
    }
    void checkpoint() const { thread_.checkpoint(); }

private:
    // What has to end on the thread.
    struct Contents {
        explicit Contents(ContextThread& its_thread);
        ~Contents();
        ContextThread& thread;
        std::unique_ptr<EglContext> context;
        std::map<std::string, std::unique_ptr<Program>> programs;
    };

    template <class Work>
    void run_checked(Work&& work) {
        if (thread_.is_current()) return work();
        const auto locked = lock();
        thread_.run([&] {
            try {
                work();
                check("the call");
            } catch (...) {
                rethrow_without_errors();
            }
        });
    }
    void warm_up();
    [[noreturn]] void rethrow_without_errors() const;

    std::recursive_mutex calls_;
    mutable ContextThread thread_;
    Contents contents_{thread_};
    lb_log_callback log_;
    void* log_user_;
    GLint max_texture_size_ = 0;
    GLint max_texture_buffer_texels_ = 0;
};

using DevicePtr = std::shared_ptr<Device>;

}  // namespace lightband::gl
