// Sums along each row of the predicted mean radiance or, where DEVIATIONS is defined, of the relative standard deviation; the host adds
// them up in double precision.
#include "relative_variance.glsl"
layout(local_size_x = 64) in;

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

layout(binding = 0, std430) writeonly buffer Sums { float sums[]; };

void main() {
    int y = int(gl_GlobalInvocationID.x);
    ivec2 size = textureSize(source, 0);
    if (y >= size.y) return;
    float sum = 0.0;
    for (int x = 0; x < size.x; ++x) sum += summand(ivec2(x, y));
    sums[y] = sum;
}
