// Passes that only covered pixels need run over a list of them: src/passes/covered.h.
layout(local_size_x = 64) in;
layout(binding = 15) uniform usamplerBuffer covered;  // y << 16 | x
uniform uint first, count;                            // part of the list
#if defined(STRIDE)
uniform uint stride;  // every so manieth of the part
#else
const uint stride = 1u;
#endif

// In the whole list.
uint covered_place() { return first + min(gl_GlobalInvocationID.x * stride, count - 1u); }

// False beyond the end of the part.
bool covered_pixel(out ivec2 at) {
    uint entry = texelFetch(covered, int(covered_place())).r;
    at = ivec2(entry & 0xffffu, entry >> 16);
    return gl_GlobalInvocationID.x * stride < count;
}
