// The shading integral (eq. 2) of the listed pixels: one invocation a pixel, one part of its samples a dispatch. The samples form
// two independent replicates, drawn alike; their spread says how well the mean is known.
#include "common.glsl"
#include "decision.glsl"
#include "lobe.glsl"
#include "light.glsl"
layout(local_size_x = 64) in;

layout(binding = 1) uniform usamplerBuffer entries;
layout(binding = 5) uniform sampler2D positions;
layout(binding = 6) uniform sampler2D normals;
layout(binding = 7) uniform usampler2D decisions;
#if !defined(SEQUENCE_RANDOM)
layout(binding = 8) uniform usamplerBuffer sequence;  // a (0,2)-sequence, 32 bits a coordinate
#endif
#if defined(SAMPLER_COMBINED)
// src/sampling/map_sampler.h, MapPoint and MapCluster: two vec4 each.
layout(binding = 10) uniform samplerBuffer map_points;
layout(std140, binding = 0) uniform Clusters { vec4 map_clusters[2 * MAP_CLUSTERS]; };
#endif
layout(binding = 0, rgba32f) uniform image2D radiances;      // mean of RGB; mean of squared luminance
layout(binding = 1, r32ui) uniform uimage2D sample_counts;   // samples that went into them
layout(binding = 2, rg32f) uniform image2D spreads;          // half the difference of the replicates' luminances
uniform uint first, count;                                   // part of the list
uniform uint samples[BINS];                                  // for each bin
uniform uint seed;
uniform uint spared;  // a pixel that lacks no more than 2^-spared of what it has goes without: so few would not be stratified

struct Pixel {
    mat3 frame;  // columns: the local frame in world space
    vec3 wo;     // local
    int view;    // of the lobe's tables
};

Pixel pixel_at(ivec2 at) {
    vec3 normal = texelFetch(normals, at, 0).xyz;
    vec3 wo_world = -normalize(texelFetch(positions, at, 0).xyz);
    float cosine = min(dot(normal, wo_world), 1.0);
    return Pixel(local_frame(normal, wo_world), vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine), lobe_view(cosine));
}

vec4 with_square(vec3 value) {
    float l = luminance(value);
    return vec4(value, l * l);
}

#if defined(SAMPLER_COMBINED)

// The map's clusters by what they send to this pixel's eye, as far as the lobe's sampler leaves it to the map's: odds, and what each
// cluster above the horizon gets besides, so that none that may send light goes without.
float cluster_odds[MAP_CLUSTERS];
uvec2 clusters_above;  // a bit for each
float even_odds, all_odds;

const float even_part = 0.1;  // of all samples

void find_clusters(Pixel pixel) {
    // The lobe's own density is f over its albedo.
    float worth = MAP_WORTH * importance_albedo(pixel.view), sum = 0.0;
    clusters_above = uvec2(0);
    for (int k = 0; k < MAP_CLUSTERS; ++k) {
        vec4 cluster = map_clusters[2 * k];
        vec3 wi = cluster.xyz * pixel.frame;
        float odds = 0.0;
        if (wi.z > -cluster.w || cluster.w >= 1.0) {
            // Where the horizon cuts it, the middle of what is above it.
            if (wi.z < cluster.w) wi = normalize(vec3(wi.xy, 0.5 * (wi.z + cluster.w)));
            float f = lobe_importance(pixel.view, wi), density = worth * map_clusters[2 * k + 1].x;
            if (f > 0.0) odds = density / (1.0 + density / f);
            clusters_above[k >> 5] |= 1u << (k & 31);
        }
        cluster_odds[k] = odds;
        sum += odds;
    }
    float count = float(bitCount(clusters_above.x) + bitCount(clusters_above.y));
    even_odds = sum > 0.0 ? sum * even_part / ((1.0 - even_part) * count) : 1.0;
    all_odds = sum + even_odds * count;
}

float odds_of(uint cluster) {
    return cluster_odds[cluster] + ((clusters_above[cluster >> 5] >> (cluster & 31u) & 1u) != 0u ? even_odds : 0.0);
}

#endif

