// residuals: the loops of person_lanes.h, for the file that includes this, which says
//   PUSHID_VECTOR_DOUBLES      doubles in a vector
//   PUSHID_LANE_SCALAR         the header with its scalar, where it is another (tests/benchmarks)
// What is compiled here for wide vectors must not be linked to by other files: the scalar is a type
// without linkage, so that every template of it has none either, and nothing else is called that
// has an inline definition (tests/residuals/shared_code.sh looks into the objects).
#pragma once

#include "residuals/lanes/person_roller.h"

namespace pushid {
namespace {

void RollLanes(const LaneInputs& in, LaneSums sums, const LaneOutputs& out) {
  Room room(out.storage);
  const int columns = in.columns, size = (columns + 1) * (columns + 1);
  const bool equations = sums == LaneSums::kPlain || sums == LaneSums::kRobust;
  Carried carried;
  carried.residuals = out.residuals;
  carried.states = out.states;
  if (sums == LaneSums::kStates && columns > 0) {
    carried.by_column = room.Take(8 * columns);
    carried.before = room.Take(2 * columns);
  } else if (equations) {
    carried = {room.Take(8 * columns), room.Take(2 * columns),
               room.Take(kFrameResiduals * (columns + 1)), room.Take(size), room.Take(size)};
  }
  carried.tails = room.Take(2 * in.num_tails);
  Roller roller(in, sums, carried);
  roller.Roll();
  Store(roller.failed(), out.failed);
  Store(roller.squares(), out.squares);
  for (int i = 0; equations && i < size; ++i) {
    Store(carried.plain[i], out.plain + i * kWidth);
    if (sums == LaneSums::kRobust) Store(carried.robust[i], out.robust + i * kWidth);
  }
}

}  // namespace
}  // namespace pushid
