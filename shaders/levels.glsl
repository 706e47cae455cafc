// The finest level of the pyramids of section 3.1: what level each covered pixel asks for (eq. 11), and its relative variance.
#include "covered.glsl"
#include "relative_variance.glsl"

layout(binding = 0) uniform sampler2D prediction;
layout(binding = 1) uniform sampler2D bandwidth;
layout(binding = 2) uniform samplerBuffer scales;  // factor on the bandwidth in each tile of TILE_SIDE pixels a side
layout(binding = 0, r8ui) writeonly uniform uimage2D levels;
#if defined(VARIANCES)
layout(binding = 1, r32f) writeonly uniform image2D variances;
uniform float mean_radiance;  // of the covered pixels
#endif
uniform float first_scale;
uniform int coarsest_level;

// Nyquist: spacing <= 1 / (2 b), src/bandwidth/transport.h. A saturated bandwidth may be any number above what pixels can
// show, and no scale makes it small. first_scale: before validation pixels were compared; where their errors ask for more, the coarsest spacing becomes as
// much finer, whatever was predicted: no multiple of nothing would.
uint shading_level(float b, float scale, float first_scale, int coarsest_level) {
    if (b >= 0.5) return 0u;
    float scaled = max(scale * b, 0.5 * (scale / first_scale) * exp2(-float(coarsest_level)));
    return uint(clamp(floor(log2(0.5 / scaled)), 0.0, float(coarsest_level)));
}

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    int tiles = (textureSize(bandwidth, 0).x + TILE_SIDE - 1) / TILE_SIDE;
    float scale = texelFetch(scales, at.y / TILE_SIDE * tiles + at.x / TILE_SIDE).r;
    imageStore(levels, at, uvec4(shading_level(texelFetch(bandwidth, at, 0).b, scale, first_scale, coarsest_level)));
#if defined(VARIANCES)
    imageStore(variances, at, vec4(relative_variance(texelFetch(prediction, at, 0).rg, mean_radiance)));
#endif
}
