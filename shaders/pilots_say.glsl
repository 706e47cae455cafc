// What the pilots expect of a pixel, held against interpolation of what they expect elsewhere. Bandwidth knows nothing of contrast:
// beside a rim that shows a lamp, the slightest remainder of it is too much.
#include "relative_variance.glsl"
uniform float mean_radiance;  // of the covered pixels, as predicted
uniform float tolerance;      // by how much, relatively, the pilots may contradict interpolation

// By how much interpolation of their expectations errs, relatively.
float contradiction(float here, float between) {
    float scale = here + dark_part * mean_radiance;
    return scale > 0.0 ? (between - here) / scale : 0.0;
}
