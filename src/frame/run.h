// One render call: runs the passes of a frame's plan, in rounds where an error or a time is asked for
// (docs/how-a-frame-is-made.md).
#pragma once

#include <string_view>

#include "frame/control_subset.h"
#include "frame/resampling.h"
#include "frame/run_state.h"
#include "passes/shade.h"
#include "passes/shading_list.h"

namespace lightband {

// What a plan needs to know of a scene.
PlanInput plan_input(const Scene& scene, const Scene::Slots& slots, uint32_t width, uint32_t height);

class Run {
public:
    Run(gl::Device& device, const Scene& scene, const Settings& settings, uint32_t width, uint32_t height,
        const Throughput& throughput, const Progress& progress);

    // Throws where the progress callback cancels.
    void execute();
    std::shared_ptr<const FrameResult> result() const { return state_.result; }
    const Throughput& throughput() const { return state_.throughput; }  // of the device, as the rounds have measured it

private:
    struct NamedPass {
        const char* name;
        Done (*run)(Run&);
    };
    static const NamedPass passes_by_name[];
    // Runs a pass and records what it did; nothing where the plan does not hold it.
    void pass(std::string_view name);

    Done geometry();
    Done list_covered();
    Done make_tables();
    Done predict();
    Done make_levels();
    Done classify();
    Done list_shaded();
    Done shade();
    Done upsample();
    Done estimate();
    Done combine();
    Done background();

    void stay_black();
    void examine_control_subset();
    void begin_rounds();
    bool rounds();
    bool plan_round(ErrorControl* control);
    void decide(ErrorControl* control);
    void accumulate();
    void finish();
    double expected_shading() const;
    void report_preparation();
    void report_shading(double samples);
    FrameResult& next() { return *state_.result; }

    RunState state_;
    ControlSubset subset_{state_};

    // Of the round that runs.
    const ErrorControl* control_ = nullptr;
    std::vector<float> scales_;  // of the levels as they are
    Tiles tiles_;                // empty where nothing is interpolated
    passes::Counts counts_;
    passes::ShadingList list_;
    passes::Seeds seeds_{};
    RoundPixels pixels_;     // as the last round left them
    Resampling resampling_;  // what a further round knows of it
    double growth_ = 1;      // samples of shaded pixels, all together, over that when they were first sampled
    RoundSamples planned_;   // of the last round
    uint64_t samples_ = 0;   // of the picture as it is
    RoundCost cost_;         // of the last round
    double further_ = 0;     // times as long as a round's shading is expected to be done after it
};

}  // namespace lightband
