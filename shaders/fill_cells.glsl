// Enters the pixels that are to be shaded into the cells of their level and the two beside it, where pixels around look for neighbours.
#include "common.glsl"
#include "covered.glsl"
#include "mirrors.glsl"
#include "witnesses.glsl"

layout(binding = 2) uniform usampler2D materials;
layout(binding = 3) uniform usamplerBuffer brdf_of;
layout(binding = 4) uniform usampler2D cells;
layout(binding = 5) uniform usamplerBuffer claims;
layout(binding = 6) uniform usamplerBuffer mirrors;
layout(binding = 1, r32ui) readonly uniform uimage2D sample_counts;  // of former rounds
const int reach_of_levels = 1;
layout(binding = 0, std430) buffer Occupants { uint occupants[]; };

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint slot = texelFetch(brdf_of, int(texelFetch(materials, at, 0).r)).r, word = texelFetch(cells, at, 0).r, place = covered_place();
    bool former = imageLoad(sample_counts, at).r > 0u && !is_chosen(at);
    if (!former && level_of(word) != too_fine) {
        uint claimed = texelFetch(claims, cell_index(slot, level_of(word), cell_of(word))).r;
        if ((claimed & place_mask) != place) return;
    }
    vec2 square = unpackUnorm2x16(texelFetch(mirrors, int(place)).x);
    // Pixels around it may ask for a level more or less.
    int own = min(level_of(word), last_level);
    for (int level = max(own - reach_of_levels, first_level); level <= min(own + reach_of_levels, last_level); ++level) {
        ivec2 cell = cell_at(square, level);
        atomicMax(occupants[cell_index(slot, level, cell)], claim(closeness(square, level, cell), place));
    }
}
