// What interpolation over directions will cost, before a sample is drawn: how far interpolation of the pilots' expectations errs, at some
// of the pixels, tile by tile.
#include "common.glsl"
#include "covered.glsl"
#include "surface.glsl"
#include "speakers.glsl"
layout(binding = 2) uniform usampler2D materials;
layout(binding = 3) uniform usamplerBuffer brdf_of;
layout(binding = 0, std430) buffer Tiles { uvec4 tiles[]; };  // sum of squared errors, pixels that may be interpolated, pixels that may not
uniform float units;  // that a squared error of 1 has

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint word = texelFetch(cells, at, 0).r, slot = texelFetch(brdf_of, int(texelFetch(materials, at, 0).r)).r;
    if (level_of(word) == too_fine) return;  // finer cells are not to be had
    int tile = tile_of(slot, cell_of(word) >> (level_of(word) - first_level));
    float error = speaks(covered_place(), word, slot) ? unheard_of : abs(contradiction_around(covered_place(), word, slot));
    if (error > tolerance) {
        atomicAdd(tiles[tile].z, 1u);
    } else {
        atomicAdd(tiles[tile].x, uint(round(error * error * units)));
        atomicAdd(tiles[tile].y, 1u);
    }
}
