// A function of the cosine of an angle, tabulated once and interpolated linearly.
#pragma once

#include <array>
#include <cstddef>

namespace lightband {

// Fresnel and Airy curves of the built-in materials bend most near grazing incidence, at the pseudo-Brewster angle;
// 512 steps follow them to 1e-3 (checked by the tests).
template <typename Value, size_t steps = 512>
class CosineCurve {
public:
    template <typename Function>
    explicit CosineCurve(Function function) {
        for (size_t node = 0; node <= steps; ++node) values_[node] = function(double(node) / steps);
    }

    // cosine in [0, 1].
    Value operator()(double cosine) const {
        const double position = cosine * steps;
        const size_t node = position < steps ? size_t(position) : steps - 1;
        const double t = position - double(node);
        return values_[node] * (1.0 - t) + values_[node + 1] * t;
    }

private:
    std::array<Value, steps + 1> values_;
};

}  // namespace lightband
