// What a further round is to draw anew: the pixels at which more samples lessen the frame's error most, by what former rounds measured.
#pragma once

#include "frame/estimate.h"
#include "picture/budget.h"

namespace lightband {

struct Redraw {
    std::vector<uint8_t> bins;      // of the budget that each pixel moves to; meaningless where no former round drew
    std::vector<DrawnGroup> drawn;  // those where one did
    double growth = 1;              // of their samples, all together
};

// budget: of the former round. part: of the noise that is to be left by it; 0: pixels move to bins so that on the whole they keep
// what they had, and the budget is to be replanned. areas: the number of pixels for which each stands; empty where nothing is
// interpolated.
Redraw redraw(const RoundPixels& pixels, const std::vector<float>& areas, double mean_luminance, Allocation allocation,
              const Budget& budget, double part);

}  // namespace lightband
