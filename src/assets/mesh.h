// Triangles on a device.
#pragma once

#include "gl/objects.h"
#include "scene/triangles.h"

namespace lightband {

class Mesh {
public:
    Mesh(gl::DevicePtr device, Triangles triangles);

    const gl::DevicePtr& device() const { return device_; }
    const gl::VertexArray& vertex_array() const { return vertex_array_; }
    GLsizei index_count() const { return index_count_; }
    const lb_mesh_stats& stats() const { return stats_; }
    size_t device_bytes() const { return positions_.bytes() + normals_.bytes() + indices_.bytes(); }

private:
    gl::DevicePtr device_;
    gl::Buffer positions_, normals_, indices_;
    gl::VertexArray vertex_array_;
    GLsizei index_count_;
    lb_mesh_stats stats_ = LB_MESH_STATS_INIT;
};

}  // namespace lightband
