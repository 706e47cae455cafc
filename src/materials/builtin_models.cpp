#include "materials/builtin_models.h"

#include "materials/coated_flakes.h"
#include "materials/coupled_matte.h"
#include "materials/rough_metal.h"

namespace lightband {

namespace {

using Model = std::unique_ptr<ReflectanceModel>;

Model interference_paint() {
    CoatedFlakesParameters parameters;
    parameters.coat_alpha = 0.05;
    parameters.flake_alpha = 0.15;
    parameters.flake_coverage = 0.9;
    parameters.tint = Vec3(1.0);
    parameters.pigment = Vec3(0.02);
    return std::make_unique<CoatedFlakes>(parameters, reflectance_curve(interference_flake_reflectance));
}

Model red_car_paint() {
    CoatedFlakesParameters parameters;
    parameters.coat_alpha = 0.05;
    parameters.flake_alpha = 0.25;
    parameters.flake_coverage = 0.6;
    parameters.tint = Vec3(0.90, 0.25, 0.22);
    parameters.pigment = Vec3(0.50, 0.03, 0.03);
    return std::make_unique<CoatedFlakes>(parameters, reflectance_curve(aluminium_flake_reflectance));
}

Model rough_gold() { return std::make_unique<RoughMetal>(index_of_gold(), 0.15); }

Model rough_nickel() { return std::make_unique<RoughMetal>(index_of_nickel(), 0.12); }

Model rough_copper() { return std::make_unique<RoughMetal>(index_of_copper(), 0.20); }

Model blue_rubber() {
    constexpr double natural_rubber_index = 1.52;
    return std::make_unique<CoupledMatte>(dielectric_lobe(natural_rubber_index, 0.45), Vec3(1.0),
                                          Vec3(0.04, 0.10, 0.32));
}

Model matte_fabric() {
    return std::make_unique<CoupledMatte>(sheen_lobe(0.30), Vec3(0.60, 0.45, 0.48), Vec3(0.25, 0.06, 0.09));
}

Model satin_white_plastic() {
    constexpr double polystyrene_index = 1.59;
    return std::make_unique<CoupledMatte>(dielectric_lobe(polystyrene_index, 0.20), Vec3(1.0),
                                          Vec3(0.82, 0.81, 0.78));
}

}  // namespace

const std::array<BuiltinModel, builtin_model_count> builtin_models = {{
    {"interference-paint", interference_paint}, {"red-car-paint", red_car_paint},
    {"rough-gold", rough_gold},                 {"rough-nickel", rough_nickel},
    {"blue-rubber", blue_rubber},               {"matte-fabric", matte_fabric},
    {"rough-copper", rough_copper},             {"satin-white-plastic", satin_white_plastic},
}};

}  // namespace lightband
