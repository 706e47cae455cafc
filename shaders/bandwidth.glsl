// The bandwidth buffer (section 3.1): per pixel the bandwidth of the light arriving there (eq. 5), its image bandwidth
// (eq. 6) and the predicted variance of a light sample (eq. 9).
#include "common.glsl"
#include "covered.glsl"
#include "surface.glsl"
#include "transport.glsl"
#include "views.glsl"

layout(binding = 2) uniform usampler2D materials;
layout(binding = 3) uniform sampler2D moments;       // octahedral: means of L, L^2, L nu_a
layout(binding = 4) uniform samplerBuffer pilots;    // src/sampling/pilots.h: two vec4 each
layout(binding = 5) uniform usamplerBuffer brdf_of;  // instance number + 1 -> BRDF slot

layout(binding = 0, rgba32f) writeonly uniform image2D bandwidth;   // spatial, angular, image, curvature
layout(binding = 1, rg32f) writeonly uniform image2D prediction;    // variance of one sample, mean radiance (luminance)

uniform int pilot_count;
uniform float radians_per_pixel;
uniform float map_density;      // the map's sampling density is this times its radiance, 1/steradian
uniform float footprint_level;  // log2 of the moments' side, squared, over 4 pi: turns steradians into texels

const float nyquist = 0.5;      // cycles per pixel: what the finest level can show

// Of the samples, one in lobe_share is the lobe's. map_variance: of the map's, in parts of the square of what they add up to.
#if defined(SAMPLER_CUT)
const float lobe_share = 2.0, map_variance = 0.3;
#elif defined(SAMPLER_COMBINED)
const float lobe_share = 2.0, map_variance = 0.1;
#else
const float lobe_share = 1.0, map_variance = 0.0;
#endif

// Change of position and normal per pixel along one axis, by the side whose normal changes less (the other may lie beyond
// a crease); false where neither neighbour belongs to the same instance.
bool change_along(ivec2 axis, ivec2 at, Surface here, uint material, out vec3 dp, out vec3 dn) {
    bool found = false;
    dp = dn = vec3(0);
    for (int side = -1; side <= 1; side += 2) {
        ivec2 to = at + side * axis;
        if (any(lessThan(to, ivec2(0))) || any(greaterThanEqual(to, textureSize(materials, 0)))) continue;
        if (texelFetch(materials, to, 0).r != material) continue;
        Surface there = surface_at(to);
        vec3 p = (there.position - here.position) * float(side);
        vec3 n = (there.normal - here.normal) * float(side);
        if (!found || dot(n, n) * dot(dp, dp) < dot(dn, dn) * dot(p, p)) { dp = p; dn = n; }
        found = true;
    }
    return found;
}

// Largest principal curvature in magnitude, 1/metre, from the two fundamental forms; negative where the neighbours do not
// span the surface.
float curvature_at(ivec2 at, Surface here, uint material) {
    vec3 px, py, nx, ny;
    if (!change_along(ivec2(1, 0), at, here, material, px, nx) || !change_along(ivec2(0, 1), at, here, material, py, ny)) return -1.0;
    // In units of the pixel's size at this depth, so that no product leaves the range of float in a tiny or huge scene.
    float unit_length = here.depth * radians_per_pixel;
    px /= unit_length;
    py /= unit_length;
    float e = dot(px, px), f = dot(px, py), g = dot(py, py);
    float l = dot(nx, px), m = 0.5 * (dot(nx, py) + dot(ny, px)), n = dot(ny, py);
    float area = e * g - f * f;
    // Steps that are parallel to within float rounding of their products (2^-23, three products) span nothing.
    const float parallel = 1e-6;
    if (!(area > parallel * e * g)) return -1.0;
    float mean = 0.5 * (e * n - 2.0 * f * m + g * l) / area, gauss = (l * n - m * m) / area;
    return (abs(mean) + sqrt(max(mean * mean - gauss, 0.0))) / unit_length;
}

