// One material's lobe: drawing wi for wo by importance. A variant is compiled per kind: LOBE_TABLE (with BRDF_LINEAR for
// trilinear lookup), LOBE_LAMBERT or LOBE_GGX. Local frame, wo at azimuth 0. The double-precision originals are
// src/sampling/lobe_sampler.cpp and src/scene/brdf.cpp.

#include "views.glsl"

// The lobe towards one outgoing direction.
struct Lobe {
    vec3 wo;
    int view;  // of the tables
#if defined(LOBE_TABLE)
    float per_value, even;  // see target_density
#endif
};

layout(binding = 12) uniform samplerBuffer lobe_importances;  // src/sampling/lobe_sampler.h, LobeImportance

int importance_cell(int view, vec3 wi) {
    vec2 p = wi.xy / (abs(wi.x) + abs(wi.y) + wi.z);
    ivec2 cell = min(ivec2((0.5 * vec2(p.x + p.y, p.x - p.y) + 0.5) * IMPORTANCE_SIDE), IMPORTANCE_SIDE - 1);
    return (view * IMPORTANCE_SIDE + cell.y) * IMPORTANCE_SIDE + cell.x;
}

// Mean and greatest luminance of f cos(theta_i) around a direction above the horizon.
float lobe_importance(int view, vec3 wi) { return texelFetch(lobe_importances, importance_cell(view, wi)).r; }
float lobe_peak(int view, vec3 wi) {
    return texelFetch(lobe_importances, LOBE_VIEWS * IMPORTANCE_SIDE * IMPORTANCE_SIDE + importance_cell(view, wi)).r;
}

// The integral of that over a view's directions.
float importance_albedo(int view) { return texelFetch(lobe_importances, 2 * LOBE_VIEWS * IMPORTANCE_SIDE * IMPORTANCE_SIDE + view).r; }

#if defined(LOBE_TABLE)

layout(binding = 2) uniform samplerBuffer brdf_cells;     // RGB / table_scale, and 1 where measured
layout(binding = 3) uniform samplerBuffer lobe_x;         // start and width of each step of x
layout(binding = 4) uniform samplerBuffer lobe_phi;       // start and width of each step of phi
layout(binding = 9) uniform samplerBuffer lobe_albedo;    // what the density of each view is proportional to
layout(binding = 8) uniform samplerBuffer lobe_denser;   // src/sampling/lobe_sampler.h, LobeTable::denser
uniform float table_scale;

const int half_cells = 90, diff_cells = 90, phi_cells = 180;

#if defined(BRDF_LINEAR)
vec3 table_value(float x, float theta_diff, float phi_diff) {
    float h = clamp(x * half_cells - 0.5, 0.0, half_cells - 1.0);
    float d = clamp(theta_diff * (2.0 / pi) * diff_cells - 0.5, 0.0, diff_cells - 1.0);
    float p = phi_diff * (1.0 / pi) * phi_cells - 0.5;
    int h0 = min(int(h), half_cells - 2), d0 = min(int(d), diff_cells - 2), p0 = int(floor(p));
    vec3 f = vec3(h - h0, d - d0, p - p0);
    vec4 sum = vec4(0);
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 step = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 w = mix(1.0 - f, f, vec3(step));
        int phi = (p0 + step.z + phi_cells) % phi_cells;
        vec4 cell = texelFetch(brdf_cells, ((h0 + step.x) * diff_cells + d0 + step.y) * phi_cells + phi);
        sum += w.x * w.y * w.z * cell.a * vec4(cell.rgb, 1.0);
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0);
}
#else
vec3 table_value(float x, float theta_diff, float phi_diff) {
    int h = min(int(x * half_cells), half_cells - 1);
    int d = min(int(theta_diff * (2.0 / pi) * diff_cells), diff_cells - 1);
    int p = min(int(phi_diff * (1.0 / pi) * phi_cells), phi_cells - 1);
    return texelFetch(brdf_cells, (h * diff_cells + d) * phi_cells + p).rgb;
}
#endif

