// What an interpolated pixel shows, and what a witness is held against: at a witness, which was shaded, the interpolated value is only
// compared; the host judges it (src/frame/estimate.cpp).
layout(binding = 4) uniform usampler2D sample_counts;
layout(binding = 0, rgba32f) uniform image2D radiances;  // src/picture/targets.h
layout(binding = 2, rgba32f) uniform image2D spreads;

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
    vec4 radiance = imageLoad(radiances, at);
    sum.rgb += weight * radiance.rgb;
    sum.variance += weight * weight * variance_of_mean(at, radiance);
    sum.spread += weight * imageLoad(spreads, at).r;
    return radiance.rgb;
}

void show(ivec2 at, uint decision, Blend sum) {
    if (decision == interpolate_it) {
        imageStore(radiances, at, vec4(sum.rgb, sum.variance));
        imageStore(spreads, at, vec4(sum.spread, 0, 0, 0));
        return;
    }
    float own = imageLoad(spreads, at).r, deviation = luminance(sum.rgb) - luminance(imageLoad(radiances, at).rgb);
    imageStore(spreads, at, vec4(own, deviation, sum.spread - own, sum.variance));
}
