// One level of the pyramids of section 3.1: the least level (what a block needs at its worst pixel) and the largest relative
// variance. Both pyramids are pictures with each level below the finer one.
layout(local_size_x = 8, local_size_y = 8) in;

#if defined(FIRST_LEVEL)
layout(binding = 0) uniform sampler2D prediction;
uniform float mean_radiance;  // of the covered pixels
#endif
layout(binding = 0, r8ui) uniform uimage2D levels;
layout(binding = 1, r32f) uniform image2D variances;
uniform ivec2 finer_size;
uniform int finer_row;  // where the finer level starts
uniform int row;        // where this level starts

// The part of the mean that keeps dark pixels' relative errors finite: the definition of error in docs/conventions.md.
const float dark_part = 0.01;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
#if defined(FIRST_LEVEL)
    if (any(greaterThanEqual(at, finer_size))) return;
    vec2 p = texelFetch(prediction, at, 0).rg;
    float scale = p.g + dark_part * mean_radiance;
    imageStore(variances, at, vec4(scale > 0.0 ? p.r / (scale * scale) : 0.0));
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
