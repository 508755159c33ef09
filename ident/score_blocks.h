// ident: residuals and Jacobian of a built problem, gathered by recording.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ident/fit_problem.h"

namespace pushid {

struct ScoreBlocks {
  Eigen::MatrixXd jacobian;  // all residuals x all fitted numbers
  Eigen::VectorXd residuals;
  std::vector<int> cluster_of_row;  // recording, or a cluster of FitProblem
  std::vector<int> clusters;        // the recordings present, ascending
  int num_data_rows = 0;
};

ScoreBlocks EvaluateScoreBlocks(const FitProblem::Built& built);

}  // namespace pushid
