// Calls of the library in which memory is made to run out.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lightband/lightband.h"

struct Scenario {
    std::string name;
    int sampled;  // about how many of its allocations a quick test makes fail; 0: none
    std::function<void()> prepare;
    std::function<lb_result()> call;  // the same again completes what a failure has left undone
    // All that the call may change, as bytes: the same before it and after its failure.
    std::function<std::vector<uint8_t>()> state;
    std::function<void()> release;  // all that prepare and call have made
    bool recovers = false;          // the call may succeed although an allocation failed: maps are read once more
};

// Makes a context and some files, which last until the process ends.
std::vector<Scenario> make_scenarios();
