#include "scene/unmeasured_cells.h"

#include <algorithm>
#include <optional>

#include "scene/table_cells.h"

namespace lightband {
namespace {

// The cells of one theta_half and one phi_diff that light and eye above the horizon can reach.
struct Arc {
    BrdfTable& table;
    uint32_t theta_half, phi_diff;
    uint32_t cells = 0;  // theta_diff below this

    Arc(BrdfTable& of, uint32_t half, uint32_t phi) : table(of), theta_half(half), phi_diff(phi) {
        while (cells < BrdfTable::theta_diff_cells && TableCell{half, cells, phi}.reaches_above_horizon()) ++cells;
    }

    float* rgb(uint32_t theta_diff) const { return &table.rgb[3 * BrdfTable::cell(theta_half, theta_diff, phi_diff)]; }
    bool has_value(uint32_t theta_diff) const { return rgb(theta_diff)[0] >= 0; }
};

// Fills the cells between two measured ones, of which one is missing at an end of the arc.
void fill_between(const Arc& arc, std::optional<uint32_t> before, std::optional<uint32_t> after) {
    const uint32_t first = before ? *before + 1 : 0, end = after ? *after : arc.cells;
    const float* from = arc.rgb(before ? *before : *after);
    const float* to = arc.rgb(after ? *after : *before);
    for (uint32_t cell = first; cell < end; ++cell) {
        const float t = before && after ? float(cell - *before) / float(*after - *before) : 0.0f;
        for (int c = 0; c < 3; ++c) arc.rgb(cell)[c] = (1 - t) * from[c] + t * to[c];
    }
}

// False: no cell of the arc was measured.
bool fill_along(const Arc& arc) {
    std::optional<uint32_t> before;
    for (uint32_t cell = 0; cell < arc.cells; ++cell) {
        if (!arc.has_value(cell)) continue;
        fill_between(arc, before, cell);
        before = cell;
    }
    if (before) fill_between(arc, before, std::nullopt);
    return before.has_value();
}

// Fills the whole arc from that of the next smaller theta_half, which reaches at least as far.
void fill_from_inner_arc(const Arc& arc) {
    if (arc.theta_half == 0 || arc.cells == 0) return;
    if (TableCell{arc.theta_half, 0, arc.phi_diff}.centre().theta_half < grazing_half_angle) return;
    for (uint32_t cell = 0; cell < arc.cells; ++cell)
        std::copy_n(&arc.table.rgb[3 * BrdfTable::cell(arc.theta_half - 1, cell, arc.phi_diff)], 3, arc.rgb(cell));
}

uint32_t cells_without_value(const Arc& arc) {
    uint32_t count = 0;
    for (uint32_t cell = 0; cell < arc.cells; ++cell) count += arc.has_value(cell) ? 0 : 1;
    return count;
}

}  // namespace

UnmeasuredCells fill_unmeasured_cells(BrdfTable& table) {
    UnmeasuredCells count;
    for (uint32_t half = 0; half < BrdfTable::theta_half_cells; ++half)
        for (uint32_t phi = 0; phi < BrdfTable::phi_diff_cells; ++phi) {
            const Arc arc(table, half, phi);
            const uint32_t unmeasured = cells_without_value(arc);
            if (unmeasured == 0) continue;
            if (!fill_along(arc)) fill_from_inner_arc(arc);
            const uint32_t left = cells_without_value(arc);
            count.filled += unmeasured - left;
            count.left += left;
        }
    return count;
}

}  // namespace lightband
