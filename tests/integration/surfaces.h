// Surfaces made to order: a normal for each pixel, a crease.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "rendering.h"

namespace lightband::testing {

// A wall one unit before an eye at the origin that looks along -Z, in squares that each fill one pixel and have one normal.
class Patches {
public:
    Patches(int columns, int rows, double unit = 1) : columns_(columns), rows_(rows), unit_(unit) {}

    void add(int column, int row, const Vec3& normal) {
        const auto first = uint32_t(positions_.size() / 3);
        for (const auto& [right, down] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
            append(&positions_, unit_ * point(column + right, row + down));
            append(&normals_, normal);
        }
        for (const uint32_t corner : {0u, 2u, 1u, 0u, 3u, 2u}) indices_.push_back(first + corner);
    }

    // Towards the eye, from a pixel's centre.
    Vec3 to_eye(int column, int row) const { return -glm::normalize(point(column + 0.5, row + 0.5)); }

    Scene scene(const wrapper::Brdf& brdf, const Environment& light) const {
        lb_mesh_desc desc = LB_MESH_DESC_INIT;
        desc.positions = positions_.data();
        desc.normals = normals_.data();
        desc.vertex_count = uint32_t(positions_.size() / 3);
        desc.indices = indices_.data();
        desc.triangle_count = uint32_t(indices_.size() / 3);
        Scene scene = software().scene();
        scene.add(software().mesh(desc), brdf);
        scene.set_environment(light);
        scene.set_camera({{0, 0, 0}, {0, 0, float(-unit_)}});
        return scene;
    }

private:
    static void append(std::vector<float>* values, const Vec3& v) {
        values->insert(values->end(), {float(v.x), float(v.y), float(v.z)});
    }
    Vec3 point(double column, double row) const {
        const double pixel = 2 * std::tan(0.7 / 2) / rows_;  // the default field of view
        return {(column - 0.5 * columns_) * pixel, (0.5 * rows_ - row) * pixel, -1};
    }

    int columns_, rows_;
    double unit_;  // metres
    std::vector<float> positions_, normals_;
    std::vector<uint32_t> indices_;
};

// A normal seen under this cosine that lies on the side of the wall that faces the eye.
inline Vec3 normal_under(double cosine, const Vec3& to_eye) {
    const Vec3 tangent = glm::normalize(Vec3(0, 0, 1) - to_eye.z * to_eye);
    return cosine * to_eye + std::sqrt(1 - cosine * cosine) * tangent;
}

// A ridge along Y: two planes that meet at a right angle, one metre before an eye at the origin, with a normal each.
inline Mesh ridge() {
    const float h = std::sqrt(0.5f);
    const float positions[] = {-1, -1, -2, 0, -1, -1, 0, 1, -1, -1, 1, -2, 0, -1, -1, 1, -1, -2, 1, 1, -2, 0, 1, -1};
    const float normals[] = {-h, 0, h, -h, 0, h, -h, 0, h, -h, 0, h, h, 0, h, h, 0, h, h, 0, h, h, 0, h};
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    lb_mesh_desc desc = LB_MESH_DESC_INIT;
    desc.positions = positions;
    desc.normals = normals;
    desc.vertex_count = 8;
    desc.indices = indices;
    desc.triangle_count = 4;
    return software().mesh(desc);
}

}  // namespace lightband::testing
