// Variance of a light sample relative to what a pixel shows: the part of the mean keeps dark pixels finite
// (docs/conventions.md, error of a frame).
const float dark_part = 0.01;

// prediction: variance and mean radiance.
float relative_variance(vec2 prediction, float mean_radiance) {
    float scale = prediction.g + dark_part * mean_radiance;
    float deviation = scale > 0.0 ? sqrt(prediction.r) / scale : 0.0;  // its square, not theirs: scale^2 may be too small for a float
    return deviation * deviation;
}
