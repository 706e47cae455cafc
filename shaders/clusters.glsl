// Samples of the map: 65,536 directions drawn beforehand, of which a pixel takes those that send light to its eye
// (docs/decisions/0006). A sample's density is half the lobe's and half this: the balance heuristic (Veach 1997).

// src/sampling/map_sampler.h, MapPoint and MapCluster: two vec4 each.
layout(binding = 10) uniform samplerBuffer map_points;
layout(std140, binding = 0) uniform Clusters { vec4 map_clusters[2 * MAP_CLUSTERS]; };

// The map's clusters by what they send to this pixel's eye, as far as the lobe's sampler leaves it to the map's: odds, and what each
// cluster above the horizon gets besides, so that none that may send light goes without.
float cluster_odds[MAP_CLUSTERS];
uvec2 clusters_above;  // a bit for each
float even_odds, all_odds;

const float even_part = 0.1;  // of all samples

void find_clusters(Pixel pixel) {
    // The lobe's own density is f over its albedo.
    float worth = MAP_WORTH * importance_albedo(pixel.lobe.view), sum = 0.0;
    clusters_above = uvec2(0);
    for (int k = 0; k < MAP_CLUSTERS; ++k) {
        vec4 cluster = map_clusters[2 * k];
        vec3 wi = cluster.xyz * pixel.frame;
        float odds = 0.0;
        if (may_be_above(wi, cluster.w)) {
            float f = lobe_importance(pixel.lobe.view, middle_above(wi, cluster.w)), density = worth * map_clusters[2 * k + 1].x;
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

// The part of a sample of the lobe that the balance heuristic leaves it. density: of the lobe's sampler, a fraction.
float part_of_lobe(vec2 density, float map_density) { return density.x / (density.x + MAP_WORTH * map_density * density.y); }

// Sum over n samples of their values (RGB) and of their squared luminances, of each cluster's points the replicate's half in an order
// of its own for each pixel. Steps of equal odds choose the clusters. share: of all samples for each of these.
vec4 sample_clusters(Pixel pixel, uint n, float share, uint which, inout uint state) {
    const uint cluster_points = MAP_POINTS / MAP_CLUSTERS;
    vec4 sum = vec4(0);
    uint turn = next_random(state), cluster = 0u, drawn_here = 0u;
    float offset = unit(next_random(state)), odds_here = odds_of(0u), odds_below = odds_here;
    for (uint i = 0u; i < n; ++i) {
        float place = (float(i) + offset) / float(n) * all_odds;
        while (odds_below <= place && cluster + 1u < MAP_CLUSTERS) {
            odds_here = odds_of(++cluster);
            odds_below += odds_here;
            drawn_here = 0u;
            turn = next_random(state);
        }
        float chance = odds_here / all_odds;
        // One sample in each of as many compact parts as samples are expected here; anywhere in that part.
        uint parts = 1u << uint(max(ceil(log2(chance * float(n))), 0.0));
        uint within = (drawn_here++ ^ turn) & (parts - 1u) | next_random(state) & ~(parts - 1u);
        within = within & (cluster_points / 2u - 1u) | which * (cluster_points / 2u);
        int index = 2 * int(cluster * cluster_points + within);
        vec4 point = texelFetch(map_points, index);
        vec3 wi = point.xyz * pixel.frame;
        if (wi.z > 0.0 && chance > 0.0) {
            vec4 light = texelFetch(map_points, index + 1);
            vec2 density;
            vec3 value = evaluate_lobe(pixel.lobe, wi, density) * light.rgb * environment_scale;
            float part = 1.0 - part_of_lobe(density, light.a);
            sum += with_square(value * (share * point.w / (chance * float(MAP_CLUSTERS)) * part));
        }
    }
    return sum;
}
