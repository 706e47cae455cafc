uniform vec3 forward;   // unit view direction
uniform uint instance;  // instance number + 1

in vec3 from_eye;
in vec3 shading_normal;

layout(location = 0) out vec4 out_position;  // metres from the eye, world axes; w: depth
layout(location = 1) out vec4 out_normal;    // unit, towards the eye; w: 1 where the normal had to be bent
layout(location = 2) out uint out_material;

// A shading normal that faces away at the silhouette is turned until it is seen under this cosine: what the outermost pixel
// of a disc of 8192 pixels' radius, the largest frame, shows on average (2/3 sqrt(2 / 8192)).
const float silhouette_cosine = 0.0104;
// The passes that follow work out wo and the cosine again: two normalisations and a dot product apart, each of up to 2^-23.
// Below four of those a cosine that is positive here may be 0 or negative there.
const float least_cosine = 4.77e-7;

void main() {
    vec3 wo = -normalize(from_eye);
    vec3 n = normalize(shading_normal);
    // Both sides are shaded: towards the eye lies the side of the triangle that is seen, whatever its winding.
    vec3 facet = cross(dFdx(from_eye), dFdy(from_eye));
    if (dot(facet, wo) < 0.0) facet = -facet;
    if (dot(n, facet) < 0.0) n = -n;
    float cosine = dot(n, wo);
    float bent = 0.0;
    if (!(cosine > least_cosine)) {
        vec3 tangent = n - cosine * wo;
        float squared = dot(tangent, tangent);
        n = squared > 0.0 ? silhouette_cosine * wo + sqrt(1.0 - silhouette_cosine * silhouette_cosine) * tangent * inversesqrt(squared) : wo;
        bent = 1.0;
    }
    out_position = vec4(from_eye, dot(from_eye, forward));
    out_normal = vec4(n, bent);
    out_material = instance;
}
