// What a frame holds after it was rendered.
#pragma once

#include "frame/estimate.h"
#include "frame/frame.h"

namespace lightband {

struct Frame::Result {
    Result(const gl::Functions& gl, uint32_t width, uint32_t height)
        : gbuffer(gl, width, height), shading(gl, width, height), plan(gl) {}

    Settings settings;
    Vec3 eye{0};
    double radiance_unit = 1;  // of what shaders wrote: Light::unit()
    GBuffer gbuffer;
    std::optional<Prediction> prediction;
    Shading shading;
    std::vector<uint32_t> slot_of;   // BRDF slot of each instance
    size_t slots = 0;
    double mean_radiance = 0;  // as predicted, of the covered pixels
    ErrorEstimate estimate;

    double squared_unit() const { return radiance_unit * radiance_unit; }
    RoundPixels read_round() const;  // of several frames, their mean
    std::vector<float> areas() const;  // the number of pixels for which each shaded one stands; empty where nothing is interpolated
    std::vector<uint8_t> neighbour_part;  // RoundPixels: of the finished picture, which shows it; empty before
    std::vector<float> accumulated;    // RGBA means over several frames, where asked for
    Plan plan;
    lb_frame_stats stats = LB_FRAME_STATS_INIT;
};

}  // namespace lightband
