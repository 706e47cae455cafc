// The largest of the 3 x 3 coefficients whose support reaches a block (src/bandwidth/wavelet.cpp, reaching).
#include "common.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D details;
layout(binding = 0, r32f) writeonly uniform image2D reach_out;
uniform int side;
uniform int level;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (max(at.x, at.y) >= side) return;
    float largest = 0.0;
    for (int j = -2; j <= 0; ++j)
        for (int i = -2; i <= 0; ++i) {
            ivec2 from = octahedral_border(at + ivec2(i, j), side);
            largest = max(largest, texelFetch(details, from, level).r);
        }
    imageStore(reach_out, at, vec4(largest));
}
