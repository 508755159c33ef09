// ident: residuals and Jacobian of a built problem, gathered by recording.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ident/problem/fit_problem.h"

namespace pushid {

struct BuiltProblem;

// Rows of a recording that is rolled out are those of CondensedRollout, person by person: every sum
// of squares and products over a person, a recording or all of them is that of the rows they stand
// for. Other rows are as their cost function has them.
struct JacobianBlocks {
  Eigen::MatrixXd jacobian;  // rows x all fitted numbers
  Eigen::VectorXd residuals;
  std::vector<int> cluster_of_row;  // recording, or a cluster of FitProblem
  std::vector<int> person_of_row;   // in the recording; -1 where rows belong to nobody
  std::vector<int> clusters;        // the recordings present, ascending
  int num_data_rows = 0;            // before they were condensed
  // The Jacobian with the robust loss's own Hessian in its J'J (frame_residual.h), rows of
  // recordings only, zeros elsewhere; empty where it was not asked for.
  Eigen::MatrixXd robust_jacobian;
  // What J'J leaves out of the Hessian: the sum over rows of r times its second derivatives. Empty
  // until AddCurvature.
  Eigen::MatrixXd curvature;

  std::vector<int> RowsOf(int cluster) const;
};

// robust: with robust_jacobian.
JacobianBlocks EvaluateJacobianBlocks(const BuiltProblem& built, bool robust = false);

// Differences of the gradient J'r, one column at a time, `steps` ahead of the point or to both
// sides of it (0: a column that does not move, and has none). Leaves the curvature empty where some
// residual cannot be evaluated there.
void AddCurvature(const BuiltProblem& built, const Eigen::VectorXd& steps, bool both_sides,
                  JacobianBlocks* score);

// Residuals of whole recordings before any weight.

using ResidualsByRecording = std::vector<std::vector<double>>;

// In sigmas: FrameResidual's, by frame from frame 1 on, then person; then those of
// platforms (cost_functions/plate_residual.h). Empty where a rollout leaves the domain, and where
// it is not wanted (wanted: by recording; empty: all).
ResidualsByRecording RawResiduals(const FitProblem& problem, const FitPoint& point,
                                  const std::vector<bool>& wanted = {});

// The same of each of these.
std::vector<std::vector<double>> ResidualsOf(const std::vector<RolloutAt>& rollouts);

// Those of a problem without the robust loss.
ResidualSigmas PlainSigmas(const FitProblem& problem);

}  // namespace pushid
