// Interpolates the pixels that are new on one lattice and were not shaded (section 3.2), and compares those that were.
#include "common.glsl"
#include "covered.glsl"
#include "decision.glsl"
#include "interpolated.glsl"
#include "lattice.glsl"

layout(binding = 3) uniform usampler2D decisions;
layout(binding = 1, rgba16) readonly uniform image2D weights;  // of the parents (shaders/classify.glsl)
uniform int level;

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint decision = texelFetch(decisions, at, 0).r;
#if defined(COMBINE)
    if (!is_shaded(decision)) return;
#endif
    vec4 weight = imageLoad(weights, at);
    float all = dot(weight, vec4(1));  // 1, `doubtful` or 0, but for the rounding to 16 bits
    if (all == 0.0) {
        forget_comparison(at);
        return;
    }
    weight /= all;
    Blend sum = Blend(vec3(0), 0.0, 0.0);
    for (int corner = 0; corner < 4; ++corner)
        if (weight[corner] > 0.0) blend(sum, at + towards_parent(at, level, corner), weight[corner]);
    if (all < doubtful_below) sum.variance = -sum.variance;  // a shaded pixel's (src/picture/targets.h)
    show(at, decision, sum);
}
