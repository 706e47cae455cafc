// One level of the pyramids of section 3.1 from the next finer one: the least level (what a block needs at its worst pixel) and the
// largest relative variance. Both pyramids are pictures with each level below the finer one.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, r8ui) uniform uimage2D levels;
#if defined(VARIANCES)
layout(binding = 1, r32f) uniform image2D variances;
#endif
uniform ivec2 finer_size;
uniform int finer_row;  // where the finer level starts
uniform int row;        // where this level starts

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = (finer_size + 1) / 2;
    if (any(greaterThanEqual(at, size))) return;
    uint least = 255u;  // nothing seen: no constraint
    float largest = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 from = min(2 * at + ivec2(corner & 1, corner >> 1), finer_size - 1) + ivec2(0, finer_row);
        least = min(least, imageLoad(levels, from).r);
#if defined(VARIANCES)
        largest = max(largest, imageLoad(variances, from).r);
#endif
    }
    imageStore(levels, at + ivec2(0, row), uvec4(least));
#if defined(VARIANCES)
    imageStore(variances, at + ivec2(0, row), vec4(largest));
#endif
}
