// residuals: rows of a recording, in as few as its blocks have columns.
//
//   residuals: F of the normal equations of all rows (normal_equations.h), one more than acting
//              columns (parameter_map.h): J'J, J'r and the cost are those of the rows, robust loss
//              and weights included. Without derivatives, [0 ... 0 |r|].
//   blocks:    BlockLayout (parameter_map.h).
// This is what Ceres solves with: a group of five has some 4,000 rows of 36 columns, and 20 rows so
// condensed. Diagnostics ask for the rows of each person, whose errors are clustered.
#pragma once

#include <ceres/cost_function.h>

#include <functional>
#include <memory>
#include <vector>

#include "residuals/cost_functions/lane_tables.h"
#include "residuals/cost_functions/rollout_problem.h"

namespace pushid {

class CondensedRows : public ceres::CostFunction {
 public:
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

  // One person's rows, condensed: as many for each.
  struct PersonRows {
    RowMajorMatrix jacobian;  // by all columns of the blocks, side by side
    Eigen::VectorXd residuals;
    RowMajorMatrix robust_jacobian;  // with the robust loss's own Hessian (frame_residual.h)
  };
  // One for each person; robust: with robust_jacobian, which is empty otherwise. False when the
  // rollout leaves the domain.
  virtual bool EvaluatePeople(double const* const* blocks, bool robust,
                              std::vector<PersonRows>* people) const;
  const RolloutProblem& problem() const { return *problem_; }
  int num_people() const { return problem_->recording->num_people(); }
  virtual int num_rows() const = 0;  // before they were condensed

 protected:
  explicit CondensedRows(std::shared_ptr<const RolloutProblem> problem);

  // Some rows of one frame of one person.
  struct Rows {
    int person = 0;
    double weight = 1.0;  // on all of them, which the robust loss does not see
    int count = 0;
    const double* residuals = nullptr;
    double* by_column = nullptr;  // count x PaddedSize of the acting columns
  };
  using RowsVisitor = std::function<void(const Rows&)>;
  // All rows, in any order. Those of kHeldWeights have no columns of weights.
  virtual RolloutStatus Visit(double const* const* blocks, Derivatives derivatives,
                              const RowsVisitor& visit) const = 0;

  const ActingColumns& columns() const { return columns_; }
  // Evaluate's outputs from equations by `acting` columns, or from r'r where there are none.
  void FillRows(const NormalEquations& equations, double* residuals, double** jacobians) const;
  void FillSquares(double squares, double* residuals) const;
  // robust: null without.
  PersonRows RowsOf(const NormalEquations& plain, const NormalEquations* robust) const;

 private:
  std::shared_ptr<const RolloutProblem> problem_;
  ActingColumns columns_;
};

// A whole recording against its rollout: the rows of rollout_problem.h. Those of people alone are
// summed up side by side (lane_tables.h), in a group of their own where Ceres asks for one
// recording.
class CondensedRollout : public CondensedRows {
 public:
  explicit CondensedRollout(std::shared_ptr<const RolloutProblem> problem);

  int num_rows() const override { return problem().num_residuals(); }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;
  bool EvaluatePeople(double const* const* blocks, bool robust,
                      std::vector<PersonRows>* people) const override;

  // The problem, where it has lanes and they are to be used; null otherwise.
  const RolloutProblem* in_lanes() const { return HasLanes(problem()) ? &problem() : nullptr; }
  // The outputs of Evaluate and EvaluatePeople from sums that were computed before.
  bool FillRows(const RolloutSums& sums, double* residuals, double** jacobians) const;
  bool FillPeople(const RolloutSums& sums, bool robust, std::vector<PersonRows>* people) const;

 protected:
  RolloutStatus Visit(double const* const* blocks, Derivatives derivatives,
                      const RowsVisitor& visit) const override;

 private:
  // Sums of one recording that has lanes; laid out at the first call. Ceres evaluates a block
  // from one thread at a time.
  RolloutSums Alone(double const* const* blocks, LaneSums sums) const;
  mutable std::unique_ptr<LaneGroup> alone_;
};

}  // namespace pushid
