// Tables and TRC files as instruments write them.
#pragma once

#include <string>

#include "datasets/files/numeric_table.h"
#include "datasets/formats/point_motion.h"

namespace pushid {

// Writes all columns, atomically; NaN as an empty cell (CSV) or nan (storage).
MaybeError WriteNumericTable(const std::string& path, TableFormat format,
                             const NumericTable& table);

// Writes all points of the motion (positions in motion.unit, millimetres when unset), atomically;
// missing points as empty cells.
MaybeError WriteTrc(const std::string& path, const PointMotion& motion);

}  // namespace pushid
