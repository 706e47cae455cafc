// The shading integral (eq. 2) of the listed pixels: one invocation a pixel, one part of its samples a dispatch.
#include "common.glsl"
#include "lobe.glsl"
layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D map;
layout(binding = 1) uniform usamplerBuffer entries;
layout(binding = 5) uniform sampler2D positions;
layout(binding = 6) uniform sampler2D normals;
layout(binding = 7) uniform usampler2D decisions;
#if !defined(SEQUENCE_RANDOM)
layout(binding = 8) uniform usamplerBuffer sequence;  // a (0,2)-sequence, 32 bits a coordinate
#endif
#if defined(SAMPLER_COMBINED)
layout(binding = 10) uniform samplerBuffer map_points;  // src/sampling/map_sampler.h: two vec4 each
#endif
layout(binding = 0, rgba32f) uniform image2D radiances;      // mean of RGB; mean of squared luminance
layout(binding = 1, r32ui) uniform uimage2D sample_counts;   // samples that went into them
uniform uint first, count;                                   // part of the list
uniform uint samples[BINS];                                  // for each bin
uniform uint part;                                           // samples before this part
uniform uint seed;

// Radiance, and the density (per steradian) with which the map's sampler draws the direction.
vec4 light_from(vec3 direction) {
    vec2 uv = latitude_longitude(direction);
#if defined(ENVIRONMENT_NEAREST)
    ivec2 size = textureSize(map, 0);
    return texelFetch(map, min(ivec2(uv * size), size - 1), 0);
#else
    return textureLod(map, uv, 0.0);
#endif
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint entry = texelFetch(entries, int(first + gl_GlobalInvocationID.x)).r;
    ivec2 at = ivec2(entry & 0xffffu, entry >> 16);
    uint wanted = samples[texelFetch(decisions, at, 0).r - 2u];
    if (wanted <= part) return;
    uint n = min(wanted - part, uint(PART_SAMPLES));

    vec3 normal = texelFetch(normals, at, 0).xyz;
    vec3 wo_world = -normalize(texelFetch(positions, at, 0).xyz);
    mat3 frame = local_frame(normal, wo_world);
    float cosine = min(dot(normal, wo_world), 1.0);
    vec3 wo = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
    int view = lobe_view(cosine);

    uint state = hash(entry ^ hash(seed ^ hash(part)));
#if !defined(SEQUENCE_RANDOM)
    // A digital shift of each pixel's own keeps the sequence's stratification and makes the mean unbiased.
    uvec2 shift = uvec2(next_random(state), next_random(state));
#endif
    vec4 sum = vec4(0);
    uint drawn = 0u;
#if defined(SAMPLER_COMBINED)
    // Half the samples from the map: an aligned block, of its own for each pixel, of the points drawn beforehand.
    uint from_map = n / 2u, from_lobe = n - from_map;
    uint block = from_map > 1u ? 2u << findMSB(from_map - 1u) : 1u;
    int map_start = int(next_random(state) & (MAP_POINTS - block));
    float share = float(n) / float(from_lobe), map_share = float(n) / float(max(from_map, 1u));
    float map_odds = float(from_map) / float(from_lobe);  // samples of the map for each of the lobe
#else
    const uint from_lobe = n;
#endif
    for (uint i = 0u; i < from_lobe; ++i) {
#if defined(SEQUENCE_RANDOM)
        vec2 u = vec2(unit(next_random(state)), unit(next_random(state)));
#else
        uvec2 bits = texelFetch(sequence, int(i)).xy ^ shift;
        vec2 u = vec2(unit(bits.x), unit(bits.y));
#endif
        vec3 wi, weight;
        vec2 density;
        if (sample_lobe(wo, view, u, wi, weight, density)) {
            vec4 light = light_from(frame * wi);
#if defined(SAMPLER_COMBINED)
            // Balance heuristic (Veach 1997).
            weight *= share * density.x / (density.x + map_odds * light.a * density.y);
#endif
            vec3 value = weight * light.rgb;
            float l = luminance(value);
            sum += vec4(value, l * l);
        }
        ++drawn;
#if defined(SAMPLER_COMBINED)
        if (i < from_map) {
            vec4 point = texelFetch(map_points, 2 * (map_start + int(i)));
            wi = point.xyz * frame;
            if (wi.z > 0.0) {
                vec4 light = texelFetch(map_points, 2 * (map_start + int(i)) + 1);
                vec3 value = evaluate_lobe(wo, view, wi, density) * light.rgb;
                float odds = map_odds * light.a * density.y;
                value *= map_share * point.w * odds / (density.x + odds);
                float l = luminance(value);
                sum += vec4(value, l * l);
            }
            ++drawn;
        }
#endif
    }
    uint before = part == 0u ? 0u : imageLoad(sample_counts, at).r;
    vec4 former = before == 0u ? vec4(0) : imageLoad(radiances, at);
    uint total = before + drawn;
    imageStore(radiances, at, (former * float(before) + sum) / float(total));
    imageStore(sample_counts, at, uvec4(total));
}
