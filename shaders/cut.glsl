// The light above the soft ceiling, summed over a cut through its tree (docs/decisions/0009): every part of the cut counts as if all
// its light came from its centre. The cut is fine where much light and a bright lobe meet in a wide part.

// src/sampling/light_tree.h, LightPart: a direction, and a flux for each ceiling.
layout(binding = 10) uniform samplerBuffer light_parts;
const int part_size = 1 + LIGHT_LAYERS;
layout(std140, binding = 0) uniform Trunks { vec4 trunk[2 * (TRUNK_PARTS + COARSE_TRUNK_PARTS)]; };

// A part is halved further where, by the lobe at its centre, it alone brings more of what the pixel may expect than so many average
// parts; among few parts, more than a quarter of all that is expected.
const float surprising = 16.0, surprising_share = 0.25;
// Importance is tabulated coarsely: where the table holds 0 at a part's centre, the part may still reach into a bright piece of the lobe.
// So this fraction of the parts is given out as if the lobe were even (Hesterberg 1995, defensive mixture), and with its size every cut
// becomes fine everywhere.
const float defensive_fraction = 1.0 / 8.0;
// Near the horizon, by so much sine or its own width, a part's centre says little: half of the part may lie below, and measured tables
// vary from cell to cell (a cell of a MERL table is a degree or two wide). There it may bring what the lobe's greatest value would.
const float grazing = 0.03;

// RGB; size: the parts that the cut is to have, about. coarser: the luminance of a cut of half as many.
vec3 light_above(Pixel pixel, float size, out float coarser) {
    // Halved d times, a part errs 2^-d times as much; errors are least together where d follows the square root of what they are.
    float priorities[TRUNK_PARTS], sum = 0.0, even = 0.0, expected = 0.0;
    uint seen[TRUNK_PARTS], seen_count = 0u;
    bool coarse = size < float(COARSE_TRUNK_PARTS);
    int first = coarse ? TRUNK_PARTS : 0, last = first + (coarse ? COARSE_TRUNK_PARTS : TRUNK_PARTS);
    for (int k = first; k < last; ++k) {
        vec4 part = trunk[2 * k];
        vec3 wi = part.xyz * pixel.frame;
        if (may_be_above(wi, part.w)) {
            vec4 flux = trunk[2 * k + 1];
            float importance = lobe_importance(pixel.lobe.view, middle_above(wi, part.w));
            float priority = sqrt(flux.w * importance);
            priorities[seen_count] = priority;
            seen[seen_count++] = uint(k);
            sum += priority;
            even += sqrt(flux.w);
            expected += luminance(flux.rgb) * importance;
        }
    }
    float scale = sum > 0.0 ? (1.0 - defensive_fraction) * size / sum : 0.0;
    float even_scale = even > 0.0 ? defensive_fraction * size / even : 0.0;
    float too_much = min(surprising / size, surprising_share) * expected;
    vec3 light = vec3(0);
    // One loop over all parts of both cuts, so that neighbours run equally long. place, depth: of a part in its heap; wanted: the
    // depth of the cut there; start: that of the coarser cut.
    uint k = 0u, trunk_part = 0u, wanted = 0u, start = 0u, depth = 0u, place = 2u;
    coarser = 0.0;
    bool halved = false;
    while (true) {
        if (place == 2u << start && depth == start) {
            if (k == seen_count) break;
            float parts = max(scale * priorities[k], even_scale * sqrt(trunk[2 * int(seen[k]) + 1].w));
            wanted = uint(clamp(round(log2(max(parts, 1.0))), 0.0, float(TREE_DEPTH)));
            start = depth = max(wanted, 1u) - 1u;
            trunk_part = seen[k++];
            place = 1u << start;
        }
        int index = part_size * int(place * uint(TRUNK_PARTS + COARSE_TRUNK_PARTS) + trunk_part);  // LightTree::index
        vec4 part = texelFetch(light_parts, index);
        vec3 wi = part.xyz * pixel.frame, value = vec3(0);
        int layer = 0;
        if (wi.z > 0.0) {
            vec2 density;
            value = evaluate_lobe(pixel.lobe, wi, density);
            layer = light_layer(density);
        }
        vec4 flux = layer < LIGHT_LAYERS ? texelFetch(light_parts, index + 1 + layer) : vec4(0);
        float brightness = luminance(value);
        if (abs(wi.z) < part.w + grazing) brightness = max(brightness, lobe_peak(pixel.lobe.view, middle_above(wi, part.w)));
        bool surprises = too_much > 0.0 && luminance(flux.rgb) * brightness > too_much;
        // The coarser cut has the parts at which this one starts; of one that surprises, its halves.
        if (depth == start) halved = surprises;
        if (depth == start + uint(halved)) coarser += luminance(value * flux.rgb);
        if (depth < wanted || depth < TREE_DEPTH && surprises) {
            place *= 2u;
            ++depth;
            continue;
        }
        light += value * flux.rgb;
        // The next part; after a second half, that after the whole.
        ++place;
        uint up = min(uint(findLSB(place)), depth - start);
        place >>= up;
        depth -= up;
    }
    coarser *= environment_scale;
    return environment_scale * light;
}
