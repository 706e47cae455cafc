// What an interpolated pixel shows. At a shaded pixel the interpolated value is first only compared with the pixel's own, and the host
// decides from all comparisons how much either is worth (src/frame/combine.h). COMBINE: a last pass writes what such pixels show.
layout(binding = 4) uniform usampler2D sample_counts;
layout(binding = 0, rgba32f) uniform image2D radiances;  // src/picture/targets.h
layout(binding = 2, rgba32f) uniform image2D spreads;
#if defined(COMBINE)
layout(binding = 3, rgba32f) readonly uniform image2D sources;  // radiances that are interpolated
layout(binding = 7) uniform usampler2D neighbour_parts;         // of the interpolated value in what a shaded pixel shows, in 255ths
#else
#define sources radiances
#endif

// Variance of the luminance that a pixel holds, as if its samples were independent.
float variance_of_mean(ivec2 at, vec4 radiance) {
    uint count = texelFetch(sample_counts, at, 0).r;
    if (count == 0u) return radiance.a;
    float mean = luminance(radiance.rgb);
    return count > 1u ? max(radiance.a - mean * mean, 0.0) / float(count - 1u) : mean * mean;
}

// A weighted sum of pixels.
struct Blend {
    vec3 rgb;
    float variance, spread;
};

// Returns what that pixel shows.
vec3 blend(inout Blend sum, ivec2 at, float weight) {
    vec4 radiance = imageLoad(sources, at);
    sum.rgb += weight * radiance.rgb;
    sum.variance += weight * weight * variance_of_mean(at, radiance);
    sum.spread += weight * imageLoad(spreads, at).r;
    return radiance.rgb;
}

// Of a shaded pixel that cannot be interpolated: what a former round may have left.
void forget_comparison(ivec2 at) {
#if !defined(COMBINE)
    imageStore(spreads, at, vec4(imageLoad(spreads, at).r, 0, 0, 0));
#endif
}

void show(ivec2 at, uint decision, Blend sum) {
    vec4 own = imageLoad(radiances, at);
#if defined(COMBINE)
    vec3 rgb = mix(own.rgb, sum.rgb, float(texelFetch(neighbour_parts, at, 0).r) / 255.0);
    // The samples keep their variance: the mean of squares moves with the square of the mean.
    float before = luminance(own.rgb), after = luminance(rgb);
    imageStore(radiances, at, vec4(rgb, own.a + after * after - before * before));
#else
    if (decision == interpolate_it) {
        imageStore(radiances, at, vec4(sum.rgb, sum.variance));
        imageStore(spreads, at, vec4(sum.spread, 0, 0, 0));
        return;
    }
    float spread = imageLoad(spreads, at).r;
    imageStore(spreads, at, vec4(spread, luminance(sum.rgb) - luminance(own.rgb), sum.spread - spread, sum.variance));
#endif
}
