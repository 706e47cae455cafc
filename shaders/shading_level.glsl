// Nyquist: spacing <= 1 / (2 b), src/bandwidth/transport.h. A saturated bandwidth may be any number above what pixels can
// show, and no scale makes it small. first_scale: before witnesses were heard; where they ask for more, the coarsest spacing becomes as
// much finer, whatever was predicted: no multiple of nothing would.
uint shading_level(float b, float scale, float first_scale, int coarsest_level) {
    if (b >= 0.5) return 0u;
    float scaled = max(scale * b, 0.5 * (scale / first_scale) * exp2(-float(coarsest_level)));
    return uint(clamp(floor(log2(0.5 / scaled)), 0.0, float(coarsest_level)));
}
