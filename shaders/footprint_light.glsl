// The map onto the octahedral square, in units of its mean: all of it, or what lies below each soft ceiling. Every value is
// weighted by its texel's solid angle, which alpha holds (in units of the largest, 3^1.5 times the smallest): so coarser levels
// are plain means.
#include "common.glsl"
#include "environment.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, LIGHT_FORMAT) writeonly uniform image2DArray footprints;
uniform int side;
uniform int supersampling;  // lookups along each side of a texel: no source texel is skipped
uniform float inverse_mean;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (max(at.x, at.y) >= side) return;
    vec3 sums[LIGHT_LAYERS];
    for (int layer = 0; layer < LIGHT_LAYERS; ++layer) sums[layer] = vec3(0);
    for (int j = 0; j < supersampling; ++j)
        for (int i = 0; i < supersampling; ++i) {
            vec2 square = (vec2(at) + (vec2(i, j) + 0.5) / supersampling) / side;
            vec4 light = light_from(octahedral_direction(square));
            for (int layer = 0; layer < LIGHT_LAYERS; ++layer)
                sums[layer] += light.rgb * inverse_mean * part_below(layer, light.a);
        }
    float reach = octahedral_reach(octahedral_direction((vec2(at) + 0.5) / side));
    float solid_angle = reach * reach * reach / 5.196152;
    for (int layer = 0; layer < LIGHT_LAYERS; ++layer)
        imageStore(footprints, ivec3(at, layer), vec4(sums[layer] * (solid_angle / float(supersampling * supersampling)), solid_angle));
}
