// What the camera sees past the meshes: the map itself.
#include "common.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D map;
layout(binding = 1) uniform usampler2D materials;
layout(binding = 0, rgba32f) writeonly uniform image2D radiances;
uniform vec3 forward;
uniform vec3 right_per_pixel;  // steps on the plane at distance 1
uniform vec3 down_per_pixel;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = textureSize(materials, 0);
    if (any(greaterThanEqual(at, size)) || texelFetch(materials, at, 0).r != 0u) return;
    vec2 off = vec2(at) + 0.5 - 0.5 * vec2(size);
    vec3 direction = normalize(forward + off.x * right_per_pixel + off.y * down_per_pixel);
    imageStore(radiances, at, vec4(textureLod(map, latitude_longitude(direction), 0.0).rgb, 0.0));
}
