// The sun, as numbers: a disc of uniform radiance, infinitely far away.
#pragma once

#include "base/math.h"

namespace lightband {

struct Sun {
    // Radians. The sun as it is seen from the earth; less than the least, a disc's edge would be lost in the rounding
    // of floats.
    static constexpr double standard_radius = 0.004652, least_radius = 1e-4, largest_radius = pi / 2;

    Vec3 direction{0, 1, 0};  // unit, towards the sun
    double angular_radius = standard_radius;
    Vec3 irradiance{0};  // on a surface that faces it

    // Irradiance is that radiance times the integral of the cosine over the disc, pi sin^2 of its radius.
    Vec3 radiance() const { return irradiance / projected_solid_angle(); }
    double projected_solid_angle() const { return pi * std::sin(angular_radius) * std::sin(angular_radius); }
    // 1 - cos of its radius; small ones keep their digits.
    double versine() const { return 2 * std::sin(angular_radius / 2) * std::sin(angular_radius / 2); }
    double solid_angle() const { return 2 * pi * versine(); }
    // By the length of the chord, which keeps the digits of small angles. direction: unit.
    bool contains(const Vec3& from) const { return glm::dot(from - direction, from - direction) < 2 * versine(); }
    // Even in solid angle. u: in [0, 1)^2.
    Vec3 sample(const Vec2& u) const;
};

}  // namespace lightband
