// Vectors and constants in the double precision of the CPU side.
#pragma once

#include <glm/glm.hpp>

namespace lightband {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;

constexpr double pi = 3.14159265358979323846;

inline double luminance(const Vec3& rgb) { return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z; }

// A right-handed frame around a unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
struct Frame3 {
    Vec3 tangent, bitangent, normal;

    explicit Frame3(const Vec3& n) : normal(n) {
        const double sign = n.z >= 0 ? 1.0 : -1.0;
        const double a = -1.0 / (sign + n.z);
        const double b = n.x * n.y * a;
        tangent = Vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        bitangent = Vec3(b, sign + n.y * n.y * a, -n.y);
    }

    // The frame whose tangent lies in the plane of the normal and wo: an isotropic BRDF sees wo at azimuth 0.
    Frame3(const Vec3& n, const Vec3& wo) : Frame3(n) {
        const Vec3 along = wo - glm::dot(wo, n) * n;
        const double length = glm::length(along);
        // Below this the azimuth of wo is rounding noise, and any tangent serves.
        constexpr double azimuth_undefined = 1e-12;
        if (length > azimuth_undefined) {
            tangent = along / length;
            bitangent = glm::cross(n, tangent);
        }
    }

    Vec3 to_local(const Vec3& v) const { return {glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal)}; }
    Vec3 to_world(const Vec3& v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
};

}  // namespace lightband
