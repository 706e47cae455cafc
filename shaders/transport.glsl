// Figure 4's operators for distant light (spatial bandwidth 0 at the source), composed as in eq. 3 and 4. The original is
// src/bandwidth/transport.h. Returns (spatial, angular) at the eye: cycles/metre, cycles/radian.
vec2 reflected_bandwidth(float light, float lobe, float curvature, float cos_outgoing, float distance_to_eye) {
    float kept = min(lobe, light);
#if defined(TRANSPORT_BOX)
    float spatial = curvature * light + curvature * kept;
#else
    float spatial = 2.0 * curvature * kept;
#endif
    spatial /= cos_outgoing;
    return vec2(spatial, kept + distance_to_eye * spatial);
}
