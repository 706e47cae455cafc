#include "frame/frame.h"

#include "base/text.h"
#include "frame/run.h"

namespace lightband {

Frame::Frame(gl::DevicePtr device, uint32_t width, uint32_t height)
    : device_(std::move(device)), width_(width), height_(height) {
    for (const auto& [side, name] : {std::pair(width, "width"), std::pair(height, "height")})
        if (side < 1 || side > largest_side)
            throw Error(LB_ERROR_INVALID_ARGUMENT, text(name, " is ", side, "; it must be 1 .. ", largest_side));
}

void Frame::check(const Scene& scene) const {
    if (scene.device() != device_)
        throw Error(LB_ERROR_INVALID_ARGUMENT, "scene belongs to another context than frame");
    if (!scene.camera) throw Error(LB_ERROR_INVALID_STATE, "the scene has no camera");
    const bool controlled = settings.target_error() > 0 || settings.time_budget() > 0;
    if (controlled && settings.accumulate() > 1)
        throw Error(LB_ERROR_INVALID_STATE, text("accumulate is ", settings.accumulate(),
                                                 "; a frame with a target_error or a time_budget needs 1"));
}

void Frame::render(const Scene& scene, const Progress& progress) {
    check(scene);
    Run run(*device_, scene, settings, width_, height_, throughput_, progress);
    run.execute();
    result_ = run.result();
    throughput_ = run.throughput();
}

std::string Frame::plan(const Scene& scene) const {
    check(scene);
    return Plan(settings, plan_input(scene, scene.slots(), width_, height_)).text();
}

const FrameResult& Frame::result() const {
    if (result_ == nullptr) throw Error(LB_ERROR_INVALID_STATE, "the frame has not been rendered yet");
    return *result_;
}

std::string Frame::explain() const {
    return result().record.text(result().plan, result().stats.milliseconds, result().settings.pass_times());
}

HostArray Frame::field(const std::string& name) const {
    return lightband::field(*device_, result(), name);
}

}  // namespace lightband
