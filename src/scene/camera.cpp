#include "scene/camera.h"

#include <cmath>

namespace lightband {
namespace {

Vec3 finite_vector(const float (&v)[3], const char* field) {
    for (float component : v)
        if (!std::isfinite(component))
            throw Error(LB_ERROR_INVALID_ARGUMENT, text("camera: ", field, " holds ", component, "; it must be finite"));
    return {v[0], v[1], v[2]};
}

double number_or(float value, double otherwise, const char* field) {
    if (!std::isfinite(value) || value < 0)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("camera: ", field, " is ", value, "; it must be finite and not negative"));
    return value == 0 ? otherwise : double(value);
}

}  // namespace

Camera Camera::from(const lb_camera_desc& desc) {
    Camera camera;
    camera.eye = finite_vector(desc.eye, "eye");
    const Vec3 view = finite_vector(desc.target, "target") - camera.eye;
    const double distance = glm::length(view);
    if (distance == 0) throw Error(LB_ERROR_INVALID_ARGUMENT, "camera: target is the same point as eye");
    camera.forward = view / distance;

    Vec3 up = finite_vector(desc.up, "up");
    if (up == Vec3(0)) up = Vec3(0, 1, 0);
    const Vec3 right = glm::cross(camera.forward, glm::normalize(up));
    // Directions come as float: below ten of its roundings (2^-23) the roll of the camera is noise.
    constexpr double parallel = 1e-6;
    if (!(glm::length(right) > parallel))
        throw Error(LB_ERROR_INVALID_ARGUMENT, "camera: up is parallel to the view direction; the roll is undefined");
    camera.right = glm::normalize(right);
    camera.up = glm::cross(camera.right, camera.forward);

    camera.fov_y = number_or(desc.fov_y, 0.7, "fov_y");
    // There the picture is two thousand times as wide as it is far away.
    constexpr double flattest = 1e-3;
    if (!(camera.fov_y < pi - flattest))
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("camera: fov_y is ", desc.fov_y, "; it must be below pi - 0.001 radians"));
    camera.near_plane = number_or(desc.near_plane, 1e-3 * distance, "near_plane");
    camera.far_plane = number_or(desc.far_plane, 1e3 * distance, "far_plane");
    // Beyond these a depth, or its reciprocal times another, leaves the range of normal floats.
    // As float, in which they come, so that the limits themselves are accepted.
    constexpr float nearest = 1e-30f, farthest = 1e30f;
    if (!(camera.near_plane >= nearest))
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("camera: near_plane is ", camera.near_plane, "; it must be at least 1e-30"));
    if (!(camera.far_plane <= farthest))
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("camera: far_plane is ", camera.far_plane, "; it must be at most 1e+30"));
    if (!(camera.near_plane < camera.far_plane))
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text("camera: near_plane ", camera.near_plane, " must be below far_plane ", camera.far_plane));
    return camera;
}

Camera::Rays Camera::rays(uint32_t width, uint32_t height) const {
    const double step = radians_per_pixel(height);  // at depth 1
    Rays result{forward, right * step, -up * step};
    result.first += (0.5 - 0.5 * width) * result.right + (0.5 - 0.5 * height) * result.down;
    return result;
}

}  // namespace lightband
