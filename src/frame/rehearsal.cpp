#include "frame/rehearsal.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightband {
namespace {

// As shaders/neighbours.glsl, but for the choice of neighbours, the nearest, and for slopes, of which pixels so far apart tell less.
constexpr size_t around = 9;
constexpr double normal_share = 0.5, flatness = 0.005, trace = 1e-3;
// Sums of squares below this are rounding: of some hundred pixels by 1e-8.
constexpr double nothing = 1e-13;
// The kernel ends somewhat beyond the last neighbour.
constexpr double kernel_width = 1.2;
// Fewer pixels than this are too far from each other.
constexpr size_t fewest = 64, most_rehearsed = 128;
// One pixel is believed up to an error of as much as it shows, and a ratio within these bounds: pilots that err more than what is shown do
// so by a grain of their own, which audited pixels, far from each other, do not measure.
constexpr double largest_square = 1, least_ratio = 1, most_ratio = 6;

struct Neighbour {
    double squared;  // distance
    size_t at;
};

// Weights of a plane's fit at the middle of the neighbours.
std::array<double, around> fit(const std::vector<RehearsedPixel>& pixels, const RehearsedPixel& here,
                               const std::array<Neighbour, around>& neighbours) {
    const double per_width = 1 / (kernel_width * std::sqrt(std::max(neighbours.back().squared, 1e-30)));
    const Frame3 frame(here.normal, here.direction);
    const Vec3 across = frame.bitangent, along = glm::cross(across, here.direction), normal_along = glm::cross(across, here.normal);
    std::array<double, around> weights;
    std::array<glm::dvec4, around> steps;
    glm::dvec4 mean(0);
    double sum = 0;
    for (size_t k = 0; k < around; ++k) {
        const RehearsedPixel& there = pixels[neighbours[k].at];
        const Vec3 turned = (there.direction - here.direction) * per_width;
        const Vec3 tilted = (there.normal - here.normal) * (per_width * normal_share);
        const double squared = glm::dot(turned, turned) + glm::dot(tilted, tilted), near = std::max(1 - squared, 0.0);
        weights[k] = near * near + trace / (1 + squared);
        steps[k] = {glm::dot(turned, across), glm::dot(turned, along), glm::dot(tilted, across), glm::dot(tilted, normal_along)};
        mean += weights[k] * steps[k];
        sum += weights[k];
    }
    mean /= sum;
    glm::dmat4 spread(flatness);
    for (size_t k = 0; k < around; ++k) spread += glm::outerProduct(steps[k] - mean, steps[k] - mean) * (weights[k] / sum);
    const glm::dvec4 slope = glm::inverse(spread) * mean;
    for (size_t k = 0; k < around; ++k) weights[k] *= (1 - glm::dot(slope, steps[k] - mean)) / sum;
    return weights;
}

}  // namespace

double rehearse(const std::vector<RehearsedPixel>& pixels, double dark) {
    double shown_errors = 0, expected_errors = 0;
    std::vector<Neighbour> others;
    const size_t stride = std::max<size_t>(pixels.size() / most_rehearsed, 1);
    for (size_t i = 0; i < pixels.size(); i += stride) {
        const RehearsedPixel& here = pixels[i];
        others.clear();
        for (size_t k = 0; k < pixels.size(); ++k) {
            if (k == i || pixels[k].slot != here.slot) continue;
            const Vec3 turned = pixels[k].direction - here.direction, tilted = normal_share * (pixels[k].normal - here.normal);
            others.push_back({glm::dot(turned, turned) + glm::dot(tilted, tilted), k});
        }
        if (others.size() < fewest) continue;
        std::partial_sort(others.begin(), others.begin() + around, others.end(),
                          [](const Neighbour& a, const Neighbour& b) { return a.squared < b.squared; });
        std::array<Neighbour, around> nearest;
        std::copy_n(others.begin(), around, nearest.begin());
        const std::array<double, around> weights = fit(pixels, here, nearest);
        double shown = 0, expected = 0;
        for (size_t k = 0; k < around; ++k) {
            shown += weights[k] * pixels[nearest[k].at].shown;
            expected += weights[k] * pixels[nearest[k].at].expected;
        }
        const auto square = [&](double between, double value) {
            const double scale = value + dark;
            return scale > 0 ? std::min(std::pow((between - value) / scale, 2), largest_square) : 0;
        };
        shown_errors += square(shown, here.shown);
        expected_errors += square(expected, here.expected);
    }
    return expected_errors > nothing && shown_errors > nothing ? std::clamp(shown_errors / expected_errors, least_ratio, most_ratio) : 1;
}

}  // namespace lightband
