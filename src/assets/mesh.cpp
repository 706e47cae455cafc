#include "assets/mesh.h"

namespace lightband {

Mesh::Mesh(gl::DevicePtr device, Triangles triangles)
    : device_(std::move(device)), index_count_(GLsizei(triangles.indices.size())) {
    triangles.order_for_drawing();
    const gl::Functions& gl = device_->gl();
    positions_ = gl::Buffer(gl, triangles.positions.size() * sizeof(float), triangles.positions.data());
    normals_ = gl::Buffer(gl, triangles.normals.size() * sizeof(float), triangles.normals.data());
    indices_ = gl::Buffer(gl, triangles.indices.size() * sizeof(uint32_t), triangles.indices.data());
    vertex_array_ = gl::VertexArray(gl);
    const GLuint array = vertex_array_.name();
    for (GLuint attribute = 0; attribute < 2; ++attribute) {
        gl.EnableVertexArrayAttrib(array, attribute);
        gl.VertexArrayAttribFormat(array, attribute, 3, GL_FLOAT, GL_FALSE, 0);
        gl.VertexArrayAttribBinding(array, attribute, attribute);
        gl.VertexArrayVertexBuffer(array, attribute, attribute == 0 ? positions_.name() : normals_.name(), 0, 3 * sizeof(float));
    }
    gl.VertexArrayElementBuffer(array, indices_.name());
    stats_.vertices = uint32_t(triangles.vertex_count());
    stats_.triangles = uint32_t(triangles.indices.size() / 3);
    stats_.dropped_triangles = triangles.dropped;
    triangles.bounds(stats_.bounds_min, stats_.bounds_max);
    device_->check("uploading a mesh");
}

}  // namespace lightband
