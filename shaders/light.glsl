// Light from a direction: all of it, or what the lobe's samples look up where the rest is summed over a cut (shaders/cut.glsl).

layout(binding = 0) uniform sampler2D map;  // RGB: radiance, in Light::unit(); alpha: the density with which the map's sampler draws it, 1/steradian

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
uniform float mean_light;

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
// Smaller footprints, in finest texels, are lookups of the map itself: with a quarter of one, errors were as small as with a whole
// one or smaller (docs/decisions/0011), and fewer samples are so narrow.
const float least_texels = 0.25;

// A texel covers 4 reach^3 / side^2 steradians.
float texels_covered(float reach, float steradians) {
    float side = float(textureSize(footprint_light, 0).x);
    return footprint_size * side * side * steradians / (4.0 * reach * reach * reach);
}

// What is drawn less densely than this is no lookup of the map, wherever it comes from.
float density_of_map(float footprints) {
    const float longest_reach = 1.7320508;  // of (1, 1, 1)
    return texels_covered(longest_reach, 1.0 / (least_texels * footprints));
}

// What a surface does not see may be thousands of times as bright: no footprint is wider than it is high (docs/decisions/0014).
float texels_above_horizon(float reach, float height) { return texels_covered(reach, pi * height * height); }

// The mean over a sample's footprint, of which the whole lobe holds that many, of what a cut leaves it. Of a footprint that is smaller
// than a texel, the finest texels. height: sine of the direction above the horizon.
vec3 light_of_footprint(vec3 direction, float height, vec2 density, float footprints) {
    int layer = light_layer(density);
    float reach = octahedral_reach(direction), texels = texels_covered(reach, density.y / footprints) / density.x;
#if defined(HIDES_LIGHT)
    texels = min(texels, texels_above_horizon(reach, height));
#endif
    vec4 mean = textureLod(footprint_light, vec3(octahedral(direction), layer), 0.5 * log2(texels));
    return mean.rgb * (mean_light / mean.a);
}

// The same, where that may be: the map's own light instead.
vec3 light_for_lobe(vec3 direction, float height, vec2 density, float footprints) {
    int layer = light_layer(density);
    float reach = octahedral_reach(direction);
    bool wide = texels_covered(reach, density.y / footprints) > least_texels * density.x;
#if defined(HIDES_LIGHT)
    wide = wide && texels_above_horizon(reach, height) > least_texels;
#endif
    if (layer < LIGHT_LAYERS && wide)
        return light_of_footprint(direction, height, density, footprints);
    vec4 light = light_from(direction);
    return layer < LIGHT_LAYERS ? light.rgb * part_below(layer, light.a) : light.rgb;
}

#endif
