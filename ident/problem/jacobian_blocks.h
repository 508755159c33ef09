// ident: residuals and Jacobian of a built problem, gathered by recording.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ident/problem/fit_problem.h"

namespace pushid {

struct JacobianBlocks {
  Eigen::MatrixXd jacobian;  // all residuals x all fitted numbers
  Eigen::VectorXd residuals;
  std::vector<int> cluster_of_row;  // recording, or a cluster of FitProblem
  std::vector<int> row_in_block;    // place of a row among those of its residual block
  std::vector<int> clusters;        // the recordings present, ascending
  int num_data_rows = 0;
  // The Jacobian with the robust loss's own Hessian in its J'J (frame_residual.h), rows of
  // recordings only, zeros elsewhere; empty until CorrectRobustLoss.
  Eigen::MatrixXd robust_jacobian;
  // What J'J leaves out of the Hessian: the sum over rows of r times its second derivatives. Empty
  // until AddCurvature.
  Eigen::MatrixXd curvature;

  std::vector<int> RowsOf(int cluster) const;
};

JacobianBlocks EvaluateJacobianBlocks(const FitProblem::Built& built);

void CorrectRobustLoss(const FitProblem& problem, JacobianBlocks* score);

// Central differences of the gradient J'r, one column at a time, `steps` to either side (0: a
// column that does not move). Leaves the curvature empty where some residual cannot be evaluated
// beside the point.
void AddCurvature(const FitProblem::Built& built, const Eigen::VectorXd& steps,
                  JacobianBlocks* score);

}  // namespace pushid
