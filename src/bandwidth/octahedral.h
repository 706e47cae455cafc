// Maps of bounded distortion from directions to the unit square, on which bandwidth is estimated: a latitude-longitude
// map diverges at its poles (its texels per radian are unbounded), these two do not.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/math.h"

namespace lightband {

// The whole sphere: an octahedron unfolded around +Y; the square's centre is +Y, its corners are -Y.
struct Octahedral {
    static Vec2 to_square(const Vec3& d) {
        const double norm = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
        Vec2 p(d.x / norm, d.z / norm);
        if (d.y < 0) p = Vec2((1 - std::abs(p.y)) * (p.x < 0 ? -1 : 1), (1 - std::abs(p.x)) * (p.y < 0 ? -1 : 1));
        return 0.5 * p + Vec2(0.5);
    }
    static Vec3 to_direction(const Vec2& square) {
        Vec2 p = 2.0 * square - Vec2(1);
        const double y = 1 - std::abs(p.x) - std::abs(p.y);
        if (y < 0) p = Vec2((1 - std::abs(p.y)) * (p.x < 0 ? -1 : 1), (1 - std::abs(p.x)) * (p.y < 0 ? -1 : 1));
        return glm::normalize(Vec3(p.x, y, p.y));
    }
};

// The upper hemisphere (+Z): the pyramid's base fills the square, its edge is the horizon.
struct HemiOctahedral {
    static Vec2 to_square(const Vec3& d) {
        const double norm = std::abs(d.x) + std::abs(d.y) + d.z;
        const Vec2 p(d.x / norm, d.y / norm);
        return {0.5 * (p.x + p.y) + 0.5, 0.5 * (p.x - p.y) + 0.5};
    }
    static Vec3 to_direction(const Vec2& square) {
        const Vec2 q = 2.0 * square - Vec2(1);
        const Vec2 p(0.5 * (q.x + q.y), 0.5 * (q.x - q.y));
        return glm::normalize(Vec3(p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y)));
    }
};

// Largest singular value of the Jacobian d(square) / d(direction): how many square sides a radian spans at most. A frequency
// of f cycles per side is at most f * stretch cycles per radian. With p = (u, v) / s, s = |x| + |y| + |z|, the Jacobian is
// (e_u - p_u (1, 1, 1), e_v - p_v (1, 1, 1)) / s in the first octant, and the others mirror it.
inline double octahedral_stretch(double u, double v, double w, double square_sides) {
    const double s = std::abs(u) + std::abs(v) + std::abs(w), a = std::abs(u) / s, b = std::abs(v) / s;
    const double aa = (1 - a) * (1 - a) + 2 * a * a, bb = (1 - b) * (1 - b) + 2 * b * b, ab = 3 * a * b - a - b;
    const double half = 0.5 * (aa - bb);
    return square_sides / s * std::sqrt(0.5 * (aa + bb) + std::sqrt(half * half + ab * ab));
}
// The side, a power of two in [smallest, largest], whose texels are about as wide as those of a latitude-longitude map.
inline uint32_t octahedral_side(uint32_t map_height, uint32_t smallest, uint32_t largest) {
    uint32_t side = smallest;
    while (side < map_height && side < largest) side *= 2;
    return side;
}

// Lookups along each side of a texel of an octahedral square so that they lie no farther apart than the texels of a
// latitude-longitude map, also where the square's are widest (their mean width is sqrt(4 pi) / side radians; the largest is 1.7
// times that).
inline int32_t octahedral_supersampling(uint32_t map_height, uint32_t side) {
    return std::max(1, int32_t(std::ceil(1.7 * std::sqrt(4 * pi) / side * map_height / pi)));
}
inline double stretch(const Octahedral&, const Vec3& d) { return octahedral_stretch(d.x, d.z, d.y, 0.5); }
inline double stretch(const HemiOctahedral&, const Vec3& d) { return octahedral_stretch(d.x, d.y, d.z, std::sqrt(0.5)); }

}  // namespace lightband
