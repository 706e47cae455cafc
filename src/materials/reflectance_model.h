// A reflectance given by formulas: what the built-in tables are filled from.
#pragma once

#include <cstddef>

#include "base/math.h"
#include "materials/direction_pair.h"
#include "scene/brdf_table.h"

namespace lightband {

class ReflectanceModel {
public:
    virtual ~ReflectanceModel() = default;

    // RGB in 1/steradian for a pair above the horizon. Reciprocal.
    virtual Vec3 value(const DirectionPair& pair) const = 0;
};

// The model at one cell of the MERL layout, counted as in BrdfTable::cell: at its centre; where that lies below the
// horizon, amid the part above it, so that the table reflects light up to grazing; -1 in all channels where no part of
// the cell is above. LB_ERROR_INTERNAL for a value that is negative or not finite.
Vec3 cell_value(const ReflectanceModel& model, size_t cell);

// The model at every cell.
BrdfTable tabulated(const ReflectanceModel& model);

}  // namespace lightband
