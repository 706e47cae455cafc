// The built-in materials by name, each with its constants (docs/materials.md).
#pragma once

#include <array>
#include <memory>

#include "materials/reflectance_model.h"

namespace lightband {

struct BuiltinModel {
    const char* name;
    std::unique_ptr<ReflectanceModel> (*make)();
};

// In the order of the public index.
constexpr size_t builtin_model_count = 8;
extern const std::array<BuiltinModel, builtin_model_count> builtin_models;

}  // namespace lightband
