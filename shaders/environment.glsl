// Light from a map: lookups of it, and what the passes ask of it (src/lights/light.h). Of the samplers, "cut" sums what is bright over a
// cut through a tree (shaders/cut.glsl) and leaves the rest to the lobe's samples.

#if !defined(PASS_PREDICT) && !defined(PASS_CLASSIFY)
layout(binding = 0) uniform sampler2D map;  // RGB: radiance, in EnvironmentLight::unit(); alpha: the map sampler's density, 1/steradian

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

#endif

// From the map's unit to the frame's (Lights::unit).
uniform float environment_scale;

#if defined(PASS_BACKGROUND)

vec3 environment_seen(vec3 direction) { return environment_scale * light_from(direction).rgb; }

#elif defined(PASS_CLASSIFY)

// Terminator test for bright sources that are texels of the map (EnvironmentLight::sources), each a direction and the sine of the half angle
// that it fills: whether one is neither above two surfaces' horizons as a whole nor below both.
#if BRIGHT_SOURCES > 0
uniform vec4 bright_sources[BRIGHT_SOURCES];
#endif

bool environment_sets_between(vec3 one, vec3 other) {
    bool between = false;
#if BRIGHT_SOURCES > 0
    for (int k = 0; k < BRIGHT_SOURCES; ++k) {
        vec2 sines = vec2(dot(one, bright_sources[k].xyz), dot(other, bright_sources[k].xyz));
        between = between || !all(greaterThan(sines, vec2(bright_sources[k].w))) && !all(lessThan(sines, vec2(-bright_sources[k].w)));
    }
#endif
    return between;
}

#elif defined(PASS_PREDICT)

layout(binding = 13) uniform sampler2D moments;  // octahedral: means of L, L^2, L nu_a
uniform float map_density;                       // the map's sampling density is this times its radiance, 1/steradian
uniform float footprint_level;                   // log2 of the moments' side, squared, over 4 pi: turns steradians into texels

// map_variance: of the map's samples, in parts of the square of what they add up to.
#if defined(SAMPLER_CUT)
const float map_variance = 0.3;
#elif defined(SAMPLER_COMBINED)
const float map_variance = 0.1;
#else
const float map_variance = 0.0;
#endif

void environment_predict(Point point, inout Predicted sum) {
    float weights = 0.0, second = 0.0, printed = 0.0, from_lobe = 0.0;
    for (int i = 0; i < pilot_count; ++i) {
        vec4 a = texelFetch(pilots, 2 * (point.first_pilot + i)), b = texelFetch(pilots, 2 * (point.first_pilot + i) + 1);
        if (a.w == 0.0) continue;
        vec3 wi = 2.0 * dot(point.wo, a.xyz) * a.xyz - point.wo;
        float steradians = b.z;  // log2
#if defined(HIDES_LIGHT)
        steradians = min(steradians, log2(pi * wi.z * wi.z));  // no wider than it is high: texels_above_horizon
#endif
        float level = max(0.0, 0.5 * (steradians + footprint_level));
        vec3 light = textureLod(moments, octahedral(point.frame * wi), level).xyz;
        if (light.x <= 0.0) continue;
        float light_bandwidth = light.z / light.x;
        // Mean square of f cos L / density over the footprint. Where the map is sampled too, the lobe's sampler keeps a part; the map's
        // density follows the radiance, and that of the light that matters is its mean square over its mean.
        float light_density = map_density * light.y / light.x;
        light.xy *= vec2(environment_scale, environment_scale * environment_scale);
        float lambda = light.x * a.w;
        sum.weighted += lambda * bandwidth_at_eye(point, light_bandwidth, b.y);
        weights += lambda;
#if defined(SAMPLER_CUT)
        float part = 1.0 / (1.0 + 4.0 * pi * light_density);
#elif defined(SAMPLER_COMBINED)
        float part = b.w / (b.w + light_density * MAP_WORTH);
#else
        const float part = 1.0;
#endif
        second += light.y * a.w * a.w * part * part;
        from_lobe += lambda * part;
        printed += (min(light_bandwidth, point.frequency_limit) + min(b.y, point.frequency_limit)) * b.x * light.y;
    }
    // What is left to the map's sampler varies less: its clusters or its cut know where it comes from.
    float mean = weights / pilot_count, lobe_mean = from_lobe / pilot_count, map_mean = mean - lobe_mean;
    sum.weights += weights;
    sum.mean += mean;
    sum.printed += printed;
    sum.variance += lobe_share * (max(0.0, second / pilot_count - lobe_mean * lobe_mean) + map_variance * map_mean * map_mean);
}

#elif defined(PASS_SHADE)

#if defined(SAMPLER_COMBINED)
#include "clusters.glsl"
#elif defined(SAMPLER_CUT)
#include "cut.glsl"
#endif

// What a sample of the lobe looks up. footprints, wide: shaders/shade.glsl, light_of_sample.
vec3 environment_of_sample(Pixel pixel, vec3 wi, vec3 direction, vec2 density, float footprints, bool wide) {
#if defined(FILTERED)
    return environment_scale * (wide ? light_of_footprint(direction, wi.z, density, footprints)
                                     : light_for_lobe(direction, wi.z, density, footprints));
#else
    vec4 light = light_from(direction);
#if defined(SAMPLER_COMBINED)
    light *= part_of_lobe(density, light.a);
#endif
    return environment_scale * light.rgb;
#endif
}

void environment_prepare(Pixel pixel) {
#if defined(SAMPLER_COMBINED)
    find_clusters(pixel);
#endif
}

// The map's own samples are among those that the sampler shares out (shaders/shade.glsl, draw).
void environment_samples(Pixel pixel, uvec2 each, inout vec4 sum, inout vec2 luminances, inout uint state) {}

#endif
