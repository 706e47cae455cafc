#include "scene/sun.h"

#include <cmath>

namespace lightband {

Vec3 Sun::sample(const Vec2& u) const {
    const double down = u.x * versine(), sine = std::sqrt(down * (2 - down)), azimuth = 2 * pi * u.y;
    const Vec3 other = std::abs(direction.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 tangent = glm::normalize(glm::cross(other, direction)), bitangent = glm::cross(direction, tangent);
    return (1 - down) * direction + sine * (std::cos(azimuth) * tangent + std::sin(azimuth) * bitangent);
}

}  // namespace lightband
