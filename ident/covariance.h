// ident: covariances of a least-squares estimate from its residuals and Jacobian alone, whatever
// model made them (the NIST reference sets go through here too).
//
// At the optimum, with H = J'J over all residuals and s_g = J_g' r_g the score of cluster g:
//   naive      sigma^2 H^-1, sigma^2 = |r|^2 / (N - rank): rows taken as independent
//   clustered  sum over g of D_g D_g' (G - 1) / G,  D_g = (H - H_g)^-1 s_g centred:
// what leaving out cluster g would move, to first order (the CR3 jackknife; Bell & McCaffrey 2002).
// By singular values, on the subspace that the rows determine; nothing is said of the rest.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ident/score_blocks.h"

namespace pushid {

inline constexpr double kNullSingularValue = 1e-7;  // relative to the largest one

// Right singular vectors of a Jacobian, those of the null space last.
struct Directions {
  Eigen::VectorXd singular;
  Eigen::MatrixXd v;
  int rank = 0;

  double Condition() const;  // of the first `rank`; infinite when there are none
};
Directions Decompose(const Eigen::MatrixXd& jacobian, double null_value = kNullSingularValue);

struct Covariance {
  Directions directions;  // of the scaled Jacobian
  int freedom = 1;        // rows of data less the rank
  double sigma = 0.0;     // residual standard deviation
  Eigen::MatrixXd inverse_hessian;
  Eigen::MatrixXd naive;
  Eigen::MatrixXd clustered;  // empty with fewer than two clusters
  // One column for each of `clusters`: what leaving it out would move, by one Gauss-Newton step.
  Eigen::MatrixXd moves;
  std::vector<int> clusters;
};

// unit: the size of one step in each column, for judging what counts as null; 0 holds a column.
Covariance ComputeCovariance(const ScoreBlocks& score, const Eigen::VectorXd& unit,
                             double null_value = kNullSingularValue);

}  // namespace pushid
