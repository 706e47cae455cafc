// Sorts pixels into the cells of their mirror directions, as fine as bandwidth asks for. One pixel of each cell is to be shaded; the
// others may be interpolated.
#include "common.glsl"
#include "covered.glsl"
#include "surface.glsl"
#include "mirrors.glsl"
#include "witnesses.glsl"

layout(binding = 2) uniform usampler2D materials;
layout(binding = 3) uniform usamplerBuffer brdf_of;
layout(binding = 4) uniform sampler2D reflected;     // cycles per radian
layout(binding = 5) uniform samplerBuffer scales;    // factor on it in each tile of a slot's directions
layout(binding = 6) uniform sampler2D prediction;
layout(binding = 0, r32ui) writeonly uniform uimage2D cells;
layout(binding = 2, rgba32ui) writeonly uniform uimageBuffer mirrors;
layout(binding = 1, r32ui) readonly uniform uimage2D sample_counts;  // of former rounds
uniform float wider;  // factor on the scale
uniform float first_scale;
layout(binding = 0, std430) buffer Claims { uint claims[]; };
layout(binding = 1, std430) buffer Counts { uint counts[]; };  // pixels of each cell

const float cells_per_cycle = 2.0;  // Nyquist

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    vec3 normal = surface_at(at).normal, wo = towards_eye(at), direction = 2.0 * dot(normal, wo) * normal - wo;
    imageStore(mirrors, int(covered_place()), words_of(Mirror(normal, direction, texelFetch(prediction, at, 0).g, at)));
    vec2 square = octahedral(direction);
    uint slot = texelFetch(brdf_of, int(texelFetch(materials, at, 0).r)).r;
    float scale = texelFetch(scales, tile_of(slot, cell_at(square, first_level))).r;
    // A cell at level 0 would be so wide.
    float side = wider * scale * cells_per_cycle * texelFetch(reflected, at, 0).r * cell_width(direction, 0);
    // Where witnesses ask for more than at first, the coarsest cells become as much finer, whatever was predicted.
    side = max(side, scale / first_scale * exp2(float(first_level)));
    int level = int(clamp(ceil(log2(side)), float(first_level), float(last_level + 1)));
    if (level > last_level) {
        imageStore(cells, at, uvec4(cell_word(too_fine, ivec2(0))));
        return;
    }
    ivec2 cell = cell_at(square, level);
    imageStore(cells, at, uvec4(cell_word(level, cell)));
    int index = cell_index(slot, level, cell);
    atomicAdd(counts[index], 1u);
    // What is shaded already speaks first; but not what is to tell, as a witness, what interpolation does to others.
    bool former = imageLoad(sample_counts, at).r > 0u && !is_chosen(at);
    uint rank = closeness(square, level, cell) + (former ? 32u : 0u);
    atomicMax(claims[index], claim(rank, covered_place()));
}
