#include "materials/rough_metal.h"

#include "materials/microfacet.h"

namespace lightband {

namespace {

Spectrum polished_reflectance(const IndexSpectrum& index, double cos_incident) {
    constexpr double air = 1.0;
    Spectrum reflectance;
    for (size_t sample = 0; sample < wavelength_count; ++sample)
        reflectance[sample] = fresnel_reflectance(cos_incident, air, index[sample]);
    return reflectance;
}

}  // namespace

RoughMetal::RoughMetal(const IndexSpectrum& index, double alpha)
    : facet_reflectance_(reflectance_curve([&](double cosine) { return polished_reflectance(index, cosine); })),
      alpha_(alpha) {}

Vec3 RoughMetal::value(const DirectionPair& pair) const {
    return ggx_lobe(pair, alpha_) * facet_reflectance_(pair.cos_diff);
}

}  // namespace lightband
