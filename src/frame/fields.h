// A frame's fields as arrays in host memory.
#pragma once

#include <string>

#include "frame/host_array.h"
#include "frame/result.h"
#include "gl/device.h"

namespace lightband {

struct FieldName {
    const char* name;
    bool predicted;  // absent from a reference frame
};
constexpr FieldName field_names[] = {
    {"color", false},
    {"depth", false},
    {"position", false},
    {"normal", false},
    {"curvature", true},
    {"material", false},
    {"bandwidth_spatial", true},
    {"bandwidth_angular", true},
    {"bandwidth_image", true},
    {"level", true},
    {"shaded", false},
    {"sample_count", false},
    {"error", false},
    {"variance_predicted", true},
    {"variance_measured", false},
    {"level_pyramid", true},
    {"variance_pyramid", true},
};

// Throws where the frame has no such field.
HostArray field(gl::Device& device, const FrameResult& result, const std::string& name);

}  // namespace lightband
