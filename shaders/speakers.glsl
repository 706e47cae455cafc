// Whether a pixel is to be shaded for its cell of mirror directions, or others may speak for it.
#include "neighbours.glsl"
#include "pilots_say.glsl"
layout(binding = 8) uniform usampler2D cells;  // src/frame/targets.h, MirrorCells
layout(binding = 9) uniform usamplerBuffer claims;

bool speaks(uint place, uint word, uint slot) {
    return (texelFetch(claims, cell_index(slot, level_of(word), cell_of(word))).r & place_mask) == place;
}

// Beyond any tolerance: too few neighbours, or such as would be extrapolated from.
const float unheard_of = largest_float;

// By how much the pilots contradict what those around a pixel say of it.
float contradiction_around(uint place, uint word, uint slot) {
    Neighbours neighbours = neighbours_of(place, word, slot);
    return neighbours.sound ? contradiction(neighbours.expected, neighbours.between) : unheard_of;
}
