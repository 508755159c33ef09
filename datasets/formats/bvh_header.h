// datasets: the part of a BVH file before its rows of numbers: HIERARCHY, Frames:, Frame Time:.
#pragma once

#include <cstdint>
#include <string>

#include "datasets/files/error.h"
#include "datasets/files/input_file.h"
#include "datasets/formats/bvh.h"

namespace pushid {

struct BvhHeader {
  BvhSkeleton skeleton;
  std::int64_t num_frames = 0;  // as announced by `Frames:`, at least 1
  double frame_time_s = 0.0;    // within the accepted range
};

// Leaves `reader` before the first row. Keywords are matched whatever their case; line breaks
// inside the hierarchy are free; a joint's name is the rest of its line and may contain spaces.
Result<BvhHeader> ReadBvhHeader(LineReader* reader);

// "Frame Time" check shared with the writer: the reason why it is not accepted, or "" when it is.
std::string FrameTimeProblem(double frame_time_s);

}  // namespace pushid
