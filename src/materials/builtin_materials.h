// Materials that the library computes itself: tables in the MERL layout from physical models.
#pragma once

#include <string>

#include "scene/brdf_table.h"

namespace lightband {

// Computes the table, or reads it from cache_path (a folder; empty: no cache) where an earlier call left it.
// LB_ERROR_INVALID_ARGUMENT for an unknown name. Trouble with the cache is no error: the table is computed.
BrdfTable builtin_material(const std::string& name, const std::string& cache_path);

}  // namespace lightband
