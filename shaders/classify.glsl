// Which pixels are shaded, and how much each deserves: a histogram from which the host plans the sample budget.
#include "common.glsl"
#include "covered.glsl"
#include "decision.glsl"
#if defined(INTERPOLATE)
#include LIGHT_FILES
#include "parents.glsl"
layout(binding = 0, r8ui) readonly uniform uimage2D levels;
#if defined(SHARES_FOLLOW_VARIANCE)
layout(binding = 1, r32f) readonly uniform image2D variances;
#endif
layout(binding = 4, rgba16) writeonly uniform image2D weights;  // of the parents; 0: they say nothing of this pixel
uniform uint pyramid_rows[PYRAMID_LEVELS];  // where each level starts
uniform int coarsest_level;
#else
#include "surface.glsl"
layout(binding = 2) uniform usampler2D materials;
#endif
layout(binding = 3) uniform usamplerBuffer brdf_of;
#if defined(PREDICTED)
const float saturated = 0.5;  // bandwidth, cycles per pixel: no lattice is fine enough
#include "contrast.glsl"
layout(binding = 4) uniform sampler2D bandwidth;
layout(binding = 5) uniform sampler2D prediction;
#endif
#if defined(INTERPOLATE)
#include "chosen_pixels.glsl"
#endif
#if defined(FURTHER_ROUND)
layout(binding = 6) uniform usampler2D previous_bins;  // of pixels that former rounds shaded, by what they measured
uniform int new_pixel_steps;  // of the others, above what is predicted
#endif
layout(binding = 2, r8ui) writeonly uniform uimage2D decisions;
layout(binding = 3, r32ui) readonly uniform uimage2D sample_counts;  // of former rounds
layout(binding = 0, std430) buffer Counts {
    uint bent, saturated;
    uint histogram[];  // (BRDF slot * 2 + whether a former round shaded it) * BINS + bin
} counts;

void shade(ivec2 at, uint material, int bin, bool previous, bool validation) {
    imageStore(decisions, at, uvec4(first_bin + uint(bin) | (validation ? validation_bit : 0u)));
    uint slot = texelFetch(brdf_of, int(material)).r;
    atomicAdd(counts.histogram[(slot * 2u + uint(previous)) * BINS + bin], 1u);
}

#if defined(INTERPOLATE)

float expected_at(ivec2 at) { return texelFetch(prediction, at, 0).g; }

// Least level and, where shares follow it, largest variance over the blocks that meet at a lattice point: all that its parents enclose.
void around_lattice_point(ivec2 at, int level, out int least, inout float variance) {
    ivec2 size = textureSize(materials, 0);
    ivec2 level_size = (size + (1 << level) - 1) >> level;
    ivec2 block = at >> level;
    uint low = 255u;
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 from = block - ivec2(corner & 1, corner >> 1);
        if (any(lessThan(from, ivec2(0))) || any(greaterThanEqual(from, level_size))) continue;
        from.y += int(pyramid_rows[level]);
        low = min(low, imageLoad(levels, from).r);
#if defined(SHARES_FOLLOW_VARIANCE)
        variance = max(variance, imageLoad(variances, from).r);
#endif
    }
    least = int(low);
}

// The weights of the parents of a pixel, where there are enough of them, evenly around it; else 0. sound: it may be interpolated from them.
// None of them (those at the far edges lie outside the blocks around the pixel) nor it asks for a finer spacing than theirs, none lies
// beyond a lamp's horizon, and the pilots do not contradict it. Else their sum is `doubtful`, not 1.
vec4 weights_of_parents(ivec2 at, int level, float pixel_level, out bool sound) {
    Parents parents = parents_of(at, level, pixel_level);
    sound = false;
    if (!parents.balanced) return vec4(0);
    sound = int(pixel_level) > level;
    float between = 0.0;
    vec3 normal = surface_at(at).normal;
    for (int corner = 0; corner < 4; ++corner) {
        if (parents.weight[corner] <= 0.0) continue;
        sound = sound && int(imageLoad(levels, parents.at[corner]).r) > level;
        sound = sound && !LIGHTS_SET_BETWEEN(normal, surface_at(parents.at[corner]).normal);
        between += parents.weight[corner] * expected_at(parents.at[corner]);
    }
    sound = sound && abs(relative_contrast(expected_at(at), between)) <= tolerance;
    return (sound ? 1.0 : doubtful) * vec4(parents.weight[0], parents.weight[1], parents.weight[2], parents.weight[3]);
}

#endif

#if defined(PREDICTED)

// Log2 of the share of samples. That the prediction saw no light is no proof that there is none (a table with black parts): such a pixel
// counts as one of relative variance 1. Least error: the sum over pixels of area * variance / N is least for N
// proportional to sqrt(area * variance), the area being the number of pixels for which the pixel stands. Constant variance (section
// 2.4): N proportional to the variance. Footprints leave little of a variance, the less the larger it is: of a cut, error was least where
// pixels have alike (docs/decisions/0009).
int share(float variance, float area) {
    if (variance <= 0.0) variance = 1.0;
#if defined(ALLOCATION_CONSTANT_VARIANCE)
    float octave = log2(variance);
#else
    float octave = 0.5 * log2(area);
#if defined(SHARES_FOLLOW_VARIANCE)
    octave += 0.5 * log2(variance);
#endif
#endif
    return clamp(int(round(octave * BINS_PER_OCTAVE)) + SHARE_ONE, 0, BINS - 1);
}

#endif

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint material = texelFetch(materials, at, 0).r;
    bool previous = imageLoad(sample_counts, at).r > 0u;
    if (is_bent(at)) atomicAdd(counts.bent, 1u);
    int bin = SHARE_ONE;
    bool chosen = false, interpolate = false;
#if defined(PREDICTED)
    if (texelFetch(bandwidth, at, 0).b >= saturated) atomicAdd(counts.saturated, 1u);
    float variance = relative_variance(texelFetch(prediction, at, 0).rg, mean_radiance), area = 1.0;
#if defined(INTERPOLATE)
    chosen = is_chosen(at);
    int level = lattice_level(at, coarsest_level), least;
    around_lattice_point(at, level, least, variance);
    uint own = imageLoad(levels, at).r;
    area = exp2(2.0 * float(min(level, int(own))));
    // Shaded pixels have weights, too: they show a mean of their own value and of what their parents say (src/frame/combine.h). Bandwidths
    // that are saturated tell of creases.
    bool sound = false;
    vec4 weight = level < coarsest_level && texelFetch(bandwidth, at, 0).b < saturated ? weights_of_parents(at, level, float(own), sound) : vec4(0);
    if (sound && least <= level) {
        sound = false;  // shaded since a pixel near it needs a finer spacing
        weight *= doubtful;
    }
    imageStore(weights, at, weight);
    interpolate = sound && (chosen || !previous);
#endif
    bin = share(variance, area);
#endif
#if defined(FURTHER_ROUND)
    bin = previous ? int(texelFetch(previous_bins, at, 0).r) : clamp(bin + new_pixel_steps, 0, BINS - 1);
#endif
    if (interpolate && !chosen)
        imageStore(decisions, at, uvec4(interpolate_it));
    else
        shade(at, material, bin, previous, interpolate);
}
