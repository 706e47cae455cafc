// Importance sampling of a BRDF's lobes. Tables are sampled by numerical inversion of their cumulative distribution
// (section 3.3), with the inverse itself tabulated so that a sample costs two reads and no search; analytic lobes by
// their closed forms. The shaders/lobe.glsl does the same from the same tables.
#pragma once

#include <vector>

#include "scene/brdf.h"

namespace lightband {

// For each of `views` outgoing angles, half vectors (x, phi) with theta_half = x^2 * pi / 2: x by a piecewise linear
// inverse CDF of `radial` equally probable steps, then phi in [0, pi] by one of `azimuthal` steps that belongs to the
// step of x; the other half circle mirrors it. Within a step the density is constant and known exactly.
struct LobeTable {
    static constexpr int views = 64;      // theta_o = (view + 0.5) / views * pi / 2
    static constexpr int radial = 128;
    static constexpr int azimuthal = 32;

    struct Step {
        float start, width;
    };
    std::vector<Step> x;    // views * radial
    std::vector<Step> phi;  // views * radial * azimuthal
    // Per view: the integral of mean(f) cos(theta_i) that the density is proportional to, but for its defensive part.
    std::vector<float> albedo;
    // Per view and octave of density: the part of its samples, by their first coordinate, beyond which none is drawn more densely than
    // 2^(first_octave + octave) per steradian, but for the rounding of the grid.
    static constexpr int octaves = 32, first_octave = -16;
    std::vector<float> denser;

    // The part of all samples that is spread evenly over (x, phi), so that no direction has density 0 and no weight is
    // unbounded (Hesterberg 1995, defensive mixture).
    static constexpr double defensive_part = 1.0 / 16;

    static int view_of(double cos_outgoing);
};

LobeTable lobe_table(const Brdf& brdf);

// How much of the light from each direction a lobe reflects, coarsely: means of the luminance of f cos(theta_i) over the cells of
// the square of incident directions (docs/conventions.md), and the greatest that was seen there, for each of LobeTable::views.
struct LobeImportance {
    static constexpr int side = 16;
    std::vector<float> values, peaks;  // views * side * side
    std::vector<float> albedos;        // of each view: the integral of its values
};

LobeImportance lobe_importance(const Brdf& brdf);

struct LobeSample {
    Vec3 wi{0};
    Vec3 half{0};
    double pdf = 0;  // per steradian of wi; 0: below the horizon, carries nothing
};

// Draws wi for wo (local frame, wo at azimuth 0) from two uniform numbers in [0, 1). Refers to the BRDF it was made of.
class LobeSampler {
public:
    explicit LobeSampler(const Brdf& brdf);
    LobeSample sample(const Vec3& wo, const Vec2& u) const;
    // Density of sample() at wi, per steradian.
    double pdf(const Vec3& wi, const Vec3& wo) const;
    const LobeTable& table() const { return table_; }

private:
    const Brdf& brdf_;
    LobeTable table_;  // empty for analytic lobes
};

}  // namespace lightband
