// A picture of a scene: its settings, and what the last render left.
#pragma once

#include <memory>
#include <string>

#include "assets/scene.h"
#include "frame/error_control.h"
#include "frame/fields.h"
#include "frame/meter.h"
#include "picture/settings.h"

namespace lightband {

class Frame {
public:
    static constexpr uint32_t largest_side = 8192;

    Frame(gl::DevicePtr device, uint32_t width, uint32_t height);

    const gl::DevicePtr& device() const { return device_; }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    Settings settings;

    // On any exception the frame stays as it was.
    void render(const Scene& scene, const Progress& progress);
    // What render would do, as text; nothing runs.
    std::string plan(const Scene& scene) const;

    // Of the last render; these throw before the first.
    lb_frame_stats stats() const { return result().stats; }
    const Settings& rendered_settings() const { return result().settings; }
    std::string explain() const;
    HostArray field(const std::string& name) const;

private:
    void check(const Scene& scene) const;
    const FrameResult& result() const;

    gl::DevicePtr device_;
    uint32_t width_, height_;
    std::shared_ptr<const FrameResult> result_;
    Throughput throughput_;  // of this frame's last rounds
};

}  // namespace lightband
