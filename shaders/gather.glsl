// What listed pixels show, one after the other: radiance, mean of squared luminance; spread, radiance as predicted.
layout(local_size_x = 64) in;

layout(binding = 0) uniform usamplerBuffer entries;  // y << 16 | x
layout(binding = 1) uniform sampler2D radiances;
layout(binding = 2) uniform sampler2D spreads;
#if defined(PREDICTED)
layout(binding = 3) uniform sampler2D prediction;
#endif
layout(binding = 0, std430) writeonly buffer Gathered { vec4 gathered[]; };
uniform uint count;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint entry = texelFetch(entries, int(i)).r;
    ivec2 at = ivec2(entry & 0xffffu, entry >> 16);
    gathered[2u * i] = texelFetch(radiances, at, 0);
    float expected = 0.0;
#if defined(PREDICTED)
    expected = texelFetch(prediction, at, 0).g;
#endif
    gathered[2u * i + 1u] = vec4(texelFetch(spreads, at, 0).r, expected, 0, 0);
}
