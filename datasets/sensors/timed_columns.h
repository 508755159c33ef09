// datasets: columns of numbers with their times, from CSV, OpenSim storage and Motion-BIDS files.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

struct TimedColumns {
  std::string file;
  double first_s = 0.0;                     // of the first row, on the file's clock
  double rate_hz = 0.0;                     // evenly spaced
  std::vector<std::vector<double>> values;  // [as chosen][row]; NaN where a cell is empty
  std::vector<int> lines;                   // of each row

  int num_rows() const { return static_cast<int>(lines.size()); }
  double last_s() const { return first_s + (num_rows() - 1) / rate_hz; }
};

// choose: indices of the columns wanted, from all names; negative ones come out empty. Errors
// besides the choice's and those of numeric_table.h: no column of times, uneven ones.
Result<TimedColumns> ReadTimedColumns(
    const std::string& path,
    const std::function<Result<std::vector<int>>(const std::vector<std::string>&)>& choose);

// That a record, "the record of the ground lasts", goes on for as long as a motion of so many
// seconds that begins at `start_s` of its clock. spare: frames that may be missing at the end.
struct RecordTimes {
  const char* lasts;
  double first_s, last_s, start_s, seconds, fps, spare;
};
MaybeError CheckLasts(const RecordTimes& times, const std::string& file, int line);

// Values at even times: cubic through the four nearest samples (Lagrange), the nearest at the ends.
// at: in samples, from 0.
Eigen::Vector3d ValueBetween(const std::vector<Eigen::Vector3d>& track, double at);

}  // namespace pushid