// f cos(theta_i) for a half vector of known x and angle to wo.
vec3 lobe_value(vec3 wi, vec3 h, float x, float oh) {
    float phi_y = wi.y * h.x - wi.x * h.y, phi_x = h.z * oh - wi.z;
    float phi_diff = angle_of_line(phi_y, phi_x);
    return table_value(x, acos_near(min(oh, 1.0), 1.0 - oh), phi_diff) * (table_scale * wi.z);
}

Lobe lobe_towards(vec3 wo) {
    int view = view_of(wo.z);
    float albedo = texelFetch(lobe_albedo, view).r, even = 1.0 / (2.0 * pi);
    return albedo > 0.0 ? Lobe(wo, view, (1.0 - LOBE_DEFENSIVE) / albedo, LOBE_DEFENSIVE * even) : Lobe(wo, view, 0.0, even);
}

// The part of samples, by their first coordinate, beyond which none is drawn more densely than that, per steradian.
float part_denser_than(Lobe lobe, float density) {
    int octave = int(floor(log2(density))) - LOBE_FIRST_OCTAVE;
    if (octave < 0) return 1.0;
    return texelFetch(lobe_denser, lobe.view * LOBE_OCTAVES + min(octave, LOBE_OCTAVES - 1)).r;
}

// The sampler's density over (x, phi) as its target defines it: f cos / albedo and an even part. The drawn density follows it in
// steps; for weights that must agree between two samplers, this one serves.
float target_density(Lobe lobe, vec3 value, float solid_angle) {
    return lobe.per_value * dot(value, vec3(1.0 / 3.0)) * solid_angle + lobe.even;
}

// weight = f cos(theta_i) / pdf; density: see evaluate_lobe. False: below the horizon, carries nothing.
bool sample_lobe(Lobe lobe, vec2 u, out vec3 wi, out vec3 weight, out vec2 density) {
    weight = vec3(0);
    density = vec2(1, 0);
    float scaled_x = u.x * LOBE_RADIAL;
    int k = int(scaled_x);
    vec2 xs = texelFetch(lobe_x, lobe.view * LOBE_RADIAL + k).xy;
    float x = xs.x + (scaled_x - k) * xs.y;

    float scaled_phi = (u.y < 0.5 ? 2.0 * u.y : 2.0 - 2.0 * u.y) * LOBE_AZIMUTHAL;
    int l = min(int(scaled_phi), LOBE_AZIMUTHAL - 1);
    vec2 ps = texelFetch(lobe_phi, (lobe.view * LOBE_RADIAL + k) * LOBE_AZIMUTHAL + l).xy;
    float phi = ps.x + (scaled_phi - l) * ps.y;

    float theta = x * x * (0.5 * pi);
    float sin_theta = sin(theta), cos_theta = cos(theta);
    vec3 h = vec3(sin_theta * cos(phi), (u.y < 0.5 ? sin_theta : -sin_theta) * sin(phi), cos_theta);
    float oh = dot(lobe.wo, h);
    wi = 2.0 * oh * h - lobe.wo;
    if (oh <= 0.0 || wi.z <= 0.0) return false;

    vec3 value = lobe_value(wi, h, x, oh);
    float solid_angle = 4.0 * oh * sin_theta * pi * x;                              // d(wi) / d(x, phi)
    float area = xs.y * ps.y * float(2 * LOBE_RADIAL * LOBE_AZIMUTHAL);             // 1 / density over (x, phi)
    weight = value * (solid_angle * area);
    density = vec2(target_density(lobe, value, solid_angle), solid_angle);
    return true;
}

// f cos(theta_i) for a given wi above the horizon. density: the sampler's density there as a fraction, so that the mirror
// direction of a table, where (x, phi) shrinks to a point, is no division by zero: density.x / density.y per steradian.
vec3 evaluate_lobe(Lobe lobe, vec3 wi, out vec2 density) {
    vec3 h = normalize(wi + lobe.wo);
    float squared = dot(h.xy, h.xy), oh = dot(lobe.wo, h);
    float x = sqrt(acos_near(h.z, squared / (1.0 + h.z)) * (2.0 / pi));
    vec3 value = lobe_value(wi, h, x, oh);
    float solid_angle = 4.0 * oh * sqrt(squared) * pi * x;
    density = vec2(target_density(lobe, value, solid_angle), solid_angle);
    return value;
}

