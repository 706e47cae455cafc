// Interpolates the pixels that are new on one lattice and were not shaded (section 3.2).
#include "parents.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 3) uniform usampler2D decisions;
layout(binding = 0, rgba32f) uniform image2D radiances;
layout(binding = 1, r8ui) readonly uniform uimage2D levels;
uniform int level;
uniform int coarsest_level;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) << level;
    if (any(greaterThanEqual(at, textureSize(decisions, 0)))) return;
    if (texelFetch(decisions, at, 0).r != 1u || lattice_level(at, coarsest_level) != level) return;
    Parents parents = parents_of(at, level, float(imageLoad(levels, at).r));
    vec4 sum = vec4(0);
    for (int corner = 0; corner < 4; ++corner)
        if (parents.weight[corner] > 0.0) sum += parents.weight[corner] * imageLoad(radiances, parents.at[corner]);
    imageStore(radiances, at, sum);
}
