// Sums along each row of the predicted mean radiance, (DEVIATIONS) of the relative standard deviation, or (LATTICES) of the parts of
// pixels that lattices as fine as they ask for would shade; the host adds them up in double precision.
#include "relative_variance.glsl"
#include "shading_level.glsl"
layout(local_size_x = 64) in;

#if defined(LATTICES)
layout(binding = 0) uniform sampler2D source;  // bandwidth
layout(binding = 1) uniform usampler2D materials;
uniform float scale;
uniform int coarsest_level;

float summand(ivec2 at) {
    if (texelFetch(materials, at, 0).r == 0u) return 0.0;
    return exp2(-2.0 * float(shading_level(texelFetch(source, at, 0).b, scale, scale, coarsest_level)));
}
#else
layout(binding = 0) uniform sampler2D source;  // prediction
uniform float mean_radiance;

float summand(ivec2 at) {
    vec2 p = texelFetch(source, at, 0).rg;
#if defined(DEVIATIONS)
    return sqrt(relative_variance(p, mean_radiance));
#else
    return p.g;
#endif
}
#endif

layout(binding = 0, std430) writeonly buffer Sums { float sums[]; };

void main() {
    int y = int(gl_GlobalInvocationID.x);
    ivec2 size = textureSize(source, 0);
    if (y >= size.y) return;
    float sum = 0.0;
    for (int x = 0; x < size.x; ++x) sum += summand(ivec2(x, y));
    sums[y] = sum;
}
