// The shading integral (eq. 2) of the listed pixels: one invocation a pixel, one part of its samples a dispatch. The samples form
// two replicates, drawn alike; their spread says how well the mean is known.
#include "common.glsl"
#include "decision.glsl"
#include "lobe.glsl"
#include "surface.glsl"
layout(local_size_x = SHADE_GROUP) in;

layout(binding = 1) uniform usamplerBuffer entries;
layout(binding = 7) uniform usampler2D decisions;
layout(binding = 0, rgba32f) uniform image2D radiances;      // mean of RGB; mean of squared luminance
layout(binding = 1, r32ui) uniform uimage2D sample_counts;   // samples that went into them; `unfinished` between two parts
layout(binding = 2, rgba32f) uniform image2D spreads;        // half the difference of the replicates' luminances
uniform uint first, count;                                   // part of the list
uniform uint samples[BINS];                                  // for each bin
uniform uint seed;
uniform uint part;    // PART_SAMPLES of each pixel were drawn in every part before this one

struct Pixel {
    mat3 frame;  // columns: the local frame in world space
    Lobe lobe;   // local
};

Pixel pixel_at(ivec2 at) {
    vec3 normal = surface_at(at).normal, wo_world = towards_eye(at);
    float cosine = min(dot(normal, wo_world), 1.0);
    return Pixel(local_frame(normal, wo_world), lobe_towards(vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine)));
}

vec4 with_square(vec3 value) {
    float l = luminance(value);
    return vec4(value, l * l);
}

// A cone of directions around wi with that sine of its half angle (1: a hemisphere or more) reaches above the horizon; and the middle
// of what does.
bool may_be_above(vec3 wi, float sine) { return wi.z > -sine || sine >= 1.0; }
vec3 middle_above(vec3 wi, float sine) { return wi.z < sine ? normalize(vec3(wi.xy, 0.5 * (wi.z + sine))) : wi; }

// Point i of n of the lattice of the golden ratio under a shift of each pixel's own: even points, a mean without bias.
vec2 lattice_point(uint i, uint n, float offset, uint turn) {
    const uint golden_ratio = 2654435769u;  // its fraction in 32 bits
    const float below_one = 0.99999994;
    return vec2(min((float(i) + offset) / float(n), below_one), unit(i * golden_ratio + turn));
}

#include LIGHT_FILES

const uint unfinished = 0x80000000u;

#if defined(FILTERED)
// What a lattice errs, in parts of half the difference of its halves; and a cut, in parts of what it differs from one of half its
// size: so that the squares of both add up to the squared error (docs/decisions/0009: to a third either way). Halves of random points
// are independent.
#if defined(SEQUENCE_RANDOM)
const float lattice_share = 1.0;
#else
const float lattice_share = 0.74;
#endif
const float cut_share = 0.55;
// The doubt that the coarser cut may cast on the finer, in parts of what the pixel shows: it alone may have hit a peak.
const float most_doubt = 0.5;
#endif

// What a sample of the lobe brings: RGB. footprints: parts of the lobe that its samples stand for; wide: none is a lookup of the map.
vec3 light_of_sample(Pixel pixel, vec2 u, float footprints, bool wide) {
    vec3 wi, weight;
    vec2 density;
    if (!sample_lobe(pixel.lobe, u, wi, weight, density)) return vec3(0);
    vec3 direction = pixel.frame * wi;
    return weight * LIGHTS_OF_SAMPLE(pixel, wi, direction, density, footprints, wide);
}

// A sum over samples: of RGB and squared luminance; and of every other one's luminance.
struct Sum {
    vec4 all;
    float odd;
};

void add(inout Sum sum, uint i, vec3 light) {
    sum.all += with_square(light);
    if ((i & 1u) != 0u) sum.odd += luminance(light);
}

// Sum over n samples of the lobe; share: of all samples for each of these.
Sum sample_lobes(Pixel pixel, uint n, float footprints, float share, inout uint state) {
    Sum sum = Sum(vec4(0), 0.0);
    uint i = 0u;
#if defined(SEQUENCE_RANDOM)
    for (; i < n; ++i) {
        vec2 u = vec2(unit(next_random(state)), unit(next_random(state)));
        add(sum, i, share * light_of_sample(pixel, u, footprints, false));
    }
#else
    uint turn = next_random(state);
    float offset = unit(next_random(state));
#if defined(FILTERED)
    // Software renderers may run both sides of every branch: what only the densest samples need has a loop of its own
    // (docs/decisions/0011). It runs once at least.
    uint dense = clamp(uint(ceil(part_denser_than(pixel.lobe, density_of_map(footprints)) * float(n))), 1u, n);
    for (; i < dense; ++i) add(sum, i, share * light_of_sample(pixel, lattice_point(i, n, offset, turn), footprints, false));
#endif
    for (; i < n; ++i) add(sum, i, share * light_of_sample(pixel, lattice_point(i, n, offset, turn), footprints, true));
#endif
    return sum;
}

