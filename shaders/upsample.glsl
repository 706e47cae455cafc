// Interpolates the pixels that are new on one lattice and were not shaded (section 3.2).
#include "common.glsl"
#include "covered.glsl"
#include "decision.glsl"
#include "parents.glsl"
#include "interpolated.glsl"

layout(binding = 3) uniform usampler2D decisions;
layout(binding = 1, r8ui) readonly uniform uimage2D levels;
uniform int level;

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint decision = texelFetch(decisions, at, 0).r;
    if (decision != interpolate_it && !is_witness(decision)) return;
    Parents parents = parents_of(at, level, float(imageLoad(levels, at).r));
    Blend sum = Blend(vec3(0), 0.0, 0.0);
    for (int corner = 0; corner < 4; ++corner)
        if (parents.weight[corner] > 0.0) blend(sum, parents.at[corner], parents.weight[corner]);
    show(at, decision, sum);
}
