// What a frame will do: a list of passes that follows from scene and settings, before anything runs
// (docs/how-a-frame-is-made.md). A frame runs what its plan holds and nothing else.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "picture/settings.h"

namespace lightband {

// What a plan needs to know of a scene, and of the picture that is made of it.
struct PlanInput {
    uint32_t width, height;
    size_t instances, materials, lights;
};

struct PlannedPass {
    std::string name, reason;
    std::string variant;                     // the settings that choose the pass's programs: "name=choice ..."
    std::vector<std::string> reads, writes;  // buffers of the frame, by name: frame_buffers
    uint64_t bytes = 0;                      // of the buffers that no pass before it writes
};

class Plan {
public:
    Plan(const Settings& settings, const PlanInput& input);

    const std::vector<PlannedPass>& passes() const { return passes_; }
    const PlannedPass* find(std::string_view name) const;  // null: the frame does not need it
    // One line for each pass: name, bytes, what it reads and writes, variant, reason.
    std::string text() const;

private:
    std::vector<PlannedPass> passes_;
};

// The device memory of a frame (picture/targets.h), by the names that plans use.
struct FrameBuffer {
    const char* name;
    uint32_t bytes;  // of a pixel; of a list, at most
    bool pyramid;    // whether coarser levels lie below the picture
};
constexpr FrameBuffer frame_buffers[] = {
    {"surface", 16, false},   {"material", 1, false},   {"depth", 4, false},        {"covered", 4, false},
    {"bandwidth", 16, false}, {"prediction", 8, false}, {"levels", 1, true},        {"variances", 4, true},
    {"weights", 8, false},    {"decision", 1, false},   {"sample_count", 4, false}, {"shading_list", 4, false},
    {"radiance", 16, false},  {"spread", 16, false},
};
uint64_t bytes_of(const FrameBuffer& buffer, const PlanInput& input, uint32_t coarsest_level);

}  // namespace lightband
