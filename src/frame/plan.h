// What a frame did: each pass with its reason, time, memory and size. Written as the frame runs.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "gl/device.h"

namespace lightband {

class Plan {
public:
    struct Pass {
        std::string name, reason;
        double milliseconds;
        uint64_t bytes;        // device memory that the pass fills
        uint64_t invocations;  // pixels, list entries or light samples
        std::string unit;      // of invocations
    };

    explicit Plan(const gl::Functions& gl) : gl_(gl), begun_(Clock::now()), mark_(begun_) {}

    // Waits for the device and books the time since the last call on this pass.
    void finished(const char* name, const std::string& reason, uint64_t bytes, uint64_t invocations, const char* unit);

    // Corrects what a pass did, where that is known only later.
    void count(const char* name, uint64_t invocations);

    const std::vector<Pass>& passes() const { return passes_; }
    double total_milliseconds() const { return milliseconds(begun_, mark_); }
    double milliseconds_of(const std::vector<std::string>& names) const;
    std::string text() const;

private:
    using Clock = std::chrono::steady_clock;
    static double milliseconds(Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double, std::milli>(to - from).count();
    }

    const gl::Functions& gl_;
    Clock::time_point begun_, mark_;
    std::vector<Pass> passes_;
};

}  // namespace lightband
