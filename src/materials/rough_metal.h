// Ground metal: GGX microfacets with Fresnel's reflectance, one bounce (what facets reflect to facets is lost).
#pragma once

#include "materials/optical_constants.h"
#include "materials/reflectance_curve.h"
#include "materials/reflectance_model.h"

namespace lightband {

class RoughMetal : public ReflectanceModel {
public:
    RoughMetal(const IndexSpectrum& index, double alpha);
    Vec3 value(const DirectionPair& pair) const override;

private:
    ReflectanceCurve facet_reflectance_;
    double alpha_;
};

}  // namespace lightband