// Adds samples to a sum of their values (RGB) and of their squared luminances, and to the luminances of the two replicates.
// each: how many of either; total: of the pixel, those of parts before included.
#if defined(FILTERED)
// Footprints are to meet without gaps: the replicates are the even and the odd points of one lattice, which differ by more than the
// whole errs.
void draw(Pixel pixel, uvec2 each, uint total, inout vec4 sum, inout vec2 luminances, inout uint state) {
    uint n = each.x + each.y, from_lobe = n;
    float footprints = float(total);
#if defined(SAMPLER_CUT)
    if (n > 2u) from_lobe = (n + 1u) / 2u;  // as many again are parts of the cut
    footprints *= 0.5;
#endif
    Sum drawn = sample_lobes(pixel, from_lobe, footprints, 1.0, state);
    sum += drawn.all * (float(n) / float(from_lobe));
    vec2 lobes = vec2((from_lobe + 1u) / 2u, max(from_lobe / 2u, 1u));
    luminances += vec2(each) / lobes * vec2(luminance(drawn.all.rgb) - drawn.odd, drawn.odd);
}
#else
// Two that share nothing.
void draw(Pixel pixel, uvec2 each, uint total, inout vec4 sum, inout vec2 luminances, inout uint state) {
    for (uint which = 0u; which < 2u; ++which) {
        uint n = each[which];
        if (n == 0u) continue;
#if defined(SAMPLER_COMBINED)
        uint from_map = (n + (next_random(state) >> 31)) / 2u;  // half of an odd number by chance
        vec4 drawn = sample_lobes(pixel, n - from_map, 0.0, 2.0, state).all + sample_clusters(pixel, from_map, 2.0, which, state);
#else
        vec4 drawn = sample_lobes(pixel, n, 0.0, 1.0, state).all;
#endif
        sum += drawn;
        luminances[which] += luminance(drawn.rgb);
    }
}
#endif

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint entry = texelFetch(entries, int(first + gl_GlobalInvocationID.x)).r;
    ivec2 at = ivec2(entry & 0xffffu, entry >> 16);
    uint wanted = samples[bin_of(texelFetch(decisions, at, 0).r)], stored = imageLoad(sample_counts, at).r;
    uint had = part * uint(PART_SAMPLES), total = min(wanted, had + uint(PART_SAMPLES));
    // What a former round drew stays, or is drawn anew (src/picture/budget.h).
    if (part == 0u ? wanted < LEAST_RESAMPLING_FACTOR * stored : stored != (had | unfinished)) return;
    // The first replicate holds the odd sample. One sample alone has no spread; it is taken to be as uncertain as it is bright.
    uvec2 had_each = uvec2((had + 1u) / 2u, had / 2u), each = uvec2((total + 1u) / 2u, total / 2u);

    vec4 previous = had > 0u ? imageLoad(radiances, at) : vec4(0);
    float former_spread = had > 0u ? imageLoad(spreads, at).r : 0.0;
    vec2 luminances = vec2(had_each) * (luminance(previous.rgb) + former_spread * vec2(1, -1));
    Pixel pixel = pixel_at(at);
    LIGHTS_PREPARE(pixel)
    uint state = hash(entry ^ hash(seed ^ hash(had)));
    vec4 sum = previous * float(had);
    draw(pixel, each - had_each, total, sum, luminances, state);
    LIGHTS_SAMPLES(pixel, each - had_each, sum, luminances, state)
    vec4 mean = sum / float(total);
    luminances /= vec2(max(each, uvec2(1)));
    float spread = total > 1u ? 0.5 * (luminances.x - luminances.y) : luminance(mean.rgb);
#if defined(FILTERED)
    if (total == wanted) spread *= lattice_share;
#endif
#if defined(SAMPLER_CUT)
    if (total == wanted) {
        // Half the samples vary: so each of them all stands for twice their variance.
        float l = luminance(mean.rgb), variance = 2.0 * max(mean.a - l * l, 0.0), coarser;
        vec3 above = light_above(pixel, 0.5 * float(wanted), coarser);
        mean.rgb += above;
        l = luminance(mean.rgb);
        float difference = cut_share * clamp(coarser - luminance(above), -most_doubt * l, most_doubt * l);
        mean.a = l * l + variance + float(wanted) * difference * difference;
        spread += difference;
    }
#endif
    imageStore(spreads, at, vec4(spread, 0, 0, 0));
    imageStore(radiances, at, mean);
    imageStore(sample_counts, at, uvec4(total < wanted ? total | unfinished : total));
}
