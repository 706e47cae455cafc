// How far a render call is: the fraction that its progress callback is told.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>

#include "base/error.h"

namespace lightband {

using Progress = std::function<bool(double)>;  // true: stop

// The fraction is that of time. How much time is left is estimated anew at every report, since a frame that is asked for an error
// learns from each round of shading what is left to do: whatever it turns out to be, the fraction that was left is spread evenly over
// it. So the fraction never falls and never stands still, and it grows in proportion to time as far as the estimates agree.
class Meter {
public:
    explicit Meter(const Progress& progress) : progress_(progress) {}

    // left: milliseconds that the rest of the call is expected to take; 0: the call is done. Throws where the callback says to stop.
    void report(double left) {
        const Clock::time_point now = Clock::now();
        const double passed = milliseconds(reported_, now);
        fraction_ = left > 0 ? fraction_ + (1 - fraction_) * passed / (passed + left) : 1;
        reported_ = now;
        if (progress_ && progress_(std::min(fraction_, 1.0)))
            throw Error(LB_ERROR_CANCELLED, "the progress callback cancelled the frame");
    }

    // Begins to time a part of the work whose amount is known.
    void begin() { begun_ = Clock::now(); }
    // Milliseconds that the part still takes when so much of it is done, at the pace seen since it began; otherwise, where none is done yet.
    double left(double done, double all, double otherwise) const {
        return done > 0 ? milliseconds(begun_, Clock::now()) * std::max(all - done, 0.0) / done : otherwise;
    }
    // Milliseconds since the part began, and since the call did.
    double passed() const { return milliseconds(begun_, Clock::now()); }
    double since_start() const { return milliseconds(started_, Clock::now()); }

private:
    using Clock = std::chrono::steady_clock;
    static double milliseconds(Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double, std::milli>(to - from).count();
    }

    const Progress& progress_;
    double fraction_ = 0;
    const Clock::time_point started_ = Clock::now();
    Clock::time_point reported_ = started_, begun_ = started_;
};

}  // namespace lightband
