// Sums along each row of the predicted mean radiance, or (DEVIATIONS) of the relative standard deviation; the host adds them up
// in double precision.
#include "relative_variance.glsl"
layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D prediction;
layout(binding = 0, std430) writeonly buffer Sums { float sums[]; };
uniform float mean_radiance;

void main() {
    ivec2 size = textureSize(prediction, 0);
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    float sum = 0.0;
    for (int x = 0; x < size.x; ++x) {
        vec2 p = texelFetch(prediction, ivec2(x, y), 0).rg;
#if defined(DEVIATIONS)
        sum += sqrt(relative_variance(p, mean_radiance));
#else
        sum += p.g;
#endif
    }
    sums[y] = sum;
}
