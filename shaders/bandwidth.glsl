// The bandwidth buffer (section 3.1): per pixel the bandwidth of the light arriving there (eq. 5), its image bandwidth
// (eq. 6) and the predicted variance of a light sample (eq. 9).
#include "common.glsl"
#include "covered.glsl"
#include "surface.glsl"
#include "transport.glsl"
#if defined(PREDICTS_BY_LOBE)
#include "lobe.glsl"
uniform uint slot;  // of the material that the lobe is of: other pixels have a dispatch of their own
#else
#include "views.glsl"
#endif

layout(binding = 1) uniform usampler2D materials;
layout(binding = 7) uniform samplerBuffer pilots;    // src/sampling/pilots.h: two vec4 each
layout(binding = 5) uniform usamplerBuffer brdf_of;  // instance number + 1 -> BRDF slot

layout(binding = 0, rgba32f) writeonly uniform image2D bandwidth;   // spatial, angular, image, curvature
layout(binding = 1, rg32f) writeonly uniform image2D prediction;    // variance of one sample, mean radiance (luminance)

uniform int pilot_count;
uniform float radians_per_pixel;

const float nyquist = 0.5;      // cycles per pixel: what the finest level can show

// Of the samples, one in lobe_share is the lobe's.
#if defined(SAMPLER_CUT) || defined(SAMPLER_COMBINED)
const float lobe_share = 2.0;
#else
const float lobe_share = 1.0;
#endif

// The surface that a pixel sees.
struct Point {
    mat3 frame;             // columns: the local frame in world space
    vec3 wo;                // local
    float curvature, distance_to_eye;
    float frequency_limit;  // cycles/radian at the eye: what the finest level can show
    int first_pilot;
};

// Sums over lights. weights: of the mean of eq. 5, in proportion to the radiance that arrives; weighted: spatial and angular bandwidth
// times that. mean: radiance (luminance); variance: of one sample; printed: eq. 9's sum.
struct Predicted {
    vec2 weighted;
    float weights, mean, variance, printed;
};

// Spatial and angular bandwidth at the eye of light of so much angular bandwidth that a lobe of so much reflects, cycles/radian.
vec2 bandwidth_at_eye(Point point, float light_bandwidth, float lobe_bandwidth) {
    vec2 nu = reflected_bandwidth(light_bandwidth, lobe_bandwidth, point.curvature, point.wo.z, point.distance_to_eye);
    return vec2(nu.x, min(nu.y, point.frequency_limit));
}

#include LIGHT_FILES

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
#if defined(PREDICTS_BY_LOBE)
    if (texelFetch(brdf_of, int(material)).r != slot) return;
#endif
    float distance_to_eye = length(here.position);
    vec3 wo_world = towards_eye(at);
    mat3 frame = local_frame(here.normal, wo_world);
    float cos_outgoing = dot(here.normal, wo_world);
    vec3 wo = vec3(sqrt(max(0.0, 1.0 - cos_outgoing * cos_outgoing)), 0.0, cos_outgoing);
    float curvature = curvature_at(at, here, material);

    int first_pilot = (int(texelFetch(brdf_of, int(material)).r) * LOBE_VIEWS + view_of(cos_outgoing)) * pilot_count;
    Point point = Point(frame, wo, max(curvature, 0.0), distance_to_eye, nyquist / radians_per_pixel, first_pilot);
    Predicted sum = Predicted(vec2(0), 0.0, 0.0, 0.0, 0.0);
    LIGHTS_PREDICT(point, sum)
    // All weights zero: nothing arrives, and a black pixel has no bandwidth.
    vec2 nu = sum.weights > 0.0 ? sum.weighted / sum.weights : vec2(0);
    float image_bandwidth = min(nu.y * radians_per_pixel, nyquist);
    // A mean of pilots that are all at the limit is the limit but for the rounding of its two sums, 2^-24 for each term of
    // each, and of the conversions back and forth.
    if (image_bandwidth > nyquist * (1.0 - float(pilot_count + 4) * 1.2e-7)) image_bandwidth = nyquist;
    // Where the surface is not known around the pixel, nothing may be interpolated.
    if (curvature < 0.0) image_bandwidth = nyquist;
#if defined(VARIANCE_PRINTED)
    // Eq. 9 bounds a mirror's variance so loosely that under the brightest texels the bound is beyond float's range.
    float variance = min(4.0 * pi * pi * sum.printed / pilot_count, largest_float);
#else
    float variance = sum.variance;
#endif
    imageStore(bandwidth, at, vec4(nu, image_bandwidth, max(curvature, 0.0)));
    imageStore(prediction, at, vec4(variance, sum.mean, 0, 0));
}
