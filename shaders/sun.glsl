// Suns: discs of uniform radiance, infinitely far away (src/lights/sun.h). Two vec4 each: direction and sine of the angular radius;
// radiance and 1 - cosine of the angular radius.
layout(binding = 11) uniform samplerBuffer suns;
uniform int sun_count;

struct Sun {
    vec3 direction;  // world, unit
    float sine;
    vec3 radiance;
    float versine;
};

Sun sun_at(int k) {
    vec4 a = texelFetch(suns, 2 * k), b = texelFetch(suns, 2 * k + 1);
    return Sun(a.xyz, a.w, b.xyz, b.w);
}

float solid_angle_of(Sun sun) { return 2.0 * pi * sun.versine; }

// By the length of the chord, which keeps the digits of small angles.
bool is_within(Sun sun, vec3 direction) {
    vec3 chord = direction - sun.direction;
    return dot(chord, chord) < 2.0 * sun.versine;
}

// Of the disc around a unit direction, evenly in solid angle.
vec3 point_of_disc(vec3 centre, float versine, vec2 u) {
    float down = u.x * versine, sine = sqrt(down * (2.0 - down)), azimuth = 2.0 * pi * u.y;
    vec3 tangent = normalize(cross(abs(centre.x) < 0.5 ? vec3(1, 0, 0) : vec3(0, 1, 0), centre)), bitangent = cross(centre, tangent);
    return (1.0 - down) * centre + sine * (cos(azimuth) * tangent + sin(azimuth) * bitangent);
}

// A surface sees some of it: sine_above is that of the angle of its centre above the horizon.
bool reaches_above(Sun sun, float sine_above) { return sine_above > -sun.sine; }

#if defined(PASS_BACKGROUND)

vec3 sun_seen(vec3 direction) {
    vec3 sum = vec3(0);
    for (int k = 0; k < sun_count; ++k) {
        Sun sun = sun_at(k);
        if (is_within(sun, direction)) sum += sun.radiance;
    }
    return sum;
}

#elif defined(PASS_CLASSIFY)

// Terminator test: whether a sun is neither above two surfaces' horizons as a whole nor below both. Radiance between them has an edge.
bool sun_sets_between(vec3 one, vec3 other) {
    for (int k = 0; k < sun_count; ++k) {
        Sun sun = sun_at(k);
        vec2 sines = vec2(dot(one, sun.direction), dot(other, sun.direction));
        if (!all(greaterThan(sines, vec2(sun.sine))) && !all(lessThan(sines, vec2(-sun.sine)))) return true;
    }
    return false;
}

#elif defined(PASS_PREDICT)

uniform float unit_disc_bandwidth;                      // of a disc of one radian, cycles/radian
layout(binding = 6) uniform samplerBuffer lobe_bandwidths;  // src/bandwidth/lobe_bandwidth.h

// rho of eq. 5 at a pair of directions.
float lobe_bandwidth(vec3 wo, vec3 wi) {
    vec2 p = wi.xy / (abs(wi.x) + abs(wi.y) + wi.z);
    ivec2 cell = clamp(ivec2((0.5 * vec2(p.x + p.y, p.x - p.y) + 0.5) * LOBE_BANDWIDTH_SIDE), 0, LOBE_BANDWIDTH_SIDE - 1);
    int view = clamp(int(wo.z * LOBE_BANDWIDTH_VIEWS), 0, LOBE_BANDWIDTH_VIEWS - 1);
    return texelFetch(lobe_bandwidths, (view * LOBE_BANDWIDTH_SIDE + cell.y) * LOBE_BANDWIDTH_SIDE + cell.x).r;
}

// Directions to a disc, beside the pilots of the lobe that meet it: either alone misses what the other is for, a lobe much narrower than the
// disc or much wider. They are joined by the balance heuristic (Veach 1997).
const int disc_points = 4;
// Pilots times suns, of which more would come near the 65,535 iterations after which a software renderer ends a loop.
const int most_pilots_by_suns = 32768;

