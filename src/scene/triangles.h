// Triangles on the host: checked, cleaned, with normals.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/math.h"

namespace lightband {

struct Triangles {
    std::vector<float> positions;  // 3 per vertex, metres
    std::vector<float> normals;    // 3 per vertex, unit
    std::vector<float> texcoords;  // 2 per vertex, or empty
    std::vector<uint32_t> indices; // 3 per triangle
    uint32_t dropped = 0;          // triangles of zero area that were left out

    size_t vertex_count() const { return positions.size() / 3; }

    // Checks a description (LB_ERROR_INVALID_ARGUMENT names field, index and value), drops triangles of zero area and
    // computes missing normals, area-weighted.
    static Triangles from(const lb_mesh_desc& desc);
    // The shapes of lb_mesh_builtin.
    static Triangles shape(const std::string& name, uint32_t resolution);

    // Triangles that share vertices follow each other, and vertices lie as these use them; those that none uses come last. A device then
    // transforms a vertex once, not for every triangle around it.
    void order_for_drawing();

    void bounds(float (&low)[3], float (&high)[3]) const;
};

}  // namespace lightband
