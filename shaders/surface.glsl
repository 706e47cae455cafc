// What the geometry pass saw through each pixel: src/picture/targets.h, GBuffer.
#include "rays.glsl"
layout(binding = 14) uniform sampler2D surfaces;

struct Surface {
    vec3 position;  // metres from the eye, world axes
    vec3 normal;    // unit, towards the eye
    float depth;    // metres
};

Surface surface_at(ivec2 at) {
    vec4 texel = texelFetch(surfaces, at, 0);
    float depth = abs(texel.w);
    return Surface(depth * ray_through(vec2(at)), texel.xyz, depth);
}

// Whether the normal had to be turned towards the eye.
bool is_bent(ivec2 at) { return texelFetch(surfaces, at, 0).w < 0.0; }

vec3 towards_eye(ivec2 at) { return -normalize(ray_through(vec2(at))); }
