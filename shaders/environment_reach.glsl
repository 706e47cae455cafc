// The largest of the 3 x 3 coefficients whose support reaches a block (src/bandwidth/wavelet.cpp, reaching).
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
            ivec2 from = at + ivec2(i, j);
            if (from.x < 0) from = ivec2(-1 - from.x, side - 1 - from.y);
            if (from.y < 0 || from.y >= side)
                from = ivec2(side - 1 - from.x, from.y < 0 ? -1 - from.y : 2 * side - 1 - from.y);
            largest = max(largest, texelFetch(details, from, level).r);
        }
    imageStore(reach_out, at, vec4(largest));
}
