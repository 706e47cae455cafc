// Sums of the predicted mean radiance along each row; the host adds them up in double precision.
layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D prediction;
layout(binding = 0, std430) writeonly buffer Sums { float sums[]; };

void main() {
    ivec2 size = textureSize(prediction, 0);
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    float sum = 0.0;
    for (int x = 0; x < size.x; ++x) sum += texelFetch(prediction, ivec2(x, y), 0).g;
    sums[y] = sum;
}
