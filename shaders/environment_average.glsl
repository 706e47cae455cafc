// The next coarser level of the moments: means of 2 x 2 texels.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D moments;
layout(binding = 0, rgba32f) writeonly uniform image2D coarser;
uniform int level;  // the finer one

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(coarser)))) return;
    vec4 sum = vec4(0);
    for (int corner = 0; corner < 4; ++corner) sum += texelFetch(moments, 2 * at + ivec2(corner & 1, corner >> 1), level);
    imageStore(coarser, at, 0.25 * sum);
}
