// The built-in materials by name, each with its constants (docs/materials.md).
#pragma once

#include <memory>
#include <vector>

#include "materials/reflectance_model.h"

namespace lightband {

struct BuiltinModel {
    const char* name;
    std::unique_ptr<ReflectanceModel> (*make)();
};

// In the order of the public index.
const std::vector<BuiltinModel>& builtin_models();

}  // namespace lightband
