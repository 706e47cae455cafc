// Lamps whose light ends at a surface's horizon: src/sampling/lamps.h. LAMPS: how many; none costs nothing.
#if LAMPS > 0
uniform vec4 lamps[LAMPS];  // direction, and the sine of the half angle that it fills
#endif

// Whether a lamp is neither above two surfaces' horizons nor below both: radiance between them has an edge.
bool parted_by_horizon(vec3 one, vec3 other) {
    bool parted = false;
#if LAMPS > 0
    for (int k = 0; k < LAMPS; ++k) {
        vec2 sines = vec2(dot(one, lamps[k].xyz), dot(other, lamps[k].xyz));
        parted = parted || !all(greaterThan(sines, vec2(lamps[k].w))) && !all(lessThan(sines, vec2(-lamps[k].w)));
    }
#endif
    return parted;
}
