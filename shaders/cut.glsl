// The light above the soft ceiling, summed over a cut through its tree (docs/decisions/0009): every part of the cut counts as if all
// its light came from its centre. The cut is fine where much light and a bright lobe meet in a wide part.

// src/sampling/light_tree.h, LightPart: a direction, and a flux for each ceiling.
layout(binding = 10) uniform samplerBuffer light_parts;
const int part_size = 1 + LIGHT_LAYERS;
layout(std140, binding = 0) uniform Trunk { vec4 trunk[2 * TRUNK_PARTS]; };

// RGB; size: the parts that the cut is to have, about.
vec3 light_above(Pixel pixel, float size) {
    // The error of a part that is halved d times falls as 2^-d; in proportion to the square root of what it would be, all errors
    // together are least.
    float wishes[TRUNK_PARTS], sum = 0.0;
    uint seen[TRUNK_PARTS], seen_count = 0u;
    for (int k = 0; k < TRUNK_PARTS; ++k) {
        vec4 part = trunk[2 * k];
        vec3 wi = part.xyz * pixel.frame;
        if (may_be_above(wi, part.w)) {
            float wish = sqrt(trunk[2 * k + 1].w * lobe_importance(pixel.view, middle_above(wi, part.w)));
            wishes[seen_count] = wish;
            seen[seen_count++] = uint(k);
            sum += wish;
        }
    }
    float scale = sum > 0.0 ? size / sum : 0.0;
    vec3 light = vec3(0);
    uint k = 0u, place = 0u, end = 0u;
    while (true) {
        if (place == end) {
            if (k == seen_count) break;
            uint halvings = uint(clamp(round(log2(max(scale * wishes[k], 1.0))), 0.0, TREE_DEPTH));
            place = seen[k++] * TREE_HEAP + (1u << halvings);
            end = place + (1u << halvings);
        }
        int index = part_size * int(place);
        vec3 wi = texelFetch(light_parts, index).xyz * pixel.frame;
        if (wi.z > 0.0) {
            vec2 density;
            vec3 value = evaluate_lobe(pixel.wo, pixel.view, wi, density);
            int layer = light_layer(density);
            if (layer < LIGHT_LAYERS) light += value * texelFetch(light_parts, index + 1 + layer).rgb;
        }
        ++place;
    }
    return light;
}
