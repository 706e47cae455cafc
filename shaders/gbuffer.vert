// Geometry pass: section 3, "Render G-buffers".
uniform mat4 to_eye;      // object to a frame at the eye with world axes: large coordinates cancel in double precision
uniform mat4 projection;  // that frame to clip space, row 0 of the picture at the top
uniform mat3 normal_matrix;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

out vec3 shading_normal;

void main() {
    vec3 from_eye = (to_eye * vec4(position, 1.0)).xyz;
    shading_normal = normal_matrix * normal;
    gl_Position = projection * vec4(from_eye, 1.0);
}
