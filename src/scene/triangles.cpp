#include "scene/triangles.h"

#include <algorithm>
#include <cmath>
#include <meshoptimizer.h>

namespace lightband {
namespace {

Vec3 vector_at(const std::vector<float>& v, size_t i) { return {v[3 * i], v[3 * i + 1], v[3 * i + 2]}; }

std::vector<float> finite_values(const float* values, size_t vertices, size_t components, const char* field) {
    for (size_t i = 0; i < vertices * components; ++i)
        if (!std::isfinite(values[i]))
            throw Error(LB_ERROR_INVALID_ARGUMENT, text("mesh: ", field, "[", i / components, "][", i % components, "] is ",
                                                        values[i], "; it must be finite"));
    return std::vector<float>(values, values + vertices * components);
}

void normalise(std::vector<float>* normals) {
    for (size_t i = 0; i < normals->size() / 3; ++i) {
        const Vec3 n = vector_at(*normals, i);
        const double length = glm::length(n);
        if (length == 0) throw Error(LB_ERROR_INVALID_ARGUMENT, text("mesh: normals[", i, "] has length 0"));
        for (int c = 0; c < 3; ++c) (*normals)[3 * i + size_t(c)] = float(n[c] / length);
    }
}

Vec3 facet(const Triangles& mesh, size_t triangle) {
    const Vec3 a = vector_at(mesh.positions, mesh.indices[3 * triangle]);
    return glm::cross(vector_at(mesh.positions, mesh.indices[3 * triangle + 1]) - a,
                      vector_at(mesh.positions, mesh.indices[3 * triangle + 2]) - a);
}

void drop_empty(Triangles* mesh) {
    size_t kept = 0;
    const size_t count = mesh->indices.size() / 3;
    for (size_t t = 0; t < count; ++t) {
        if (glm::length(facet(*mesh, t)) == 0) continue;
        std::copy_n(&mesh->indices[3 * t], 3, &mesh->indices[3 * kept++]);
    }
    mesh->indices.resize(3 * kept);
    mesh->dropped = uint32_t(count - kept);
    if (kept == 0) throw Error(LB_ERROR_INVALID_ARGUMENT, text("mesh: all ", count, " triangles have zero area"));
}

// Area-weighted. Where triangles of both windings share a vertex, as of a sheet that was given two sides, their sum says nothing: there
// the largest of them speaks.
void compute_normals(Triangles* mesh) {
    const size_t vertices = mesh->vertex_count();
    std::vector<Vec3> sums(vertices, Vec3(0)), largest(vertices, Vec3(0));
    std::vector<double> areas(vertices);
    for (size_t t = 0; t < mesh->indices.size() / 3; ++t) {
        const Vec3 own = facet(*mesh, t);
        const double area = glm::length(own);
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = mesh->indices[3 * t + size_t(corner)];
            sums[vertex] += own;
            areas[vertex] += area;
            if (area > glm::length(largest[vertex])) largest[vertex] = own;
        }
    }
    // Positions are floats: facets that cancel leave up to a rounding (2^-24) of each of theirs.
    constexpr double cancelled = 1e-6;
    mesh->normals.resize(mesh->positions.size());
    for (size_t i = 0; i < vertices; ++i) {
        const Vec3 told = glm::length(sums[i]) > cancelled * areas[i] ? sums[i] : largest[i];
        // A vertex without triangles is never drawn; any unit normal serves.
        const Vec3 n = areas[i] > 0 ? glm::normalize(told) : Vec3(0, 0, 1);
        for (int c = 0; c < 3; ++c) mesh->normals[3 * i + size_t(c)] = float(n[c]);
    }
}

}  // namespace

Triangles Triangles::from(const lb_mesh_desc& desc) {
    if (desc.vertex_count == 0 || desc.positions == nullptr)
        throw Error(LB_ERROR_INVALID_ARGUMENT, "mesh: it has no vertices (vertex_count 0 or positions NULL)");
    if (desc.triangle_count == 0 || desc.indices == nullptr)
        throw Error(LB_ERROR_INVALID_ARGUMENT, "mesh: it has no triangles (triangle_count 0 or indices NULL)");
    // OpenGL counts indices in a signed 32-bit number.
    constexpr uint32_t most_triangles = 0x7fffffffu / 3;
    if (desc.triangle_count > most_triangles)
        throw Error(LB_ERROR_LIMIT, text("mesh: triangle_count ", desc.triangle_count, " exceeds ", most_triangles));
    Triangles mesh;
    mesh.positions = finite_values(desc.positions, desc.vertex_count, 3, "positions");
    if (desc.texcoords != nullptr) mesh.texcoords = finite_values(desc.texcoords, desc.vertex_count, 2, "texcoords");
    for (size_t i = 0; i < size_t(desc.triangle_count) * 3; ++i)
        if (desc.indices[i] >= desc.vertex_count)
            throw Error(LB_ERROR_INVALID_ARGUMENT, text("mesh: indices[", i, "] is ", desc.indices[i], "; it must be below ",
                                                        "vertex_count ", desc.vertex_count));
    mesh.indices.assign(desc.indices, desc.indices + size_t(desc.triangle_count) * 3);
    drop_empty(&mesh);
    if (desc.normals != nullptr) {
        mesh.normals = finite_values(desc.normals, desc.vertex_count, 3, "normals");
        normalise(&mesh.normals);
    } else {
        compute_normals(&mesh);
    }
    return mesh;
}

void Triangles::order_for_drawing() {
    const size_t vertices = vertex_count();
    meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices);
    constexpr uint32_t unused = ~0u;
    std::vector<uint32_t> place(vertices);
    uint32_t next = uint32_t(meshopt_optimizeVertexFetchRemap(place.data(), indices.data(), indices.size(), vertices));
    for (uint32_t& to : place)
        if (to == unused) to = next++;
    meshopt_remapIndexBuffer(indices.data(), indices.data(), indices.size(), place.data());
    for (const auto& [values, components] : {std::pair(&positions, 3), std::pair(&normals, 3), std::pair(&texcoords, 2)}) {
        const size_t bytes = size_t(components) * sizeof(float);
        if (!values->empty()) meshopt_remapVertexBuffer(values->data(), values->data(), vertices, bytes, place.data());
    }
}

void Triangles::bounds(float (&low)[3], float (&high)[3]) const {
    for (size_t c = 0; c < 3; ++c) {
        low[c] = high[c] = positions[c];
        for (size_t i = c; i < positions.size(); i += 3) {
            low[c] = std::min(low[c], positions[i]);
            high[c] = std::max(high[c], positions[i]);
        }
    }
}

}  // namespace lightband
