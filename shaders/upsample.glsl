// Section 3.2: the pixels that are new on one lattice and were not shaded take a weighted mean of their parents. At shaded pixels the
// interpolated value is only compared with the pixel's own, and the host decides from all comparisons how much either is worth
// (src/frame/combine.h). COMBINE: a last pass writes the mean of both at shaded pixels of the finest lattice.
#include "common.glsl"
#include "covered.glsl"
#include "decision.glsl"
#include "lattice.glsl"

layout(binding = 3) uniform usampler2D decisions;
layout(binding = 4) uniform usampler2D sample_counts;
layout(binding = 0, rgba32f) uniform image2D radiances;  // src/picture/targets.h
layout(binding = 1, rgba16) readonly uniform image2D weights;  // of the parents (shaders/classify.glsl)
layout(binding = 2, rgba32f) uniform image2D spreads;
#if defined(COMBINE)
layout(binding = 7) uniform usampler2D neighbour_parts;  // of the interpolated value in what a shaded pixel shows, in 255ths
#endif
uniform int level;

// Variance of the luminance that a pixel holds, as if its samples were independent.
float variance_of_mean(ivec2 at, vec4 radiance) {
    uint count = texelFetch(sample_counts, at, 0).r;
    if (count == 0u) return radiance.a;
    float mean = luminance(radiance.rgb);
    return count > 1u ? max(radiance.a - mean * mean, 0.0) / float(count - 1u) : mean * mean;
}

struct Interpolated {
    vec3 rgb;
    float variance, spread;
};

Interpolated interpolated(ivec2 at, vec4 weight) {
    Interpolated sum = Interpolated(vec3(0), 0.0, 0.0);
    for (int corner = 0; corner < 4; ++corner) {
        if (weight[corner] <= 0.0) continue;
        ivec2 parent = at + towards_parent(at, level, corner);
        vec4 radiance = imageLoad(radiances, parent);
        sum.rgb += weight[corner] * radiance.rgb;
        sum.variance += weight[corner] * weight[corner] * variance_of_mean(parent, radiance);
        sum.spread += weight[corner] * imageLoad(spreads, parent).r;
    }
    return sum;
}

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint decision = texelFetch(decisions, at, 0).r;
    vec4 weight = imageLoad(weights, at);
    float all = dot(weight, vec4(1));  // 1, `doubtful` or 0, but for the rounding to 16 bits
#if defined(COMBINE)
    if (!is_shaded(decision) || all == 0.0) return;
    vec4 own = imageLoad(radiances, at);
    vec3 rgb = mix(own.rgb, interpolated(at, weight / all).rgb, float(texelFetch(neighbour_parts, at, 0).r) / 255.0);
    // The samples keep their variance: the mean of squares moves with the square of the mean.
    float before = luminance(own.rgb), after = luminance(rgb);
    imageStore(radiances, at, vec4(rgb, own.a + after * after - before * before));
#else
    float spread = imageLoad(spreads, at).r;
    if (all == 0.0) {
        imageStore(spreads, at, vec4(spread, 0, 0, 0));  // nothing to compare with; a former round may have left something
        return;
    }
    Interpolated sum = interpolated(at, weight / all);
    if (decision == interpolate_it) {
        imageStore(radiances, at, vec4(sum.rgb, sum.variance));
        imageStore(spreads, at, vec4(sum.spread, 0, 0, 0));
        return;
    }
    if (all < doubtful_below) sum.variance = -sum.variance;  // src/picture/targets.h
    float deviation = luminance(sum.rgb) - luminance(imageLoad(radiances, at).rgb);
    imageStore(spreads, at, vec4(spread, deviation, sum.spread - spread, sum.variance));
#endif
}
