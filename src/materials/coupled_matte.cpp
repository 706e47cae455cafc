#include "materials/coupled_matte.h"

#include <algorithm>
#include <cmath>

#include "materials/microfacet.h"
#include "materials/optics.h"

namespace lightband {

namespace {

// Both lobes divide by the eye's cosine while their albedo is flat near grazing; it is taken here at the latest.
constexpr double grazing_cosine = 1e-3;

// Directional albedo of a lobe: the integral of lobe * cos_i over the hemisphere, by the midpoint rule.
double lobe_albedo(const CoupledMatte::Lobe& lobe, double cos_o) {
    constexpr int polar_steps = 64;
    constexpr int azimuth_steps = 64;  // of half a turn; the other half mirrors it
    const double eye_cosine = std::max(cos_o, grazing_cosine);
    const Vec3 eye(std::sqrt(1.0 - eye_cosine * eye_cosine), 0.0, eye_cosine);
    double sum = 0.0;
    for (int polar = 0; polar < polar_steps; ++polar) {
        const double theta = (polar + 0.5) / polar_steps * pi / 2.0;
        for (int turn = 0; turn < azimuth_steps; ++turn) {
            const double phi = (turn + 0.5) / azimuth_steps * pi;
            const Vec3 light(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            sum += lobe(DirectionPair::from_directions(light, eye)) * std::sin(theta) * std::cos(theta);
        }
    }
    return sum * (pi / 2.0 / polar_steps) * (2.0 * pi / azimuth_steps);
}

}  // namespace

// The mean over a cosine-weighted hemisphere: the integral of 2 cos * albedo over cos, by the midpoint rule.
double CoupledMatte::average(const AlbedoCurve& albedo) {
    constexpr int steps = 512;
    double sum = 0.0;
    for (int step = 0; step < steps; ++step) {
        const double cosine = (step + 0.5) / steps;
        sum += 2.0 * cosine * albedo(cosine) / steps;
    }
    return sum;
}

CoupledMatte::CoupledMatte(const Lobe& lobe, const Vec3& lobe_color, const Vec3& matte)
    : lobe_(lobe),
      lobe_color_(lobe_color),
      lobe_albedo_([&](double cosine) { return lobe_albedo(lobe, cosine); }),
      matte_scale_(matte / (pi * (Vec3(1.0) - lobe_color * average(lobe_albedo_)))) {}

Vec3 CoupledMatte::value(const DirectionPair& pair) const {
    const Vec3 entering = Vec3(1.0) - lobe_color_ * lobe_albedo_(pair.cos_i);
    const Vec3 leaving = Vec3(1.0) - lobe_color_ * lobe_albedo_(pair.cos_o);
    return lobe_color_ * lobe_(pair) + matte_scale_ * entering * leaving;
}

CoupledMatte::Lobe dielectric_lobe(double index, double alpha) {
    const CosineCurve<double> facet_reflectance([=](double cosine) { return fresnel_reflectance(cosine, 1.0, index); });
    return [=](const DirectionPair& pair) { return ggx_lobe(pair, alpha) * facet_reflectance(pair.cos_diff); };
}

CoupledMatte::Lobe sheen_lobe(double roughness) {
    return [=](const DirectionPair& pair) { return charlie_lobe(pair, roughness); };
}

}  // namespace lightband
