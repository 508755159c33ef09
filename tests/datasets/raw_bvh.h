// BVH motions for tests: with all of their channel values as they stand, and joints in metres.
#pragma once

#include <string>

#include "datasets/formats/bvh.h"

namespace pushid {

inline Result<BvhMotion> ReadBvh(const std::string& path) {
  return Caught([&] {
    PointReadOptions options;
    options.choose = [](const PointMotion&) { return std::vector<int>{0}; };
    options.kept_rows = 1 << 30;
    const PointMotion read = OrThrow(ReadBvhPoints(path, options));
    return BvhMotion{*read.skeleton, OrThrow(ReadBvhFrameTime(path)), read.values};
  });
}

// All joints of a file whose lengths are so many metres.
inline PointMotion BvhInMetres(const std::string& path, double metres = 1e-3) {
  PointMotion motion = OrThrow(ReadBvhPoints(path));
  for (auto& track : motion.positions) {
    for (Eigen::Vector3d& position : track) position *= metres;
  }
  return motion;
}

}  // namespace pushid
