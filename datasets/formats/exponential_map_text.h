// datasets: motion capture as the human-motion-prediction literature shares it: a line a frame, a
// number of translation or of an exponential map after the other, separated by commas.
#pragma once

#include <Eigen/Core>
#include <string>

#include "datasets/files/error.h"

namespace pushid {

inline constexpr int kTranslationNumbers = 3;  // in front of every line's maps

struct ExponentialMapMotion {
  Eigen::MatrixXd maps;  // 3 numbers a joint; a column a frame
  std::string content_hash;
};

// Errors, with line and column: another count of numbers than `joints` maps and a translation have,
// text that is no finite number, no frames at all.
Result<ExponentialMapMotion> ReadExponentialMapText(const std::string& path, int joints);

}  // namespace pushid
