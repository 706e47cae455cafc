// Interpolates the pixels that are new on one lattice and were not shaded (section 3.2).
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
    if (decision != interpolate_it && !is_witness(decision)) return;
    vec4 weight = imageLoad(weights, at);
    weight /= dot(weight, vec4(1));  // 1 but for the rounding to 16 bits
    Blend sum = Blend(vec3(0), 0.0, 0.0);
    for (int corner = 0; corner < 4; ++corner)
        if (weight[corner] > 0.0) blend(sum, at + towards_parent(at, level, corner), weight[corner]);
    show(at, decision, sum);
}
