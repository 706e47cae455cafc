// The latitude-longitude map onto the octahedral square: mean luminance and mean squared luminance of every texel.
#include "common.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D map;
layout(binding = 0, rgba32f) writeonly uniform image2D moments;
layout(binding = 1, r32f) writeonly uniform image2D smooth_out;
uniform int side;
uniform int supersampling;  // lookups along each side of a texel: no source texel is skipped

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (max(at.x, at.y) >= side) return;
    ivec2 size = textureSize(map, 0);
    vec2 sum = vec2(0);
    for (int j = 0; j < supersampling; ++j)
        for (int i = 0; i < supersampling; ++i) {
            vec2 square = (vec2(at) + (vec2(i, j) + 0.5) / supersampling) / side;
            ivec2 texel = ivec2(latitude_longitude(octahedral_direction(square)) * size);
            float l = luminance(texelFetch(map, min(texel, size - 1), 0).rgb);
            sum += vec2(l, l * l);
        }
    sum /= float(supersampling * supersampling);
    imageStore(moments, at, vec4(sum, 0, 0));
    imageStore(smooth_out, at, vec4(sum.x));
}
