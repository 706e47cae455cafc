// The map onto the octahedral square, in units of its mean, softly cut at the ceiling of each layer (or not at all).
#include "common.glsl"
#include "light.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, LIGHT_FORMAT) writeonly uniform image2DArray layers;
uniform int side;
uniform int supersampling;  // lookups along each side of a texel: no source texel is skipped
uniform float inverse_unit;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (max(at.x, at.y) >= side) return;
    vec3 sums[LIGHT_LAYERS];
    for (int layer = 0; layer < LIGHT_LAYERS; ++layer) sums[layer] = vec3(0);
    for (int j = 0; j < supersampling; ++j)
        for (int i = 0; i < supersampling; ++i) {
            vec2 square = (vec2(at) + (vec2(i, j) + 0.5) / supersampling) / side;
            vec4 light = light_from(octahedral_direction(square));
            light.rgb *= inverse_unit;
#if defined(FIRST_CEILING)
            float ceiling = FIRST_CEILING;
            for (int layer = 0; layer < LIGHT_LAYERS; ++layer) {
                sums[layer] += light.rgb * (ceiling / (ceiling + light.a));
                ceiling *= 4.0;
            }
#else
            sums[0] += light.rgb;
#endif
        }
    // Alpha: the texel's solid angle, in units of the largest (3^1.5 times the smallest), by which coarser levels are weighted.
    vec3 direction = octahedral_direction((vec2(at) + 0.5) / side);
    float reach = abs(direction.x) + abs(direction.y) + abs(direction.z);
    for (int layer = 0; layer < LIGHT_LAYERS; ++layer)
        imageStore(layers, ivec3(at, layer), vec4(sums[layer] / float(supersampling * supersampling), reach * reach * reach / 5.196152));
}
