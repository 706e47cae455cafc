#include "materials/reflectance_model.h"

#include <cmath>

#include "base/error.h"
#include "scene/table_cells.h"

namespace lightband {

namespace {

constexpr Vec3 not_measured(-1.0);

}  // namespace

Vec3 cell_value(const ReflectanceModel& model, size_t cell) {
    const TableCell place = TableCell::numbered(cell);
    if (!place.reaches_above_horizon()) return not_measured;
    const TableAngles at = place.representative();
    const Vec3 value = model.value(DirectionPair::from_angles(at.theta_half, at.theta_diff, at.phi_diff));
    for (int channel = 0; channel < 3; ++channel)
        if (!std::isfinite(value[channel]) || value[channel] < 0.0)
            throw Error(LB_ERROR_INTERNAL, text("built-in material: cell ", cell, ", channel ", channel, " is ",
                                                value[channel], "; a reflectance is finite and not negative"));
    return value;
}

// The mirror image of a cell in phi_diff has light and eye exchanged, and a reciprocal model's value is the same.
BrdfTable tabulated(const ReflectanceModel& model) {
    BrdfTable table;
    table.rgb.resize(BrdfTable::cell_count * 3);
    constexpr uint32_t last_phi = BrdfTable::phi_diff_cells - 1;
    for (uint32_t theta_half = 0; theta_half < BrdfTable::theta_half_cells; ++theta_half)
        for (uint32_t theta_diff = 0; theta_diff < BrdfTable::theta_diff_cells; ++theta_diff)
            for (uint32_t phi_diff = 0; phi_diff <= last_phi / 2; ++phi_diff) {
                const size_t cell = BrdfTable::cell(theta_half, theta_diff, phi_diff);
                const size_t mirror = BrdfTable::cell(theta_half, theta_diff, last_phi - phi_diff);
                const Vec3 value = cell_value(model, cell);
                for (int channel = 0; channel < 3; ++channel)
                    table.rgb[3 * cell + channel] = table.rgb[3 * mirror + channel] = float(value[channel]);
            }
    return table;
}

}  // namespace lightband
