// The hash by which the host and the shaders choose the same pixels: one source for both, shaders/hash.glsl.
#pragma once

#include <cstdint>

namespace lightband {
namespace shader_source {

using uint = uint32_t;
inline
#include "hash.glsl"

}  // namespace shader_source

using shader_source::hash;

}  // namespace lightband