void main() {
    ivec2 at;
    if (!covered_pixel(at)) return;
    Surface here = surface_at(at);
    uint material = texelFetch(materials, at, 0).r;
    float distance_to_eye = length(here.position);
    vec3 wo_world = towards_eye(at);
    mat3 frame = local_frame(here.normal, wo_world);
    float cos_outgoing = dot(here.normal, wo_world);
    vec3 wo = vec3(sqrt(max(0.0, 1.0 - cos_outgoing * cos_outgoing)), 0.0, cos_outgoing);
    float curvature = curvature_at(at, here, material);

    int first = (int(texelFetch(brdf_of, int(material)).r) * LOBE_VIEWS + view_of(cos_outgoing)) * pilot_count;
    float frequency_limit = nyquist / radians_per_pixel;  // cycles/radian at the eye
    vec2 weighted = vec2(0);
    float weights = 0.0, second = 0.0, printed = 0.0, from_lobe = 0.0;
    for (int i = 0; i < pilot_count; ++i) {
        vec4 a = texelFetch(pilots, 2 * (first + i)), b = texelFetch(pilots, 2 * (first + i) + 1);
        if (a.w == 0.0) continue;
        vec3 wi = 2.0 * dot(wo, a.xyz) * a.xyz - wo;
        float steradians = b.z;  // log2
#if defined(HIDES_LIGHT)
        steradians = min(steradians, log2(pi * wi.z * wi.z));  // shaders/light.glsl: no wider than it is high
#endif
        float level = max(0.0, 0.5 * (steradians + footprint_level));
        vec3 light = textureLod(moments, octahedral(frame * wi), level).xyz;
        if (light.x <= 0.0) continue;
        float light_bandwidth = light.z / light.x;
        float lambda = light.x * a.w;
        vec2 nu = reflected_bandwidth(light_bandwidth, b.y, max(curvature, 0.0), cos_outgoing, distance_to_eye);
        weighted += lambda * vec2(nu.x, min(nu.y, frequency_limit));
        weights += lambda;
        // Mean square of f cos L / density over the footprint. Where the map is sampled too, the lobe's sampler keeps a part; the map's
        // density follows the radiance, and that of the light that matters is its mean square over its mean.
        float light_density = map_density * light.y / light.x;
#if defined(SAMPLER_CUT)
        float part = 1.0 / (1.0 + 4.0 * pi * light_density);
#elif defined(SAMPLER_COMBINED)
        float part = b.w / (b.w + light_density * MAP_WORTH);
#else
        const float part = 1.0;
#endif
        second += light.y * a.w * a.w * part * part;
        from_lobe += lambda * part;
        printed += (min(light_bandwidth, frequency_limit) + min(b.y, frequency_limit)) * b.x * light.y;
    }
    // All weights zero: nothing arrives, and a black pixel has no bandwidth.
    vec2 nu = weights > 0.0 ? weighted / weights : vec2(0);
    float image_bandwidth = min(nu.y * radians_per_pixel, nyquist);
    // A mean of pilots that are all at the limit is the limit but for the rounding of its two sums, 2^-24 for each term of
    // each, and of the conversions back and forth.
    if (image_bandwidth > nyquist * (1.0 - float(pilot_count + 4) * 1.2e-7)) image_bandwidth = nyquist;
    // Where the surface is not known around the pixel, nothing may be interpolated.
    if (curvature < 0.0) image_bandwidth = nyquist;
    float mean = weights / pilot_count;
#if defined(VARIANCE_PRINTED)
    // Eq. 9 bounds a mirror's variance so loosely that under the brightest texels the bound is beyond float's range.
    float variance = min(4.0 * pi * pi * printed / pilot_count, largest_float);
#else
    // What is left to the map's sampler varies less: its clusters or its cut know where it comes from.
    float lobe_mean = from_lobe / pilot_count, map_mean = mean - lobe_mean;
    float variance = lobe_share * (max(0.0, second / pilot_count - lobe_mean * lobe_mean) + map_variance * map_mean * map_mean);
#endif
    imageStore(bandwidth, at, vec4(nu, image_bandwidth, max(curvature, 0.0)));
    imageStore(prediction, at, vec4(variance, mean, 0, 0));
}
