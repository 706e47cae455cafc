// Rendered pixels against the oracle: a quadrature in double precision that shares no sampler with the renderer.
#pragma once

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

// The oracle's header first: see rendering.h.
// clang-format off
#include "oracle/shading.h"
#include "rendering.h"
// clang-format on

namespace lightband::testing {

// As src/scene/brdf.h calls it, too.
using Reflectance = std::variant<BrdfTable, Lambert, Ggx>;

struct Lookups {
    Lookup lookup;
    const char* name;
};
constexpr Lookups nearest = {Lookup::nearest, "nearest"}, linear = {Lookup::linear, "linear"};

inline void set_lookups(Frame& frame, const Lookups& lookups) {
    frame.set("brdf_lookup", lookups.name);
    frame.set("environment_lookup", lookups.name);
}

// Deviations of random pixels from the oracle, in standard errors of the pixels' own samples.
struct Deviations {
    int compared = 0;
    double mean = 0, largest = 0;
    int beyond_three = 0;
};

// What the pixels are expected to show, and how finely that is integrated.
struct Expectation {
    const Reflectance& brdf;
    const RgbImage& map;
    Lookups lookups;
    Vec3 seen_from;
    // 96: texels of a map of 64 x 32 are 3 x 3 cells of the quadrature each, so nearest lookup is integrated without error.
    int rows = 96;
};

inline ShadingPoint shading_point(const std::vector<float>& position, const std::vector<float>& normal, size_t pixel,
                                  const Vec3& seen_from) {
    return {glm::normalize(vector_at(normal, pixel)), glm::normalize(seen_from - vector_at(position, pixel))};
}

// Of the covered pixels, or `most` of them by chance; every one must have been shaded. On the first two the quadrature's own
// error, against one twice as fine, is checked to be below a tenth of a standard error.
inline Deviations deviations(const Frame& frame, const Expectation& expectation, size_t most) {
    OracleSettings settings;
    settings.brdf_lookup = settings.environment_lookup = expectation.lookups.lookup;
    settings.rows = expectation.rows;
    OracleSettings finer = settings;
    finer.rows = 2 * expectation.rows;

    const std::vector<float> position = field<float>(frame, "position"), normal = field<float>(frame, "normal");
    const std::vector<float> variance = field<float>(frame, "variance_measured");
    const std::vector<uint32_t> samples = field<uint32_t>(frame, "sample_count");
    const std::vector<double> rendered = luminances(frame);
    std::vector<size_t> pixels = covered_pixels(frame);
    const size_t compared = std::min(most, pixels.size());
    Random random(41);
    for (size_t i = 0; i < compared; ++i) std::swap(pixels[i], pixels[i + random.below(uint32_t(pixels.size() - i))]);

    Deviations result;
    result.compared = int(compared);
    for (size_t i = 0; i < compared; ++i) {
        const size_t pixel = pixels[i];
        const ShadingPoint point = shading_point(position, normal, pixel, expectation.seen_from);
        const double expected = luminance(reflected_radiance(expectation.brdf, expectation.map, point, settings));
        const double standard_error = std::sqrt(double(variance[pixel]) / samples[pixel]);
        assert_true(standard_error > 0);
        if (i < 2) {
            const double better = luminance(reflected_radiance(expectation.brdf, expectation.map, point, finer));
            check_close("the quadrature's own error", expected, better, 0.1 * standard_error);
        }
        const double z = (rendered[pixel] - expected) / standard_error;
        result.mean += z / double(compared);
        result.largest = std::max(result.largest, std::fabs(z));
        result.beyond_three += std::fabs(z) > 3;
    }
    return result;
}

}  // namespace lightband::testing
