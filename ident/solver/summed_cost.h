// ident: a built problem as one cost function, whose rows are a model of the Hessian
// (structured_secants.h).
#pragma once

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/solver/structured_secants.h"

namespace pushid {

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
  static void AddSums(const Part& part, SecondOrder* sum);
  // sum: null without derivatives.
  bool AddPart(const Part& part, double* squares, SecondOrder* sum) const;
  bool AddParts(bool of_recordings, double* squares, SecondOrder* sum) const;
  bool RefusedByDemands(double* residuals) const;

  FitProblem::Built& built_;
  std::vector<Block> moving_;
  std::vector<Part> parts_;
  mutable StructuredSecants secants_;
  mutable RecordingSums recordings_;
  mutable double squares_ = 0.0;  // where derivatives were asked for last
};

}  // namespace pushid
