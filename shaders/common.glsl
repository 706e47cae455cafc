// What every pass shares: constants, the maps between directions and pictures, random bits.

const float pi = 3.14159265358979;
const float largest_float = 3.4028234e38;

float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

// Arc cosine for x in [0, 1], given 1 - x on its own so that small angles keep their digits: Abramowitz and Stegun 4.4.46,
// error at most 2e-8.
float acos_near(float x, float one_minus_x) {
    float p = -0.0012624911;
    p = p * x + 0.0066700901;
    p = p * x - 0.0170881256;
    p = p * x + 0.0308918810;
    p = p * x - 0.0501743046;
    p = p * x + 0.0889789874;
    p = p * x - 0.2145988016;
    p = p * x + 1.5707963050;
    return sqrt(max(one_minus_x, 0.0)) * p;
}

float polar_angle(float cosine) {
    float a = acos_near(abs(cosine), 1.0 - abs(cosine));
    return cosine < 0.0 ? pi - a : a;
}

// The angle of the line through the origin and (x, y), in [0, pi]; 0 where that is no line. Arc tangent by Abramowitz and Stegun
// 4.4.49, error at most 2e-8.
float angle_of_line(float y, float x) {
    float most = max(abs(x), abs(y)), t = most > 0.0 ? min(abs(x), abs(y)) / most : 0.0, t2 = t * t;
    float p = 0.0028662257;
    p = p * t2 - 0.0161657367;
    p = p * t2 + 0.0429096138;
    p = p * t2 - 0.0752896400;
    p = p * t2 + 0.1065626393;
    p = p * t2 - 0.1420889944;
    p = p * t2 + 0.1999355085;
    p = p * t2 - 0.3333314528;
    float angle = t + t * t2 * p;
    if (abs(y) > abs(x)) angle = 0.5 * pi - angle;
    return (x < 0.0) != (y < 0.0) && angle > 0.0 ? pi - angle : angle;
}

// Latitude-longitude maps: u, v in [0, 1], v down; +Y is up, u = 0.5 looks along +Z.
vec2 latitude_longitude(vec3 d) {
    float longitude = d.x == 0.0 && d.z == 0.0 ? 0.0 : atan(d.x, d.z);
    return vec2(0.5 - longitude / (2.0 * pi), polar_angle(clamp(d.y, -1.0, 1.0)) / pi);
}

// The octahedral square around +Y, in [0, 1]^2 (src/bandwidth/octahedral.h).
vec2 fold(vec2 p) { return (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0); }
// A texel of a square of so many a side covers 4 reach^3 / side^2 steradians.
float octahedral_reach(vec3 d) { return abs(d.x) + abs(d.y) + abs(d.z); }
vec2 octahedral(vec3 d) {
    vec2 p = d.xz / octahedral_reach(d);
    return 0.5 * (d.y < 0.0 ? fold(p) : p) + 0.5;
}
vec3 octahedral_direction(vec2 square) {
    vec2 p = 2.0 * square - 1.0;
    float y = 1.0 - abs(p.x) - abs(p.y);
    if (y < 0.0) p = fold(p);
    return normalize(vec3(p.x, y, p.y));
}

// Across an edge of the octahedral square lies the same edge, mirrored about its middle; a small square may be left twice.
ivec2 octahedral_border(ivec2 at, int side) {
    while (at.x < 0 || at.x >= side) at = ivec2(at.x < 0 ? -1 - at.x : 2 * side - 1 - at.x, side - 1 - at.y);
    while (at.y < 0 || at.y >= side) at = ivec2(side - 1 - at.x, at.y < 0 ? -1 - at.y : 2 * side - 1 - at.y);
    return at;
}

// The frame in which wo has azimuth 0: columns tangent, bitangent, normal.
mat3 local_frame(vec3 n, vec3 wo) {
    vec3 along = wo - dot(wo, n) * n;
    float squared = dot(along, along);
    // Below this (2^-23 squared, and a little) the azimuth is the rounding of wo, and any tangent serves.
    vec3 other = abs(n.x) < 0.5 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    vec3 tangent = squared > 1e-13 ? along * inversesqrt(squared) : normalize(cross(other, n));
    return mat3(tangent, cross(n, tangent), n);
}

#include "hash.glsl"

// The same as a generator.
uint next_random(inout uint state) {
    uint result = hash(state);
    state = state * 747796405u + 2891336453u;
    return result;
}

// 24 bits, all that a float holds: in [0, 1).
float unit(uint bits) { return float(bits >> 8) * 5.9604644775390625e-8; }
