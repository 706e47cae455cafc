// A render call on its way.
#pragma once

#include "frame/meter.h"
#include "frame/redraw.h"
#include "frame/result.h"
#include "passes/covered.h"

namespace lightband {

// What the steps of one render call share.
struct Frame::Job {
    const Scene& scene;
    Meter& meter;
    const std::shared_ptr<Result> result;
    Settings settings;  // of its rounds: the frame's, but for a sampler that was replaced
    const Scene::Slots slots;
    const passes::SlotTable slot_of;
    passes::Covered covered{};
    std::vector<float> scales{};             // of the levels as they are
    Tiles tiles{};                           // none yet where empty
    passes::Counts counts{};
    passes::ShadingList list{};              // of the last round
    RoundPixels pixels{};                    // as the last round left them
    Redraw redraw{};                         // what a further round knows of it
    double grown = 1;                        // samples of shaded pixels, all together, since they were first drawn
    Redrawing drawn{};                       // of the last round, as planned
    uint64_t samples = 0;                    // of the picture as it is
    RoundCost cost{};                        // of the last round
    Pace pace{};                             // of the device, as the rounds have measured it
    std::vector<uint8_t> material{};         // instance + 1 of each pixel, where there is an audit
    Audit audit{};
    double audited = 0;                      // part of the pixels
    std::vector<Audit::Pixel> pilots{};      // the same pixels with about as many samples as the frame will have
    uint32_t pilot_samples = 0;              // of each; 0: there are none
    uint32_t unbiased_samples = 0;           // of each pixel that was rechecked
    double expected = 0;                     // milliseconds of shading, before the first round is planned
    double further = 0;                      // times as long as a round's shading is expected to be done after it
};

}  // namespace lightband
