// From wavelet coefficients to bandwidth, cycles/radian, at every texel of the octahedral square: eq. 7 and
// nu_a(omega) of section 2.3. Adds luminance * bandwidth to the moments, so that their averages weigh bandwidth by light.
#include "common.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D reach;
layout(binding = 1) uniform sampler2D smoothed;
layout(binding = 0, rgba32f) uniform image2D moments;
layout(binding = 1, r32f) writeonly uniform image2D bandwidth;
uniform int side;
uniform int levels;

// Constants of src/bandwidth/wavelet.h.
const float sum_threshold = 0.01;
const float energy_percentile = 0.95;
const float rounding_floor = 1.0 / 262144.0;

float weight_of(ivec2 at, int k, float local_mean) {
    float value = texelFetch(reach, at >> (k + 1), k).r;
    if (value <= rounding_floor * ldexp(local_mean, k + 1)) return 0.0;
#if defined(BAND_RULE_ENERGY)
    return value * value;
#else
    return value;
#endif
}

// How many sides of the square a radian spans at most (src/bandwidth/octahedral.h, octahedral_stretch).
float stretch(vec3 d) {
    float s = abs(d.x) + abs(d.y) + abs(d.z), a = abs(d.x) / s, b = abs(d.z) / s;
    float aa = (1.0 - a) * (1.0 - a) + 2.0 * a * a, bb = (1.0 - b) * (1.0 - b) + 2.0 * b * b, ab = 3.0 * a * b - a - b;
    float difference = 0.5 * (aa - bb);
    return 0.5 / s * sqrt(0.5 * (aa + bb) + sqrt(difference * difference + ab * ab));
}

float band_limit(ivec2 at) {
    float local_mean = abs(ldexp(texelFetch(smoothed, at >> levels, 0).r, -levels));
    float largest = 0.0, total = 0.0;
    for (int k = 0; k < levels; ++k) {
        float w = weight_of(at, k, local_mean);
        largest = max(largest, w);
        total += w;
    }
    if (largest == 0.0) return 0.0;
#if defined(BAND_RULE_ENERGY)
    float negligible = (1.0 - energy_percentile) * total;
#else
    float negligible = sum_threshold * largest;
#endif
    float finer = 0.0;
    for (int k = 0; k < levels; ++k) {
        float own = weight_of(at, k, local_mean);
#if defined(BAND_RULE_ENERGY)
        if (finer + own >= negligible) return exp2(-1.0 - k - (negligible - finer) / own);
#else
        if (finer + own >= negligible) return ldexp(0.5, -k);
#endif
        finer += own;
    }
    return 0.0;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (max(at.x, at.y) >= side) return;
    // A map holds nothing beyond its texels: its bandwidth ends at theirs.
    float value = band_limit(at) * side * stretch(octahedral_direction((vec2(at) + 0.5) / side));
    imageStore(bandwidth, at, vec4(value));
    vec4 m = imageLoad(moments, at);
    imageStore(moments, at, vec4(m.xy, m.x * value, 0));
}
