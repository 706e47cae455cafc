// What the steps of one render call share.
#pragma once

#include <memory>

#include "assets/scene.h"
#include "frame/error_control.h"
#include "frame/meter.h"
#include "frame/result.h"
#include "lights/kinds.h"
#include "passes/covered.h"
#include "passes/predict.h"

namespace lightband {

struct RunState {
    gl::Device& device;
    const Scene& scene;
    const Settings& asked;     // the user's
    Settings settings;         // the same, but for a sampler that was replaced
    Meter meter;
    const Scene::Slots slots;
    const passes::SlotTable slot_of;
    const Lights lights;
    Throughput throughput;                                  // of the device, as it was last measured
    const std::shared_ptr<FrameResult> result;
    passes::Covered covered{};
    Forecast forecast{};
    double expected = 0;                        // milliseconds of shading, before the first round is planned

    double elapsed() const { return meter.since_start(); }  // milliseconds
};

// A choice of the sampler beside the user's.
inline Settings with_sampler(Settings settings, const char* sampler) {
    settings.set_choice("sampler", sampler);
    return settings;
}

}  // namespace lightband