// Sum over n > 0 samples of their values (RGB) and of their squared luminances. which: 0 or 1; the two replicates share nothing.
// total: samples of this replicate, those of former rounds included.
vec4 replicate(Pixel pixel, uint n, uint total, uint which, inout uint state) {
    vec4 sum = vec4(0);
#if !defined(SEQUENCE_RANDOM)
    // A digital shift of each pixel's own keeps the sequence's stratification and makes the mean unbiased.
    uvec2 shift = uvec2(next_random(state), next_random(state));
#endif
#if defined(SAMPLER_COMBINED)
    // Half the samples from the map: of each cluster's points, drawn beforehand, the replicate's half in an order of its own for
    // each pixel. Steps of equal odds choose the clusters.
    const uint cluster_points = MAP_POINTS / MAP_CLUSTERS;
    uint from_map = (n + (next_random(state) >> 31)) / 2u, from_lobe = n - from_map;  // half of an odd number by chance
    uint turn = next_random(state), cluster = 0u, drawn_here = 0u;
    const float share = 2.0;  // of all samples for each of one sampler
    float offset = unit(next_random(state)), odds_here = odds_of(0u), odds_below = odds_here;
#else
    const uint from_lobe = n, from_map = 0u;
    const float share = 1.0;
#endif
#if defined(FILTERED)
    float footprints = max(float(total) / share, 1.0);  // parts of the lobe that its samples stand for
#endif
    for (uint i = 0u; i < max(from_lobe, from_map); ++i) {
#if defined(SEQUENCE_RANDOM)
        vec2 u = vec2(unit(next_random(state)), unit(next_random(state)));
#else
        uvec2 bits = texelFetch(sequence, int(i)).xy ^ shift;
        vec2 u = vec2(unit(bits.x), unit(bits.y));
#endif
        vec3 wi, weight;
        vec2 density;
        if (i < from_lobe && sample_lobe(pixel.wo, pixel.view, u, wi, weight, density)) {
#if defined(FILTERED)
            sum += with_square(share * weight * light_for_lobe(pixel.frame * wi, density, footprints));
#else
            vec4 light = light_from(pixel.frame * wi);
#if defined(SAMPLER_COMBINED)
            // Balance heuristic (Veach 1997).
            weight *= share * density.x / (density.x + MAP_WORTH * light.a * density.y);
#endif
            sum += with_square(weight * light.rgb);
#endif
        }
#if defined(SAMPLER_COMBINED)
        if (i < from_map) {
            float place = (float(i) + offset) / float(from_map) * all_odds;
            while (odds_below <= place && cluster + 1u < MAP_CLUSTERS) {
                odds_here = odds_of(++cluster);
                odds_below += odds_here;
                drawn_here = 0u;
                turn = next_random(state);
            }
            float chance = odds_here / all_odds;
            // One sample in each of as many compact parts as samples are expected here; anywhere in that part.
            uint parts = 1u << uint(max(ceil(log2(chance * float(from_map))), 0.0));
            uint within = (drawn_here++ ^ turn) & (parts - 1u) | next_random(state) & ~(parts - 1u);
            within = within & (cluster_points / 2u - 1u) | which * (cluster_points / 2u);
            int index = 2 * int(cluster * cluster_points + within);
            vec4 point = texelFetch(map_points, index);
            wi = point.xyz * pixel.frame;
            if (wi.z > 0.0 && chance > 0.0) {
                vec4 light = texelFetch(map_points, index + 1);
                vec3 value = evaluate_lobe(pixel.wo, pixel.view, wi, density) * light.rgb;
#if defined(FILTERED)
                float part = split_parts(density, light_layer(density), light.a).y;
#else
                float odds = MAP_WORTH * light.a * density.y, part = odds / (density.x + odds);
#endif
                sum += with_square(value * (share * point.w / (chance * float(MAP_CLUSTERS)) * part));
            }
        }
#endif
    }
    return sum;
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint entry = texelFetch(entries, int(first + gl_GlobalInvocationID.x)).r;
    ivec2 at = ivec2(entry & 0xffffu, entry >> 16);
    uint had = imageLoad(sample_counts, at).r, wanted = samples[bin_of(texelFetch(decisions, at, 0).r)];
    if (wanted <= had + (had >> spared)) return;
    uint total = min(wanted, had + uint(PART_SAMPLES));
    // The first replicate holds the odd sample. One sample alone has no spread; it is taken to be as uncertain as it is bright.
    uvec2 had_each = uvec2((had + 1u) / 2u, had / 2u), each = uvec2((total + 1u) / 2u, total / 2u);

    vec4 former = had > 0u ? imageLoad(radiances, at) : vec4(0);
    float former_spread = had > 1u ? imageLoad(spreads, at).r : 0.0, former_luminance = luminance(former.rgb);
    vec2 luminances = vec2(had_each) * (had > 1u ? former_luminance + former_spread * vec2(2, -2) * vec2(had_each.yx) / float(had)
                                                 : vec2(former_luminance));
    Pixel pixel = pixel_at(at);
#if defined(SAMPLER_COMBINED)
    find_clusters(pixel);
#endif
    uint state = hash(entry ^ hash(seed ^ hash(had)));
    vec4 sum = former * float(had);
    for (uint which = 0u; which < 2u; ++which) {
        uint n = each[which] - had_each[which];
        if (n == 0u) continue;
        vec4 drawn = replicate(pixel, n, each[which], which, state);
        luminances[which] += luminance(drawn.rgb);
        sum += drawn;
    }
    vec4 mean = sum / float(total);
    luminances /= vec2(max(each, uvec2(1)));
    imageStore(radiances, at, mean);
    imageStore(spreads, at, vec4(total > 1u ? 0.5 * (luminances.x - luminances.y) : luminance(mean.rgb), 0, 0, 0));
    imageStore(sample_counts, at, uvec4(total));
}
