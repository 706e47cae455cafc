#include "passes/gbuffer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "gl/dispatch.h"

namespace lightband::passes {
namespace {

// A mesh is drawn in so many pieces: a software renderer fills the pixels of one on all cores while one core sets up the next.
// Of 4 to 32 pieces of 70,000 triangles, 8 took least: three quarters of the time of one.
constexpr GLsizei pieces = 8;

// From the eye's frame with world axes to clip space. Row 0 of the picture lies at the top, and depth is reversed (1 near,
// 0 far): floating-point depth then keeps its digits from 1e-4 to 1e6.
glm::dmat4 projection(const Camera& camera, uint32_t width, uint32_t height) {
    const double h = camera.plane_height(), w = h * width / height;
    const double n = camera.near_plane, f = camera.far_plane;
    const Vec3 rows[3] = {camera.right / w, -camera.up / h, camera.forward * (-n / (f - n))};
    glm::dmat4 m(0);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) m[column][row] = rows[row][column];
        m[column][3] = camera.forward[column];
    }
    m[3][2] = n * f / (f - n);
    return m;
}

// Normals keep their directions, in whatever units: a scale of 1e-20 or 1e20 would leave the range of float squared.
glm::dmat3 directions_of_normals(const glm::dmat4& transform) {
    const glm::dmat3 normals = glm::transpose(glm::inverse(glm::dmat3(transform)));
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) largest = std::max(largest, std::abs(normals[column][row]));
    return normals / largest;
}

void draw(gl::Device& device, const gl::Program& program, const Instance& instance, uint32_t number, const Camera& camera) {
    const gl::Functions& gl = device.gl();
    glm::dmat4 to_eye = instance.transform.matrix;
    to_eye[3] -= glm::dvec4(camera.eye, 0);
    const glm::mat4 to_eye_float(to_eye);
    const glm::mat3 normals(directions_of_normals(instance.transform.matrix));
    program.set_matrix4("to_eye", glm::value_ptr(to_eye_float));
    program.set_matrix3("normal_matrix", glm::value_ptr(normals));
    program.set("instance", number + 1);
    if (instance.double_sided) {
        gl.Disable(GL_CULL_FACE);
    } else {
        gl.Enable(GL_CULL_FACE);  // of back faces
        // A mirrored instance is wound the other way round; so is the picture, whose row 0 lies at the top.
        gl.FrontFace(glm::determinant(glm::dmat3(instance.transform.matrix)) > 0 ? GL_CW : GL_CCW);
    }
    gl.BindVertexArray(instance.mesh->vertex_array().name());
    const GLsizei all = instance.mesh->index_count(), piece = 3 * ((all / 3 + pieces - 1) / pieces);
    for (GLsizei first = 0; first < all; first += piece) {
        const size_t offset = size_t(first) * sizeof(uint32_t);
        gl.DrawElements(GL_TRIANGLES, std::min(piece, all - first), GL_UNSIGNED_INT, reinterpret_cast<const void*>(offset));
        gl.Flush();
    }
}

}  // namespace

void set_rays(const gl::Program& program, const Camera::Rays& rays) {
    for (const auto& [name, ray] : {std::pair("first_ray", rays.first), {"ray_right", rays.right}, {"ray_down", rays.down}})
        program.set(name, {float(ray.x), float(ray.y), float(ray.z)});
}

void bind_surfaces(const gl::Functions& gl, const gl::Program& program, const GBuffer& gbuffer) {
    set_rays(program, gbuffer.rays);
    bind_texture(gl, 14, gbuffer.surface);
}

void gbuffer(gl::Device& device, const Scene& scene, uint32_t width, uint32_t height, GBuffer* target) {
    const gl::Functions& gl = device.gl();
    const Camera& camera = *scene.camera;
    const gl::Framebuffer framebuffer(gl);
    target->rays = camera.rays(width, height);
    const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    gl.NamedFramebufferTexture(framebuffer.name(), attachments[0], target->surface.name(), 0);
    gl.NamedFramebufferTexture(framebuffer.name(), attachments[1], target->material.name(), 0);
    gl.NamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, target->depth.name(), 0);
    gl.NamedFramebufferDrawBuffers(framebuffer.name(), 2, attachments);
    if (gl.CheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw Error(LB_ERROR_DEVICE, "geometry pass: the driver cannot draw into the G-buffer's formats");

    const float zero[4] = {0, 0, 0, 0};
    gl.ClearTexImage(target->surface.name(), 0, GL_RGBA, GL_FLOAT, zero);
    gl.ClearTexImage(target->material.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
    gl.ClearNamedFramebufferfv(framebuffer.name(), GL_DEPTH, 0, zero);

    const gl::Program& program = device.graphics("gbuffer");
    const glm::mat4 clip(projection(camera, width, height));
    program.set_matrix4("projection", glm::value_ptr(clip));
    set_rays(program, target->rays);
    program.set("forward", {float(camera.forward.x), float(camera.forward.y), float(camera.forward.z)});
    program.use();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl.Viewport(0, 0, GLsizei(width), GLsizei(height));
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    for (uint32_t i = 0; i < scene.instances().size(); ++i) draw(device, program, scene.instances()[i], i, camera);
    gl.BindVertexArray(0);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.MemoryBarrier(everything);
}

}  // namespace lightband::passes
