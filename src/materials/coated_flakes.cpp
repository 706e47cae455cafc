#include "materials/coated_flakes.h"

#include <cmath>

#include "materials/microfacet.h"

namespace lightband {

namespace {

// The design of optically variable pigments (Phillips and Bleikolm 1996, "Optical coatings for document security",
// Appl. Opt. 35, 5529); the spacer is chosen for green at normal incidence and purple at grazing.
constexpr double absorber_nm = 5.0;
constexpr double spacer_nm = 360.0;

// Lambert's lobe of albedo p under a flat interface. Each entrance and exit costs 1 - F, which value() applies; of the
// light inside, the share F_inside = 1 - (1 - F_outside) / n^2 is thrown back at each bounce:
// p / (pi n^2) * (1 + p F_inside + (p F_inside)^2 + ...); the factor 1 / n^2 is value()'s as well.
Vec3 lobe_with_internal_bounces(const Vec3& pigment, double index) {
    const double inside = 1.0 - (1.0 - diffuse_fresnel_reflectance(index)) / (index * index);
    return pigment / (pi * (Vec3(1.0) - pigment * inside));
}

}  // namespace

Spectrum aluminium_flake_reflectance(double cos_incident) {
    Spectrum reflectance;
    for (size_t sample = 0; sample < wavelength_count; ++sample)
        reflectance[sample] =
            fresnel_reflectance(cos_incident, CoatedFlakes::coat_index, index_of_aluminium()[sample]);
    return reflectance;
}

Spectrum interference_flake_reflectance(double cos_incident) {
    Spectrum reflectance;
    for (size_t sample = 0; sample < wavelength_count; ++sample) {
        const std::vector<ThinFilm> films = {{index_of_chromium()[sample], absorber_nm},
                                             {index_of_magnesium_fluoride()[sample], spacer_nm}};
        reflectance[sample] = film_stack_reflectance(cos_incident, CoatedFlakes::coat_index, films,
                                                     index_of_aluminium()[sample], wavelength_nm(sample));
    }
    return reflectance;
}

CoatedFlakes::CoatedFlakes(const CoatedFlakesParameters& parameters, const ReflectanceCurve& flake_reflectance)
    : parameters_(parameters),
      flake_reflectance_(flake_reflectance),
      coat_reflectance_([](double cosine) { return fresnel_reflectance(cosine, 1.0, coat_index); }),
      pigment_lobe_(lobe_with_internal_bounces(parameters.pigment, coat_index)) {}

Vec3 CoatedFlakes::value(const DirectionPair& pair) const {
    const double coat = ggx_lobe(pair, parameters_.coat_alpha) * coat_reflectance_(pair.cos_diff);

    // Radiance inside the coat is n^2 times as dense as outside, hence the division by n^2 on the way out.
    const double transmitted = (1.0 - coat_reflectance_(pair.cos_i)) * (1.0 - coat_reflectance_(pair.cos_o)) /
                               (coat_index * coat_index);
    const double coverage = parameters_.flake_coverage;
    const Vec3 base = coverage * flakes(pair.refracted(coat_index)) + (1.0 - coverage) * pigment_lobe_;
    return Vec3(coat) + transmitted * base;
}

// The coat above the flakes absorbs by Beer's law along both paths.
Vec3 CoatedFlakes::flakes(const DirectionPair& inside) const {
    const double path = 1.0 / inside.cos_i + 1.0 / inside.cos_o;
    const Vec3 passed = glm::pow(parameters_.tint, Vec3(path));
    return ggx_lobe(inside, parameters_.flake_alpha) * passed * flake_reflectance_(inside.cos_diff);
}

}  // namespace lightband
