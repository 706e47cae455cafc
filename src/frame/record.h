// What the passes of a plan did when they ran: how often, on how much, and how long it took.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "frame/plan.h"

namespace lightband {

// What a pass did in one run.
struct Done {
    uint64_t invocations = 0;  // pixels, list entries or light samples
    const char* unit = "pixels";
    std::string note{};  // what was found out; empty: nothing that the plan did not know
};

class Record {
public:
    struct Entry {
        std::string name, note, unit;
        double milliseconds = 0;
        uint64_t invocations = 0;
    };

    // Passes repeat from round to round: each keeps one entry, with the last note.
    void add(std::string_view name, Done done, double milliseconds);
    // Corrects what a pass did, where that is known only later.
    void count(std::string_view name, uint64_t invocations);
    double milliseconds_of(std::string_view name) const;
    // In the order of the plan, the passes that ran; total: milliseconds of the whole frame; timed: whether each pass
    // was waited for, so that its time is known.
    std::string text(const Plan& plan, double total, bool timed) const;

private:
    std::vector<Entry> entries_;
};

}  // namespace lightband
