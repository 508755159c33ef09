// ident: the curvature that J'J leaves out, learned from step to step.
//
// Gauss-Newton takes J'J for the Hessian H of the cost. Where a model is wrong, as every model of
// people is, the rest, S = H - J'J, is not small: J'J is up to seven times H for people alone, and
// each of its steps leaves a constant share of the way. S is learned from differences of
// gradients, y = g(x + s) - g(x):
//   B = J'J + S,  S <- S + y y'/(y's) - (B s)(B s)'/(s'B s)        (BFGS, structured: Al-Baali and
//                                                                 Fletcher 1985)
// with S first a share of J'J, then shrunk where it says more than the last step shows (NL2SOL's
// sizing: Dennis, Gay and Welsch 1981). Priors have no S, being linear, nor have demands: a hinge
// bends where it begins, and what a step across that tells is wrong on either side.
// Rejected: NL2SOL's own update (DFP), which ends early for groups; rank one (SR1), half more steps
// for people alone; BFGS of the whole Hessian, which stalls where contacts begin; never going
// back to J'J alone, with which two more of NIST's sets do not converge from afar.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "residuals/normal_equations.h"

namespace pushid {

// J'J and J'r of some rows.
struct SecondOrder {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;

  static SecondOrder Zero(Eigen::Index columns) {
    return {Eigen::MatrixXd::Zero(columns, columns), Eigen::VectorXd::Zero(columns)};
  }
};

// What the rows of all recordings sum to at a point, by the weights that they have there.
struct RecordingSums {
  Eigen::VectorXd at;  // of the columns; empty: nowhere
  double squares = 0.0;
  SecondOrder sums;

  bool AreAt(const Eigen::VectorXd& x) const { return at.size() == x.size() && at == x; }
};

// Problems of more columns are solved without: these are of units (subjects, settings), of which a
// recording has few, or of a network's weights, and a unit's column has its prior.
inline constexpr int kDenseColumns = 50;

class StructuredSecants {
 public:
  // learns: or S stays as it is. beyond: S at a point nearby; empty: unknown.
  explicit StructuredSecants(bool learns, Eigen::MatrixXd beyond = {})
      : learns_(learns), beyond_(std::move(beyond)), use_(beyond_.size() > 0) {}

  // At the next accepted point. curved: rows that have an S; linear: those taken as linear.
  void Add(const Eigen::VectorXd& x, double cost, const SecondOrder& curved,
           const SecondOrder& linear);

  // [B z; 0 rho] at that point: as many rows as columns with B'B the Hessian's model and B'z the
  // gradient, and one that completes the cost.
  RowMajorMatrix Rows() const;

 private:
  void Judge(const Eigen::VectorXd& step, double fall);
  void Learn(const Eigen::VectorXd& step, const SecondOrder& curved, const SecondOrder& linear);

  const bool learns_;
  Eigen::MatrixXd beyond_;  // S
  bool use_;
  Eigen::VectorXd x_, curved_gradient_, gradient_;
  Eigen::MatrixXd information_;
  double cost_ = 0.0;
};

}  // namespace pushid