#else

Lobe lobe_towards(vec3 wo) { return Lobe(wo, view_of(wo.z)); }

#if defined(LOBE_LAMBERT)

uniform vec3 albedo;

float part_denser_than(Lobe lobe, float density) { return density < 1.0 / pi ? 1.0 : 0.0; }

bool sample_lobe(Lobe lobe, vec2 u, out vec3 wi, out vec3 weight, out vec2 density) {
    float r = sqrt(u.x), phi = 2.0 * pi * u.y;
    wi = vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x));
    weight = albedo;
    density = vec2(wi.z, pi);
    return true;
}

vec3 evaluate_lobe(Lobe lobe, vec3 wi, out vec2 density) {
    density = vec2(wi.z, pi);
    return albedo * (wi.z / pi);
}

#else  // LOBE_GGX

uniform float alpha;
uniform vec3 f0;

vec3 fresnel(float oh) {
    float c = 1.0 - oh, c2 = c * c;
    return f0 + (1.0 - f0) * (c2 * c2 * c);
}

// sqrt(a^2 + (1 - a^2) cos^2) of Smith's shadowing.
float smith(float cosine) {
    float a2 = alpha * alpha;
    return sqrt(a2 + (1.0 - a2) * cosine * cosine);
}

// D G1(wo) / (4 cos_o), per steradian, as a fraction: a mirror's peak overflows neither part.
vec2 visible_density(vec3 h, vec3 wo) {
    float t = dot(h.xy, h.xy) / alpha + alpha * h.z * h.z;
    return vec2(0.5 / (wo.z + smith(wo.z)), pi * t * t);
}

float part_denser_than(Lobe lobe, float density) {
    vec2 peak = visible_density(vec3(0, 0, 1), lobe.wo);
    return density * peak.y < peak.x ? 1.0 : 0.0;
}

// Visible normals (Heitz 2018); f cos(theta_i) / pdf = F G2 / G1.
bool sample_lobe(Lobe lobe, vec2 u, out vec3 wi, out vec3 weight, out vec2 density) {
    vec3 v = normalize(vec3(alpha * lobe.wo.x, 0.0, lobe.wo.z));
    float r = sqrt(u.x), azimuth = 2.0 * pi * u.y;
    float t1 = r * cos(azimuth), s = 0.5 * (1.0 + v.z);
    float t2 = (1.0 - s) * sqrt(max(0.0, 1.0 - t1 * t1)) + s * r * sin(azimuth);
    float t3 = sqrt(max(0.0, 1.0 - t1 * t1 - t2 * t2));
    vec3 n = t1 * vec3(0, 1, 0) + t2 * vec3(-v.z, 0, v.x) + t3 * v;
    vec3 h = normalize(vec3(alpha * n.x, alpha * n.y, max(n.z, 0.0)));
    float oh = dot(lobe.wo, h);
    wi = 2.0 * oh * h - lobe.wo;
    weight = vec3(0);
    density = vec2(1, 0);
    if (wi.z <= 0.0) return false;
    weight = fresnel(oh) * (wi.z * (lobe.wo.z + smith(lobe.wo.z)) / (lobe.wo.z * smith(wi.z) + wi.z * smith(lobe.wo.z)));
    density = visible_density(h, lobe.wo);
    return true;
}

vec3 evaluate_lobe(Lobe lobe, vec3 wi, out vec2 density) {
    vec3 h = normalize(wi + lobe.wo);
    density = visible_density(h, lobe.wo);
    // D / density.x * density.y = 1: D = 1 / (pi t^2) = 1 / density.y.
    return fresnel(dot(lobe.wo, h)) * (wi.z * 0.5 / (density.y * (lobe.wo.z * smith(wi.z) + wi.z * smith(lobe.wo.z))));
}

#endif
#endif
