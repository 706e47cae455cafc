// Paint of reflecting flakes and a matte pigment under a clear coat: a broad lobe, a diffuse part, a narrow lobe.
#pragma once

#include "materials/optical_constants.h"
#include "materials/reflectance_curve.h"
#include "materials/reflectance_model.h"

namespace lightband {

struct CoatedFlakesParameters {
    double coat_alpha;        // GGX roughness of the coat's surface
    double flake_alpha;       // GGX spread of the flakes' normals inside the coat
    double flake_coverage;    // share of the area that flakes cover; pigment fills the rest
    Vec3 tint;                // transmittance of the coat above the flakes, one way along the normal
    Vec3 pigment;             // albedo of the matte pigment inside the coat
};

// A layered model after Weidlich and Wilkie 2007, "Arbitrarily Layered Micro-Facet Surfaces": the coat reflects with a
// rough interface; light that enters passes it as if it were flat, meets flakes or pigment, and leaves again.
class CoatedFlakes : public ReflectanceModel {
public:
    static constexpr double coat_index = 1.5;  // acrylic lacquer

    // flake_reflectance: RGB of one flake against the cosine of the angle of incidence inside the coat.
    CoatedFlakes(const CoatedFlakesParameters& parameters, const ReflectanceCurve& flake_reflectance);
    Vec3 value(const DirectionPair& pair) const override;

private:
    Vec3 flakes(const DirectionPair& inside) const;

    CoatedFlakesParameters parameters_;
    ReflectanceCurve flake_reflectance_;
    CosineCurve<double> coat_reflectance_;
    Vec3 pigment_lobe_;  // 1/steradian, with the light that the coat throws back onto the pigment
};

// Reflectance of an aluminium flake inside the coat.
Spectrum aluminium_flake_reflectance(double cos_incident);

// Reflectance of an interference flake inside the coat: chromium that lets half of the light through, a spacer of
// magnesium fluoride, and an opaque aluminium mirror. The chromium absorbs the wavelengths for which the spacer is
// resonant; at grazing incidence these are shorter.
Spectrum interference_flake_reflectance(double cos_incident);

}  // namespace lightband
