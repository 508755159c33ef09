// A BVH motion with all of its channel values, as it stands in its file.
#pragma once

#include <string>

#include "datasets/formats/bvh.h"

namespace pushid {

inline Result<BvhMotion> ReadBvh(const std::string& path) {
  return Caught([&] {
    BvhPositionOptions options;
    options.choose_joints = [](const BvhSkeleton&) { return std::vector<int>{0}; };
    options.kept_rows = 1 << 30;
    BvhPositions read = OrThrow(ReadBvhPositions(path, options));
    return BvhMotion{read.skeleton, read.frame_time_s, read.values};
  });
}

}  // namespace pushid
