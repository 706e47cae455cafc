// One level of the Daubechies-4 transform on the octahedral square (src/bandwidth/wavelet.cpp): the half-sized
// approximation and the largest magnitude of its three details.
#include "common.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D finer;
layout(binding = 0, r32f) writeonly uniform image2D smooth_out;
layout(binding = 1, r32f) writeonly uniform image2D detail_out;
uniform int side;         // of the finer picture
uniform int finer_level;  // its mip level

// Daubechies 1988: (1 + r, 3 + r, 3 - r, 1 - r) / (4 sqrt 2) with r = sqrt 3; the high pass is its alternating reverse.
const float low[4] = float[](0.48296291, 0.83651630, 0.22414387, -0.12940952);
const float high[4] = float[](-0.12940952, -0.22414387, 0.83651630, -0.48296291);

float texel(int x, int y) { return texelFetch(finer, octahedral_border(ivec2(x, y), side), finer_level).r; }

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (max(at.x, at.y) >= side / 2) return;
    float ll = 0.0, lh = 0.0, hl = 0.0, hh = 0.0;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            float value = texel(2 * at.x + i, 2 * at.y + j);
            ll += low[i] * low[j] * value;
            lh += low[i] * high[j] * value;
            hl += high[i] * low[j] * value;
            hh += high[i] * high[j] * value;
        }
    imageStore(smooth_out, at, vec4(ll));
    imageStore(detail_out, at, vec4(max(abs(lh), max(abs(hl), abs(hh)))));
}
