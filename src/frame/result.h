// What a frame holds after it was rendered.
#pragma once

#include <optional>
#include <vector>

#include "base/math.h"
#include "frame/estimate.h"
#include "frame/plan.h"
#include "frame/record.h"
#include "lightband/lightband.h"
#include "picture/settings.h"
#include "picture/targets.h"

namespace lightband {

struct FrameResult {
    FrameResult(const gl::Functions& gl, const Settings& with_settings, uint32_t w, uint32_t h, Plan with_plan)
        : settings(with_settings),
          width(w),
          height(h),
          plan(std::move(with_plan)),
          gbuffer(gl, w, h),
          shading(gl, w, h) {}

    const Settings settings;
    const uint32_t width, height;
    const Plan plan;
    Record record;
    Vec3 eye{0};
    double radiance_unit = 1;  // of what shaders wrote: Lights::unit()
    GBuffer gbuffer;
    std::optional<Prediction> prediction;
    Shading shading;
    std::vector<uint8_t> material;  // of each pixel: instance number + 1; 0: nothing seen
    std::vector<uint32_t> slot_of;  // BRDF slot of each instance
    size_t slots = 0;
    double mean_radiance = 0;  // as predicted, of the covered pixels
    ErrorEstimate estimate;
    std::vector<uint8_t> neighbour_part;  // RoundPixels: of the finished picture, which shows it; empty before
    std::vector<float> accumulated;       // RGBA means over several frames, where asked for
    lb_frame_stats stats = LB_FRAME_STATS_INIT;

    uint64_t pixels() const { return uint64_t(width) * height; }
    double squared_unit() const { return radiance_unit * radiance_unit; }
    RoundPixels read_round() const;  // of several frames, their mean
    std::vector<float> areas()
        const;  // the number of pixels for which each shaded one stands; empty where nothing is interpolated
};

}  // namespace lightband
