// What the camera sees past the meshes: the lights themselves.
#include "common.glsl"
#include LIGHT_FILES
#include "rays.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 1) uniform usampler2D materials;
layout(binding = 0, rgba32f) writeonly uniform image2D radiances;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = textureSize(materials, 0);
    if (any(greaterThanEqual(at, size)) || texelFetch(materials, at, 0).r != 0u) return;
    vec3 direction = normalize(ray_through(vec2(at)));
    imageStore(radiances, at, vec4(LIGHTS_SEEN(direction), 0.0));
}
