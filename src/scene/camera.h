// A pinhole camera.
#pragma once

#include <cmath>

#include "base/error.h"
#include "base/math.h"

namespace lightband {

struct Camera {
    Vec3 eye, forward, right, up;  // unit axes, right-handed: right x up = -forward
    double fov_y;                  // radians
    double near_plane, far_plane;  // metres

    // Checks a description and fills in its defaults. LB_ERROR_INVALID_ARGUMENT names the field.
    static Camera from(const lb_camera_desc& desc);

    // tan(fov_y / 2) per half picture: the picture plane at distance 1 is 2 * plane_height high.
    double plane_height() const { return std::tan(fov_y / 2); }
    // Largest angle between neighbouring pixels' centres (eq. 6's max(f_x / W, f_y / H)): square pixels on a plane, so
    // it is found in the picture's centre, 2 tan(f_y / 2) / H.
    double radians_per_pixel(uint32_t height) const { return 2 * plane_height() / height; }

    // World axes, one unit of depth long.
    struct Rays {
        Vec3 first;        // through the centre of the top left pixel
        Vec3 right, down;  // from a pixel to the next
        Vec3 through(double x, double y) const { return first + x * right + y * down; }
    };
    Rays rays(uint32_t width, uint32_t height) const;
};

}  // namespace lightband
