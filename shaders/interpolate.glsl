// Interpolates over directions the pixels that were not shaded.
#include "common.glsl"
#include "covered.glsl"
#include "decision.glsl"
#include "neighbours.glsl"
#include "interpolated.glsl"

layout(binding = 2) uniform usampler2D materials;
layout(binding = 3) uniform usampler2D decisions;
layout(binding = 5) uniform usamplerBuffer brdf_of;
layout(binding = 6) uniform usampler2D cells;

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint decision = texelFetch(decisions, at, 0).r;
#if defined(COMBINE)
    if (!is_witness(decision)) return;
#else
    if (is_shaded(decision) && !is_witness(decision)) forget_comparison(at);
    if (decision != interpolate_it && !is_witness(decision)) return;
#endif
    uint slot = texelFetch(brdf_of, int(texelFetch(materials, at, 0).r)).r;
    Neighbours neighbours = neighbours_of(covered_place(), texelFetch(cells, at, 0).r, slot);
    Blend sum = Blend(vec3(0), 0.0, 0.0);
    vec3 least = vec3(largest_float), most = vec3(0);
    for (int k = 0; k < around; ++k) {
        if (neighbours.weight[k] == 0.0) continue;
        vec3 rgb = blend(sum, neighbours.at[k], neighbours.weight[k]);
        least = min(least, rgb);
        most = max(most, rgb);
    }
    // A plane may leave what its neighbours show, and light may not be negative: what is interpolated lies between them.
    sum.rgb = clamp(sum.rgb, least, most);
    show(at, decision, sum);
}
