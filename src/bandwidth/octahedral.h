// Maps of bounded distortion from directions to the unit square, on which bandwidth is estimated: a latitude-longitude
// map diverges at its poles (its texels per radian are unbounded), these two do not.
#pragma once

#include <algorithm>
#include <cmath>

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

// Largest singular value of the Jacobian d(square)/d(direction): how many square sides a radian spans at most. A
// frequency of f cycles per side is at most f * stretch cycles per radian. Central differences; step is far above
// rounding (1e-16 / step) and far below curvature (step^2).
template <class Map>
double stretch(const Vec3& direction) {
    constexpr double step = 1e-5;
    const Frame3 frame(direction);
    const auto along = [&](const Vec3& tangent) {
        return (Map::to_square(glm::normalize(direction + step * tangent)) -
                Map::to_square(glm::normalize(direction - step * tangent))) / (2 * step);
    };
    const Vec2 a = along(frame.tangent), b = along(frame.bitangent);
    const double trace = glm::dot(a, a) + glm::dot(b, b), det = a.x * b.y - a.y * b.x;
    return std::sqrt(0.5 * (trace + std::sqrt(std::max(0.0, trace * trace - 4 * det * det))));
}

}  // namespace lightband
