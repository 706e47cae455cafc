// Passes that only covered pixels need run over a list of them: src/passes/covered.h.
layout(local_size_x = 64) in;
layout(binding = 15) uniform usamplerBuffer covered;  // y << 16 | x
uniform uint first, count;                            // a range of the list

// False beyond the end of the range.
bool covered_pixel(out ivec2 at) {
    uint entry = texelFetch(covered, int(first + min(gl_GlobalInvocationID.x, count - 1u))).r;
    at = ivec2(entry & 0xffffu, entry >> 16);
    return gl_GlobalInvocationID.x < count;
}
