// Which pixels are shaded, and how much each deserves: a histogram from which the host plans the sample budget.
#include "common.glsl"
#include "covered.glsl"
#include "decision.glsl"

layout(binding = 3) uniform usamplerBuffer brdf_of;
#if defined(INTERPOLATE)
#include "parents.glsl"
#include "relative_variance.glsl"
layout(binding = 0, r8ui) readonly uniform uimage2D levels;
layout(binding = 5) uniform sampler2D prediction;
uniform float mean_radiance;  // of the covered pixels, as predicted
uniform float tolerance;      // by how much, relatively, the pilots may contradict interpolation
uniform uint pyramid_rows[PYRAMID_LEVELS];  // where each level starts
uniform int coarsest_level;
uniform uint witnesses;  // how many of 2^32 pixels that may be interpolated are shaded all the same
uniform uint seed;
#else
#include "surface.glsl"
layout(binding = 2) uniform usampler2D materials;
#endif
#if defined(PREDICTED)
layout(binding = 1, r32f) readonly uniform image2D variances;
layout(binding = 4) uniform sampler2D bandwidth;
#endif
#if defined(FURTHER_ROUND)
layout(binding = 6) uniform usampler2D former_bins;  // of pixels that former rounds shaded, by what they measured
#endif
layout(binding = 2, r8ui) writeonly uniform uimage2D decisions;
layout(binding = 3, r32ui) readonly uniform uimage2D sample_counts;  // of former rounds
layout(binding = 0, std430) buffer Counts {
    uint bent, saturated, unused[2];
    uint histogram[];  // (BRDF slot * 2 + whether a former round shaded it) * BINS + bin
} counts;

void shade(ivec2 at, uint material, int bin, bool former, bool witness) {
    imageStore(decisions, at, uvec4(first_bin + uint(bin) | (witness ? witness_bit : 0u)));
    uint slot = texelFetch(brdf_of, int(material)).r;
    atomicAdd(counts.histogram[(slot * 2u + uint(former)) * BINS + bin], 1u);
}

#if defined(INTERPOLATE)

// Least level and largest variance over the blocks that meet at a lattice point: all that its parents enclose.
void around(ivec2 at, int level, out int least, out float variance) {
    ivec2 size = textureSize(materials, 0);
    ivec2 level_size = (size + (1 << level) - 1) >> level;
    ivec2 block = at >> level;
    uint low = 255u;
    variance = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 from = block - ivec2(corner & 1, corner >> 1);
        if (any(lessThan(from, ivec2(0))) || any(greaterThanEqual(from, level_size))) continue;
        from.y += int(pyramid_rows[level]);
        low = min(low, imageLoad(levels, from).r);
        variance = max(variance, imageLoad(variances, from).r);
    }
    least = int(low);
}

// Whether the pixel may be interpolated: enough parents evenly around it, none of which (those at the far edges lie outside the
// blocks around it) needs a finer spacing than theirs; and what the pilots expect here is what lies between their expectations
// there. Bandwidth knows nothing of contrast: beside a rim that shows a lamp, the slightest remainder of it is too much.
bool has_sound_parents(ivec2 at, int level, float pixel_level) {
    Parents parents = parents_of(at, level, pixel_level);
    if (!parents.balanced) return false;
    float between = 0.0, here = texelFetch(prediction, at, 0).g;
    for (int corner = 0; corner < 4; ++corner) {
        if (parents.weight[corner] <= 0.0) continue;
        if (int(imageLoad(levels, parents.at[corner]).r) <= level) return false;
        between += parents.weight[corner] * texelFetch(prediction, parents.at[corner], 0).g;
    }
    return abs(between - here) <= tolerance * (here + dark_part * mean_radiance);
}

#endif

#if defined(PREDICTED)

// Footprints leave little of a variance, the less the larger it is: of a cut, error was least where pixels have alike
// (docs/decisions/0009).
#if defined(SAMPLER_CUT)
const float variance_power = 0.0;
#else
const float variance_power = 0.5;
#endif

// Log2 of the share of samples. Least error: the sum over pixels of area * variance / N is least for N proportional to
// sqrt(area * variance), the area being that which the pixel is interpolated over. Constant variance (section 2.4):
// N proportional to the variance.
int share(float variance, int level) {
    if (variance <= 0.0) return 0;
#if defined(ALLOCATION_CONSTANT_VARIANCE)
    float octave = log2(variance);
#else
    float octave = variance_power * log2(variance) + float(level);
#endif
    return clamp(int(round(octave * BINS_PER_OCTAVE)) + SHARE_ONE, 0, BINS - 1);
}

#endif

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    uint material = texelFetch(materials, at, 0).r;
    bool former = imageLoad(sample_counts, at).r > 0u;
    if (is_bent(at)) atomicAdd(counts.bent, 1u);
    int level = 0, least = 0, bin = SHARE_ONE;
#if defined(PREDICTED)
    if (texelFetch(bandwidth, at, 0).b >= 0.5) atomicAdd(counts.saturated, 1u);
    float variance;
#if defined(INTERPOLATE)
    level = lattice_level(at, coarsest_level);
    around(at, level, least, variance);
    uint own = imageLoad(levels, at).r;
#else
    // Nothing is interpolated from it: its own variance alone counts.
    const uint own = 0u;
    variance = imageLoad(variances, at).r;
#endif
    bin = share(variance, min(level, int(own)));
#endif
#if defined(FURTHER_ROUND)
    if (former) bin = int(texelFetch(former_bins, at, 0).r);
#endif
    bool chosen = false, interpolate = false;
#if defined(INTERPOLATE)
    chosen = hash((uint(at.y) << 16 | uint(at.x)) ^ hash(seed)) < witnesses;
    interpolate = level < coarsest_level && least > level && (chosen || !former);
    if (interpolate) interpolate = has_sound_parents(at, level, float(own));
#endif
    if (interpolate && !chosen)
        imageStore(decisions, at, uvec4(interpolate_it));
    else
        shade(at, material, bin, former, interpolate);
}
