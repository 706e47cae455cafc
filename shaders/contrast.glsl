// The contrast test: the predicted luminance of a pixel against that interpolated from the predictions of its coarser neighbours. Bandwidth
// says how fast radiance changes, not by how much: beside a bright reflection, the slightest part of it is too much.
#include "relative_variance.glsl"
uniform float mean_radiance;  // of the covered pixels, as predicted
uniform float tolerance;      // largest relative contrast at which a pixel may be interpolated

float relative_contrast(float here, float between) {
    float scale = here + dark_part * mean_radiance;
    return scale > 0.0 ? (between - here) / scale : 0.0;
}
