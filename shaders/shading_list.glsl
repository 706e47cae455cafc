// Compacts the pixels to shade into one list, ordered by BRDF and then by falling sample count, so that neighbouring lanes run
// equally long.
#include "covered.glsl"
#include "decision.glsl"

layout(binding = 0) uniform usampler2D decisions;
layout(binding = 1) uniform usampler2D materials;
layout(binding = 2) uniform usamplerBuffer brdf_of;
layout(binding = 0, std430) buffer Cursors { uint cursors[]; };  // next free place; index as in classify.glsl
layout(binding = 1, std430) writeonly buffer Entries { uint entries[]; };
layout(binding = 0, r32ui) readonly uniform uimage2D sample_counts;

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint decision = texelFetch(decisions, at, 0).r;
    if (!is_shaded(decision)) return;
    uint slot = texelFetch(brdf_of, int(texelFetch(materials, at, 0).r)).r, previous = uint(imageLoad(sample_counts, at).r > 0u);
    entries[atomicAdd(cursors[(slot * 2u + previous) * BINS + bin_of(decision)], 1u)] = uint(at.y) << 16 | uint(at.x);
}
