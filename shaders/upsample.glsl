// Interpolates the pixels that are new on one lattice and were not shaded (section 3.2). At a witness, which was shaded, the
// interpolated value is only compared: the host judges it (src/frame/estimate.cpp).
#include "common.glsl"
#include "covered.glsl"
#include "decision.glsl"
#include "parents.glsl"

layout(binding = 3) uniform usampler2D decisions;
layout(binding = 4) uniform usampler2D sample_counts;
layout(binding = 0, rgba32f) uniform image2D radiances;  // src/frame/targets.h
layout(binding = 1, r8ui) readonly uniform uimage2D levels;
layout(binding = 2, rgba32f) uniform image2D spreads;
uniform int level;

// Variance of the luminance that a pixel holds, as if its samples were independent.
float variance_of_mean(ivec2 at, vec4 radiance) {
    uint count = texelFetch(sample_counts, at, 0).r;
    if (count == 0u) return radiance.a;
    float mean = luminance(radiance.rgb);
    return count > 1u ? max(radiance.a - mean * mean, 0.0) / float(count - 1u) : mean * mean;
}

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint decision = texelFetch(decisions, at, 0).r;
    if (decision != interpolate_it && !is_witness(decision)) return;
    Parents parents = parents_of(at, level, float(imageLoad(levels, at).r));
    vec4 sum = vec4(0);
    float spread = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        float weight = parents.weight[corner];
        if (weight <= 0.0) continue;
        vec4 radiance = imageLoad(radiances, parents.at[corner]);
        sum += weight * vec4(radiance.rgb, weight * variance_of_mean(parents.at[corner], radiance));
        spread += weight * imageLoad(spreads, parents.at[corner]).r;
    }
    if (decision == interpolate_it) {
        imageStore(radiances, at, sum);
        imageStore(spreads, at, vec4(spread, 0, 0, 0));
        return;
    }
    float own = imageLoad(spreads, at).r;
    float deviation = luminance(sum.rgb) - luminance(imageLoad(radiances, at).rgb);
    imageStore(spreads, at, vec4(own, deviation, spread - own, sum.a));
}
