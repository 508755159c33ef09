// ident: covariances of a least-squares estimate from its residuals and Jacobian alone, whatever
// model made them (the NIST reference sets go through here too).
//
// At the optimum, with s_g = J_g' r_g the score of cluster g and H the Hessian of the cost,
// H = J'J + sum r d2r (the second term only where it was computed, jacobian_blocks.h):
//   naive      sigma^2 (J'J)^-1, sigma^2 = |r|^2 / (N - rank): rows taken as independent
//   clustered  sum over g of D_g D_g', D_g centred,
//              D_g = H^-1/2 (1 - M_g)^-1/2 H^-1/2 s_g,  M_g = H^-1/2 J_g'J_g H^-1/2
// (CR2; Bell & McCaffrey 2002). What leaving a cluster out would move: H^-1 s_g G / (G - 1), one
// step with the mean Hessian of the rest. Against refits of the 32 single-person recordings it is
// off by 15 % (root mean square over all moves); by H less the cluster's own J_g'J_g by 39 %, less
// its second derivatives too by 42 %, by J'J less J_g'J_g by 28 %.
//
// Rejected, by the share of 95 % intervals that held the truth where recordings differ
// (tests/studies/coverage_study.cc): J'J alone for H, which the robust loss makes too large (73 to
// 88 %); the jackknife CR3 (96 to 98 %); the clusters' own second derivatives in M_g, which may
// leave H - H_g nearly singular (98 to 100 %).
// By singular values, on the subspace that the rows determine; nothing is said of the rest.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ident/problem/jacobian_blocks.h"

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
  bool full_hessian = false;  // with second derivatives; J'J alone where they leave no minimum
  Eigen::MatrixXd naive;
  Eigen::MatrixXd clustered;  // empty with fewer than two clusters
  // One column for each of `clusters`: what leaving it out would move.
  Eigen::MatrixXd moves;
  std::vector<int> clusters;
};

// unit: the size of one step in each column, for judging what counts as null; 0 holds a column.
Covariance ComputeCovariance(const JacobianBlocks& score, const Eigen::VectorXd& unit,
                             double null_value = kNullSingularValue);

// What the covariances of a fit (uncertainty.h) are computed from, second derivatives included.
struct ScoredFit {
  JacobianBlocks score;
  Eigen::VectorXd unit;
};
ScoredFit ScoreAt(const FitProblem& problem, const FitPoint& point);

}  // namespace pushid
