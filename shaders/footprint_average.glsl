// The next coarser level of shaders/footprint_light.glsl: means of 2 x 2 texels.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2DArray finer;
layout(binding = 0, LIGHT_FORMAT) writeonly uniform image2DArray coarser;
uniform int level;  // the finer one

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(coarser).xy))) return;
    for (int layer = 0; layer < LIGHT_LAYERS; ++layer) {
        vec4 sum = vec4(0);
        for (int corner = 0; corner < 4; ++corner)
            sum += texelFetch(finer, ivec3(2 * at + ivec2(corner & 1, corner >> 1), layer), level);
        imageStore(coarser, ivec3(at, layer), 0.25 * sum);
    }
}
