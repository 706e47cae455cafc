// One level of the pyramids of section 3.1: the least level (what a block needs at its worst pixel) and the largest relative
// variance. Both pyramids are pictures with each level below the finer one. The first level comes from the prediction (eq. 11).
#if defined(FIRST_LEVEL)
#include "relative_variance.glsl"
#include "shading_level.glsl"
#endif
layout(local_size_x = 8, local_size_y = 8) in;

#if defined(FIRST_LEVEL)
layout(binding = 0) uniform sampler2D prediction;
layout(binding = 1) uniform sampler2D bandwidth;
layout(binding = 2) uniform usampler2D materials;
uniform float mean_radiance;  // of the covered pixels
layout(binding = 3) uniform samplerBuffer scales;  // factor on the bandwidth in each tile of TILE_SIDE pixels a side
uniform int coarsest_level;
#endif
layout(binding = 0, r8ui) uniform uimage2D levels;
layout(binding = 1, r32f) uniform image2D variances;
uniform ivec2 finer_size;
uniform int finer_row;  // where the finer level starts
uniform int row;        // where this level starts

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
#if defined(FIRST_LEVEL)
    if (any(greaterThanEqual(at, finer_size))) return;
    uint material = texelFetch(materials, at, 0).r, level = 255u;  // nothing seen: no constraint
    if (material != 0u) {
        int tiles = (finer_size.x + TILE_SIDE - 1) / TILE_SIDE;
        float scale = texelFetch(scales, at.y / TILE_SIDE * tiles + at.x / TILE_SIDE).r;
        level = shading_level(texelFetch(bandwidth, at, 0).b, scale, coarsest_level);
    }
    imageStore(levels, at, uvec4(level));
    imageStore(variances, at, vec4(relative_variance(texelFetch(prediction, at, 0).rg, mean_radiance)));
#else
    ivec2 size = (finer_size + 1) / 2;
    if (any(greaterThanEqual(at, size))) return;
    uint least = 255u;
    float largest = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 from = min(2 * at + ivec2(corner & 1, corner >> 1), finer_size - 1) + ivec2(0, finer_row);
        least = min(least, imageLoad(levels, from).r);
        largest = max(largest, imageLoad(variances, from).r);
    }
    imageStore(levels, at + ivec2(0, row), uvec4(least));
    imageStore(variances, at + ivec2(0, row), vec4(largest));
#endif
}