void sun_predict(Point point, inout Predicted sum) {
    Lobe lobe = lobe_towards(point.wo);
    int stride = 1 + pilot_count * sun_count / most_pilots_by_suns;
    float pilots_used = float((pilot_count + stride - 1) / stride), to_sums = float(pilot_count);
    for (int k = 0; k < sun_count; ++k) {
        Sun sun = sun_at(k);
        vec3 centre = sun.direction * point.frame;
        if (!reaches_above(sun, centre.z)) continue;
        float own = unit_disc_bandwidth / asin(min(sun.sine, 1.0)), steradians = solid_angle_of(sun), brightness = luminance(sun.radiance);
        float disc_density = float(disc_points) / steradians;
        float mean = 0.0, square = 0.0;
        for (int i = 0; i < disc_points; ++i) {
            vec3 wi = point_of_disc(centre, sun.versine, vec2((float(i) + 0.5) / float(disc_points), fract(0.618034 * float(i))));
            if (wi.z <= 0.0) continue;
            vec2 density;
            float f = luminance(evaluate_lobe(lobe, wi, density)), rho = lobe_bandwidth(point.wo, wi);
            float part = disc_density * density.y / (disc_density * density.y + pilots_used * density.x);
            float value = f * brightness * steradians * part, lambda = value / float(disc_points);
            sum.weighted += to_sums * lambda * bandwidth_at_eye(point, own, rho);
            mean += lambda;
            square += value * value / float(disc_points);
            float chi = f * brightness / wi.z;
            sum.printed += to_sums * steradians / (2.0 * pi * float(disc_points)) * chi * chi *
                           (min(own, point.frequency_limit) + min(rho, point.frequency_limit));
        }
        float variance = float(SAMPLES_TO_ONE_OF_A_SUN) * max(square - mean * mean, 0.0);
        float by_lobe = 0.0, lobe_square = 0.0;
        for (int i = 0; i < pilot_count; i += stride) {
            vec4 a = texelFetch(pilots, 2 * (point.first_pilot + i)), b = texelFetch(pilots, 2 * (point.first_pilot + i) + 1);
            vec3 wi = 2.0 * dot(point.wo, a.xyz) * a.xyz - point.wo;
            if (a.w == 0.0 || !is_within(sun, point.frame * wi)) continue;
            float value = a.w * brightness * pilots_used * b.w / (disc_density + pilots_used * b.w), lambda = value / pilots_used;
            sum.weighted += to_sums * lambda * bandwidth_at_eye(point, own, b.y);
            by_lobe += lambda;
            lobe_square += value * value / pilots_used;
        }
        sum.weights += to_sums * (mean + by_lobe);
        sum.mean += mean + by_lobe;
        sum.variance += variance + lobe_share * max(lobe_square - by_lobe * by_lobe, 0.0);
    }
}

#elif defined(PASS_SHADE)

#if defined(SAMPLER_CUT) || defined(SAMPLER_COMBINED)
const float lobe_samples = 0.5;  // of a pixel's samples, those of the lobe
#else
const float lobe_samples = 1.0;
#endif

// What is left to a sample of the lobe, where the sun is sampled as well: by the power heuristic (Veach 1997). By the balance heuristic a
// matte lobe's sample that happens to meet the disc, one in ten thousand, would count as much as one of the disc's own, and its pixel would
// stand out. density: of the lobe's sampler, a fraction.
float lobe_part_beside(Sun sun, vec2 density) {
    const float sun_samples_to_one_of_the_lobe = 1.0 / (float(SAMPLES_TO_ONE_OF_A_SUN) * lobe_samples);
    float others = sun_samples_to_one_of_the_lobe * density.y / solid_angle_of(sun), both = density.x + others;
    float part = density.x / both, other_part = others / both;
    return part * part / (part * part + other_part * other_part);
}

vec3 sun_of_sample(Pixel pixel, vec3 wi, vec3 direction, vec2 density, float footprints, bool wide) {
    vec3 light = vec3(0);
    for (int k = 0; k < sun_count; ++k) {
        Sun sun = sun_at(k);
        if (is_within(sun, direction)) light += lobe_part_beside(sun, density) * sun.radiance;
    }
    return light;
}

void sun_prepare(Pixel pixel) {}

// Adds to both replicates what their own samples of the discs bring, which are stratified alike: of each sun an even number of points, the
// even ones for the first replicate, the odd ones for the second. each: samples of the pixel that the sums are of.
void sun_samples(Pixel pixel, uvec2 each, inout vec4 sum, inout vec2 luminances, inout uint state) {
    float n = float(each.x + each.y), variance = 0.0;
    uint own = 2u * max((each.x + each.y) / (2u * SAMPLES_TO_ONE_OF_A_SUN), 1u);
    vec3 even = vec3(0), odd = vec3(0);
    for (int k = 0; k < sun_count; ++k) {
        Sun sun = sun_at(k);
        vec3 centre = sun.direction * pixel.frame, sums[2] = vec3[2](vec3(0), vec3(0));
        if (!reaches_above(sun, centre.z)) continue;
        uint turn = next_random(state);
        float offset = unit(next_random(state)), squares = 0.0;
        for (uint i = 0u; i < own; ++i) {
#if defined(SEQUENCE_RANDOM)
            vec2 u = vec2(unit(next_random(state)), unit(next_random(state)));
#else
            vec2 u = lattice_point(i, own, offset, turn);
#endif
            vec3 wi = point_of_disc(centre, sun.versine, u);
            if (wi.z <= 0.0) continue;
            vec2 density;
            vec3 value = evaluate_lobe(pixel.lobe, wi, density) * sun.radiance;
            value *= solid_angle_of(sun) * (1.0 - lobe_part_beside(sun, density));
            if ((i & 1u) == 0u)
                sums[0] += value;
            else
                sums[1] += value;
            float l = luminance(value);
            squares += l * l;
        }
        float half_of_own = 0.5 * float(own), mean = luminance(sums[0] + sums[1]) / float(own);
        even += sums[0] / half_of_own;
        odd += sums[1] / half_of_own;
        variance += max(squares / float(own) - mean * mean, 0.0) * n / float(own);
    }
    vec3 mean = (float(each.x) * even + float(each.y) * odd) / n;
    float l = luminance(mean);
    // The sum of squares of samples that each are greater by the mean, and as much more uncertain.
    sum.a += 2.0 * l * luminance(sum.rgb) + n * (l * l + variance);
    sum.rgb += n * mean;
    luminances += vec2(each) * vec2(luminance(even), luminance(odd));
}

#endif
