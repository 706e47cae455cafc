// A render call on its way.
#pragma once

#include "frame/redraw.h"
#include "frame/result.h"
#include "passes/covered.h"

namespace lightband {

// What the steps of one render call share.
struct Frame::Job {
    const Scene& scene;
    const Progress& progress;
    const std::shared_ptr<Result> result;
    Settings settings;  // of its rounds: the frame's, but without interpolation where that does not pay
    const Scene::Slots slots;
    const passes::SlotTable slot_of;
    passes::Covered covered{};
    std::vector<float> scales{};             // of the levels as they are
    Tiles tiles{};                           // none yet where empty
    std::vector<ForeseenTile> foreseen{};    // of interpolation over directions; none where empty
    passes::Counts counts{};
    passes::ShadingList list{};              // of the last round
    RoundPixels pixels{};                    // as the last round left them
    Redraw redraw{};                         // what a further round knows of it
    double grown = 1;                        // samples of shaded pixels, all together, since they were first drawn
    Redrawing drawn{};                       // of the last round, as planned
    uint64_t samples = 0;                    // of the picture as it is
    RoundCost cost{};                        // of the last round
    std::vector<uint8_t> material{};         // instance + 1 of each pixel, where there is an audit
    Audit audit{};
    double audited = 0;                      // part of the pixels
    double done = 0, part = 0;               // of the progress: before this round, and the round's own

    void report(double fraction) const {
        if (progress && progress(std::min(done + part * fraction, 1.0)))
            throw Error(LB_ERROR_CANCELLED, "the progress callback cancelled the frame");
    }
};

}  // namespace lightband
