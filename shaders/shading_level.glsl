// Nyquist: spacing <= 1 / (2 b), src/bandwidth/transport.h. A saturated bandwidth may be any number above what pixels can
// show, and no scale makes it small.
uint shading_level(float b, float scale, int coarsest_level) {
    if (b >= 0.5) return 0u;
    float scaled = scale * b;
    return scaled > 0.0 ? uint(clamp(floor(log2(0.5 / scaled)), 0.0, float(coarsest_level))) : uint(coarsest_level);
}
