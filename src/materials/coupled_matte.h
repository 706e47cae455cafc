// A matte body under a surface lobe, coupled so that the body gets just the light that the lobe leaves: Kelemen and
// Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling".
#pragma once

#include <functional>

#include "materials/cosine_curve.h"
#include "materials/reflectance_model.h"

namespace lightband {

class CoupledMatte : public ReflectanceModel {
public:
    using Lobe = std::function<double(const DirectionPair&)>;  // 1/steradian, reciprocal

    // The surface reflects lobe * lobe_color; matte is the share of what enters the body that it returns.
    CoupledMatte(const Lobe& lobe, const Vec3& lobe_color, const Vec3& matte);
    Vec3 value(const DirectionPair& pair) const override;

private:
    // An albedo is smoother than a Fresnel curve: 128 steps follow it to 1e-3.
    using AlbedoCurve = CosineCurve<double, 128>;
    static double average(const AlbedoCurve& albedo);

    Lobe lobe_;
    Vec3 lobe_color_;
    AlbedoCurve lobe_albedo_;
    Vec3 matte_scale_;  // 1/steradian
};

// The GGX lobe of a dielectric of this refractive index.
CoupledMatte::Lobe dielectric_lobe(double index, double alpha);

// The lobe of the fuzz of cloth.
CoupledMatte::Lobe sheen_lobe(double roughness);

}  // namespace lightband
