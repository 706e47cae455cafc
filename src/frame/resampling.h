// Which pixels a further round samples again: those where more samples reduce the frame's error most, by the variances
// that the rounds before it have measured. A pixel is sampled again from the start, with more samples, or left as it
// is.
#pragma once

#include "frame/estimate.h"
#include "picture/budget.h"

namespace lightband {

struct Resampling {
    std::vector<uint8_t>
        bins;  // the bin of the budget that each pixel moves to; meaningless where no round has sampled it
    std::vector<SampledGroup> sampled;  // those that a round has sampled
    double growth = 1;                  // of their number of samples, all together
};

// budget: of the round before. part: of the noise that is to be left; 0: pixels move to bins so that all together keep
// the number of samples that they have, and the budget is planned again. areas: the number of pixels for which each
// stands; empty where nothing is interpolated.
Resampling plan_resampling(const RoundPixels& pixels, const std::vector<float>& areas, double mean_luminance,
                           Allocation allocation, const Budget& budget, double part);

}  // namespace lightband
