// The eye's rays through the centres of the pixels: world axes, one unit of depth long (src/scene/camera.h).
uniform vec3 first_ray;            // through pixel (0, 0)
uniform vec3 ray_right, ray_down;  // from a pixel to the next

vec3 ray_through(vec2 at) { return first_ray + at.x * ray_right + at.y * ray_down; }
