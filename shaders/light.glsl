// Light from a direction: all of it, or what the lobe's samples look up where the rest is summed over a cut (shaders/cut.glsl).

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

#if defined(BELOW_CEILINGS)

// The part of the light that lies below a soft ceiling: src/sampling/light_tree.h. map_density: 4 pi times it is the radiance, in
// units of the map's mean.
float part_below(int layer, float map_density) {
    float ceiling = FIRST_CEILING * exp2(2.0 * float(layer));
    return ceiling / (ceiling + 4.0 * pi * map_density);
}

#else

float part_below(int layer, float map_density) { return 1.0; }

#endif

#if defined(FILTERED)

layout(binding = 13) uniform sampler2DArray footprint_light;  // shaders/footprint_light.glsl
uniform float light_unit;

#if defined(BELOW_CEILINGS)

// The ceiling that suits a lobe's density, where the balance heuristic weighs a sample of the lobe and CEILING_WORTH of the map alike;
// LIGHT_LAYERS where none is that high. density: a fraction, see shaders/lobe.glsl; a table's mirror direction has infinite density.
int light_layer(vec2 density) {
    const float smallest = 1e-37;  // of float's normal range, and a little
    float relative = 4.0 * pi * density.x / max(density.y * (FIRST_CEILING * CEILING_WORTH), smallest);
    return int(clamp(round(0.5 * log2(max(relative, smallest))), 0.0, float(LIGHT_LAYERS)));
}

#else

int light_layer(vec2 density) { return 0; }

#endif

// Bilinear lookups widen a footprint by about so much: error was least at a half of its area (docs/decisions/0009).
const float footprint_size = 0.5;

// The mean over a sample's footprint, of which the whole lobe holds that many, of what a cut leaves it.
vec3 light_for_lobe(vec3 direction, vec2 density, float footprints) {
    float reach = octahedral_reach(direction), side = float(textureSize(footprint_light, 0).x);
    int layer = light_layer(density);
    // Over a footprint, 1 / (footprints density) steradians; a texel covers 4 reach^3 / side^2.
    float texels = footprint_size * side * side * density.y / (4.0 * footprints * reach * reach * reach);
    if (layer < LIGHT_LAYERS && texels > density.x) {
        vec4 mean = textureLod(footprint_light, vec3(octahedral(direction), layer), 0.5 * log2(texels / density.x));
        return mean.rgb * (light_unit / mean.a);
    }
    vec4 light = light_from(direction);
    return layer < LIGHT_LAYERS ? light.rgb * part_below(layer, light.a) : light.rgb;
}

#endif
