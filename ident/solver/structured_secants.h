// ident: a built problem as one cost function, whose rows know the curvature that J'J leaves out,
// learned from step to step.
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

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "residuals/normal_equations.h"

namespace pushid {

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

// One block of all parameters that move, in the order of the problem's blocks; one row more than
// there are. Ceres asks for derivatives only where it has accepted a step. Loss functions and
// manifolds of the problem are not looked at; it has none.
class SummedCost : public ceres::CostFunction {
 public:
  // known: sums of the recordings at a point; empty: none.
  SummedCost(FitProblem::Built* built, StructuredSecants secants, RecordingSums known);
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override;

  // The values of the problem's blocks that move.
  std::vector<double> Values() const;
  void SetValues(const double* x) const;
  void SetBounds(ceres::Problem* problem, double* x) const;
  // Where derivatives were asked for last.
  const RecordingSums& recordings() const { return recordings_; }

 private:
  struct Block {  // of parameters
    double* values;
    int column, size;
  };
  struct Part {
    const ceres::CostFunction* cost;
    bool of_recording;
    std::vector<const double*> on;
    std::vector<int> columns;                 // of each block; -1: it stays
    const RolloutSums* sums;                  // of a rollout in lanes; null of others
    std::vector<std::vector<int>> of_acting;  // columns that move each of the rollout's own
  };
  // sum: null without derivatives.
  static bool AddPart(const Part& part, double* squares, SecondOrder* sum);
  bool AddParts(bool of_recordings, double* squares, SecondOrder* sum) const;
  bool SetCost(double squares, double* residuals) const;

  FitProblem::Built& built_;
  std::vector<Block> moving_;
  std::vector<Part> parts_;
  mutable StructuredSecants secants_;
  mutable RecordingSums recordings_;
  mutable double squares_ = 0.0;  // where derivatives were asked for last
};

}  // namespace pushid
