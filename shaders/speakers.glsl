// Whether a pixel is to be shaded for its cell of mirror directions, or others may speak for it.
#include "lamps.glsl"
#include "neighbours.glsl"
#include "pilots_say.glsl"
layout(binding = 8) uniform usampler2D cells;  // src/picture/targets.h, MirrorCells
layout(binding = 9) uniform usamplerBuffer claims;

bool speaks(uint place, uint word, uint slot) {
    return (texelFetch(claims, cell_index(slot, level_of(word), cell_of(word))).r & place_mask) == place;
}

// Beyond any tolerance: too few neighbours, such as would be extrapolated from, or beyond a lamp's horizon.
const float unheard_of = largest_float;

// By how much the pilots contradict what those around a pixel say of it.
float contradiction_around(uint place, uint word, uint slot) {
    Neighbours neighbours = neighbours_of(place, word, slot);
    bool parted = false;
#if LAMPS > 0
    vec3 normal = mirror_of(texelFetch(mirrors, int(place))).normal;
    for (int k = 0; k < around; ++k)
        parted = parted || neighbours.weight[k] != 0.0 && parted_by_horizon(normal, surface_at(neighbours.at[k]).normal);
#endif
    return neighbours.sound && !parted ? contradiction(neighbours.expected, neighbours.between) : unheard_of;
}
