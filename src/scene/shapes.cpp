// The computed shapes: surfaces of two parameters, sampled on a grid, normals by central differences.
#include <cmath>
#include <algorithm>
#include <functional>

#include "scene/triangles.h"

namespace lightband {
namespace {

using Surface = std::function<Vec3(double u, double v)>;  // u, v in [0, 1]

Vec3 sphere_direction(double u, double v) {
    return {std::sin(pi * v) * std::sin(2 * pi * u), std::cos(pi * v), std::sin(pi * v) * std::cos(2 * pi * u)};
}

// A sphere whose radius swells and dips with a few low waves of the direction, so that it stays smooth at the poles.
Vec3 blob(double u, double v) {
    const Vec3 d = sphere_direction(u, v);
    const double waves = 0.11 * std::sin(5.1 * d.x + 0.8) * std::sin(4.7 * d.y) + 0.09 * std::sin(6.3 * d.z - 4.1 * d.y + 0.5) +
                         0.05 * std::cos(7.3 * d.x * d.z + 3.0 * d.y);
    return 0.42 * (1 + waves) * d;
}

Vec3 torus(double u, double v) {
    // Downwards on the outside, as the sphere: normals point outwards.
    const double a = 2 * pi * u, b = 2 * pi * v, r = 0.34 + 0.14 * std::cos(b);
    return {r * std::sin(a), -0.14 * std::sin(b), r * std::cos(a)};
}

// A trefoil; the tube's cross-section turns in the frame of the curve's tangent and radius.
Vec3 trefoil(double t) {
    return Vec3(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)) * 0.148;
}
Vec3 knot(double u, double v) {
    const double t = 2 * pi * u, step = 1e-4;
    const Vec3 centre = trefoil(t);
    const Vec3 tangent = glm::normalize(trefoil(t + step) - trefoil(t - step));
    const Vec3 side = glm::normalize(glm::cross(tangent, Vec3(0, 0, 1)));
    const Vec3 other = glm::cross(side, tangent);
    return centre + 0.085 * (std::cos(2 * pi * v) * side - std::sin(2 * pi * v) * other);
}

Triangles grid(const Surface& surface, uint32_t columns, uint32_t rows) {
    Triangles mesh;
    // Central differences in double precision: far above rounding (1e-16 / step), far below the shape (step).
    constexpr double step = 1e-5;
    for (uint32_t j = 0; j <= rows; ++j)
        for (uint32_t i = 0; i <= columns; ++i) {
            const double u = double(i) / columns, v = double(j) / rows;
            // At a pole all u meet: the normal is taken just beside it.
            const double inside = std::min(std::max(v, 1e-4), 1 - 1e-4);
            const Vec3 p = surface(u, v);
            const Vec3 n = glm::normalize(glm::cross(surface(u, inside + step) - surface(u, inside - step),
                                                     surface(u + step, inside) - surface(u - step, inside)));
            for (int c = 0; c < 3; ++c) {
                mesh.positions.push_back(float(p[c]));
                mesh.normals.push_back(float(n[c]));
            }
            mesh.texcoords.insert(mesh.texcoords.end(), {float(u), float(v)});
        }
    for (uint32_t j = 0; j < rows; ++j)
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});
        }
    return mesh;
}

}  // namespace

Triangles Triangles::shape(const std::string& name, uint32_t resolution) {
    const uint32_t n = resolution == 0 ? 256 : resolution;
    if (n < 8 || n > 2048)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("resolution is ", resolution, "; it must be 0 or 8 .. 2048"));
    if (name == "sphere") return grid([](double u, double v) { return 0.5 * sphere_direction(u, v); }, n, n / 2);
    if (name == "blob") return grid(blob, n, n / 2);
    if (name == "torus") return grid(torus, n, n / 2);
    if (name == "knot") return grid(knot, 4 * std::min(n, 512u), n / 2);
    if (name == "plane") return grid([](double u, double v) { return Vec3(u - 0.5, 0.5 - v, 0); }, 1, 1);
    throw Error(LB_ERROR_INVALID_ARGUMENT, text("there is no shape \"", name, "\"; there are sphere, plane, torus, knot, blob"));
}

}  // namespace lightband
