// Anisotropic bilateral weights of a pixel's parents (section 3.2).
#include "lattice.glsl"
#include "surface.glsl"
layout(binding = 2) uniform usampler2D materials;

// Chords that leave a tangent plane by more than a quarter of their length bridge a fold, not a surface: on a sphere it
// is the chord of half a radian, over which shading cannot be linear. Both ends' planes count: at a silhouette the near
// one contains the line of sight, and with it whatever lies behind.
const float chord_slope = 0.25;
// Uneven weights shift the mean away from the pixel; by at most this part of the way to a parent, or the pixel is shaded.
const float centre_tolerance = 0.25;

// Below these a float's range ends: they keep a quotient finite and change no weight that counts.
const float least_cosine = 1e-6;   // its square is still a normal number; a pixel seen so flat has level 0
const float least_squared = 1e-37; // metres^2: chords in a scene of 1e-6 m are above it by ten orders
const float least_weight = 1e-30;

struct Parents {
    ivec2 at[4];
    float weight[4];  // sum 1; 0: no parent in this place
    bool balanced;    // enough of them, evenly around the pixel
};

Parents parents_of(ivec2 at, int level, float pixel_level) {
    ivec2 size = textureSize(materials, 0);
    Surface here = surface_at(at);
    uint material = texelFetch(materials, at, 0).r;
    float cosine = max(dot(here.normal, towards_eye(at)), least_cosine);
    vec2 axis = vec2(dot(here.normal, ray_right), dot(here.normal, ray_down));  // the projected normal
    axis = dot(axis, axis) > 0.0 ? normalize(axis) : vec2(0);

    Parents result;
    float available = 0.0, all = 0.0, sum = 0.0;
    vec2 centre = vec2(0);
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 offset = towards_parent(at, level, corner), parent = at + offset;
        result.at[corner] = parent;
        result.weight[corner] = 0.0;
        if (is_repeated(at, level, corner)) continue;
        all += 1.0;
        if (any(lessThan(parent, ivec2(0))) || any(greaterThanEqual(parent, size))) continue;
        if (texelFetch(materials, parent, 0).r != material) continue;
        Surface there = surface_at(parent);
        vec3 chord = there.position - here.position;
        float rise = max(abs(dot(chord, here.normal)), abs(dot(chord, there.normal)));
        float slope = rise * inversesqrt(max(dot(chord, chord), least_squared)) / chord_slope;
        float g_z = exp(-slope * slope);
        // g_a with M = R^T diag(1, 1 / cos^2) R, narrow along the projected normal, less the part that all directions share;
        // in units of the spacing that the pixel's own bandwidth allows.
        float along = dot(vec2(offset), axis) * exp2(-pixel_level);
        float g_a = exp(-along * along * (1.0 / (cosine * cosine) - 1.0));
        float weight = g_z * max(g_a, least_weight);
        result.weight[corner] = weight;
        available += g_z;
        sum += weight;
        centre += weight * vec2(offset) / float(1 << level);
    }
    result.balanced = available >= 0.5 * all && sum > 0.0 && length(centre) <= centre_tolerance * sum;
    if (sum > 0.0)
        for (int corner = 0; corner < 4; ++corner) result.weight[corner] /= sum;
    return result;
}
