#include "rays.glsl"
uniform vec3 forward;   // unit view direction
uniform uint instance;  // instance number + 1

in vec3 shading_normal;

layout(location = 0) out vec4 out_surface;  // unit normal towards the eye; depth, metres, negative where the normal had to be bent
layout(location = 1) out uint out_material;

// A shading normal that faces away at the silhouette is turned until it is seen under this cosine: what the outermost pixel
// of a disc of 8192 pixels' radius, the largest frame, shows on average (2/3 sqrt(2 / 8192)).
const float silhouette_cosine = 0.0104;
// The passes that follow work out wo and the cosine again: two normalisations and a dot product apart, each of up to 2^-23.
// Below four of those a cosine that is positive here may be 0 or negative there.
const float least_cosine = 4.77e-7;

// Normal of the triangle's plane, away from the eye: its product with a position on the plane is 1, with a ray 1 / depth, which is
// linear over the picture.
vec3 plane(vec3 ray) {
    float inverse_depth = gl_FragCoord.w;
    vec3 across = (dFdx(inverse_depth) * ray_right + dFdy(inverse_depth) * ray_down) / dot(ray_right, ray_right);
    return across + (inverse_depth - dot(across, ray)) * forward;
}

void main() {
    vec3 ray = ray_through(gl_FragCoord.xy - 0.5);
    vec3 wo = -normalize(ray);
    vec3 n = normalize(shading_normal);
    // Both sides are shaded: towards the eye lies the side of the triangle that is seen, whatever its winding.
    if (dot(n, plane(ray)) > 0.0) n = -n;
    float cosine = dot(n, wo);
    float depth = 1.0 / gl_FragCoord.w;
    if (!(cosine > least_cosine)) {
        vec3 tangent = n - cosine * wo;
        float squared = dot(tangent, tangent);
        n = squared > 0.0 ? silhouette_cosine * wo + sqrt(1.0 - silhouette_cosine * silhouette_cosine) * tangent * inversesqrt(squared) : wo;
        depth = -depth;
    }
    out_surface = vec4(n, depth);
    out_material = instance;
}
