#include "materials/reflectance_model.h"

#include <cmath>

#include "base/error.h"

namespace lightband {

namespace {

constexpr Vec3 not_measured(-1.0);

// Centres of the cells: theta_half is quadratic, the other angles are linear; phi_diff covers half a turn.
DirectionPair cell_centre(size_t cell) {
    const size_t phi_diff = cell % BrdfTable::phi_diff_cells;
    const size_t theta_diff = cell / BrdfTable::phi_diff_cells % BrdfTable::theta_diff_cells;
    const size_t theta_half = cell / BrdfTable::phi_diff_cells / BrdfTable::theta_diff_cells;
    const double root = (double(theta_half) + 0.5) / BrdfTable::theta_half_cells;
    return DirectionPair::from_angles(root * root * pi / 2.0,
                                      (double(theta_diff) + 0.5) / BrdfTable::theta_diff_cells * pi / 2.0,
                                      (double(phi_diff) + 0.5) / BrdfTable::phi_diff_cells * pi);
}

}  // namespace

Vec3 cell_value(const ReflectanceModel& model, size_t cell) {
    const DirectionPair pair = cell_centre(cell);
    if (!pair.above_horizon()) return not_measured;
    const Vec3 value = model.value(pair);
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
