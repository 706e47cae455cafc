// Light from a direction: all of it, or the part that a lobe's sample keeps where the map is sampled too.

layout(binding = 0) uniform sampler2D map;  // RGB: radiance; alpha: the density with which the map's sampler draws it, 1/steradian

vec4 light_from(vec3 direction) {
    vec2 uv = latitude_longitude(direction);
#if defined(ENVIRONMENT_NEAREST)
    ivec2 size = textureSize(map, 0);
    return texelFetch(map, min(ivec2(uv * size), size - 1), 0);
#else
    return textureLod(map, uv, 0.0);
#endif
}

#if defined(FILTERED)

// src/scene/light.h, LightLayers.
layout(binding = 13) uniform sampler2DArray light_layers;
uniform float light_unit;

#if defined(SAMPLER_COMBINED)

// The layer that fits a lobe's density, LIGHT_LAYERS and more where none does. density: a fraction, see shaders/lobe.glsl; a table's
// mirror direction has infinite density.
float light_layer(vec2 density) {
    const float smallest = 1e-37;  // of float's normal range, and a little
    float relative = density.x / max(density.y * (FIRST_CEILING * MAP_WORTH), smallest);
    return max(round(0.5 * log2(max(relative, smallest))), 0.0);
}

// The parts of the light that samples of the lobe and of the map keep; their sum is 1. Beyond the last layer the ceiling follows the
// density itself, as in the balance heuristic.
vec2 split_parts(vec2 density, float layer, float light_density) {
    vec2 parts = layer < float(LIGHT_LAYERS) ? vec2(FIRST_CEILING * exp2(2.0 * layer), light_density)
                                             : vec2(density.x, MAP_WORTH * light_density * density.y);
    return parts / (parts.x + parts.y);
}

#else

float light_layer(vec2 density) { return 0.0; }
vec2 split_parts(vec2 density, float layer, float light_density) { return vec2(1.0, 0.0); }

#endif

// What a sample of the lobe keeps, averaged over its footprint, of which the whole lobe holds that many.
vec3 light_for_lobe(vec3 direction, vec2 density, float footprints) {
    float layer = light_layer(density);
    float reach = abs(direction.x) + abs(direction.y) + abs(direction.z), side = float(textureSize(light_layers, 0).x);
    // Over a footprint, 1 / (footprints density) steradians; a texel covers 4 reach^3 / side^2.
    float texels = side * side * density.y / (4.0 * footprints * reach * reach * reach);
    if (layer < float(LIGHT_LAYERS) && texels > density.x)
        return textureLod(light_layers, vec3(octahedral(direction), layer), 0.5 * log2(texels / density.x)).rgb * light_unit;
    vec4 light = light_from(direction);
    return light.rgb * split_parts(density, layer, light.a).x;
}

#endif
