// residuals: rows of a recording (rollout_residual.h), in as few as its blocks have columns.
//
//   residuals: F of the normal equations of all rows (normal_equations.h), one more than acting
//              columns (parameter_map.h): J'J, J'r and the cost are those of the rows, robust loss
//              and weights included. Without derivatives, [0 ... 0 |r|].
//   blocks:    BlockLayout (parameter_map.h).
// This is what Ceres solves with: a group of five has some 4,000 rows of 36 columns, and 20 rows so
// condensed. Diagnostics ask for the rows of each person, whose errors are clustered.
//
// Derivatives come from jets (jets/autodiff_rollout.h), whatever the model. One kind of recording
// has derivatives written out: people alone whose feet slide, eight side by side (lanes/),
// with which a whole fit takes less than half of the time (tests/studies/speed.py derivatives).
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "residuals/lanes/person_lanes.h"
#include "residuals/rollout_residual.h"

namespace pushid {

// Recordings of people alone, rolled out and summed up side by side (person_lanes.h).
//
// A recording's numbers do not depend on those beside it, nor on how many these are, to the last
// bit; other widths of vectors round otherwise (to 1e-12 of a sum).

// Whether a recording can be rolled out so.
bool HasLanes(const RolloutProblem& problem);

// Sums over a rollout's residuals.
struct RolloutSums {
  bool ok = false;                // stayed within the domain
  double squares = 0.0;           // r'r; all there is without derivatives
  NormalEquations plain, robust;  // robust: with the robust loss's own Hessian, where asked for
  std::vector<double> residuals;  // where nothing was to be summed up
};

class LaneGroup {
 public:
  // problems: at most lanes.lanes, which have lanes and the same columns, and outlive the group.
  explicit LaneGroup(std::vector<const RolloutProblem*> problems,
                     const PersonLanes& lanes = Widest<PersonLanes>());

  // The sums of each rollout at its blocks, those that LaneSums asks for.
  std::vector<RolloutSums> Evaluate(const std::vector<double const* const*>& blocks,
                                    LaneSums sums) const;
  const std::vector<const RolloutProblem*>& problems() const { return problems_; }

 private:
  std::vector<const RolloutProblem*> problems_;
  LaneTables tables_;
};

// A rollout and where it is evaluated; no problem: it is not wanted.
struct RolloutAt {
  std::shared_ptr<const RolloutProblem> problem;
  std::vector<double*> blocks;
};
struct SideBySide {
  std::vector<int> members;  // indices
  LaneGroup lanes;
};
// Rollouts that have lanes, as many together as fit; the others are in no group.
std::vector<SideBySide> PutSideBySide(const std::vector<RolloutAt>& rollouts);
// By rollout, as they were put; not ok where one is in no group.
std::vector<RolloutSums> SumUp(const std::vector<SideBySide>& groups,
                               const std::vector<RolloutAt>& rollouts, LaneSums sums);

class CondensedRollout : public ceres::CostFunction {
 public:
  explicit CondensedRollout(std::shared_ptr<const RolloutProblem> problem);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

  // One person's rows, condensed: as many for each.
  struct PersonRows {
    RowMajorMatrix jacobian;  // by all columns of the blocks, side by side
    Eigen::VectorXd residuals;
    RowMajorMatrix robust_jacobian;  // with the robust loss's own Hessian (frame_residual.h)
  };
  // One for each person; robust: with robust_jacobian, which is empty otherwise. False when the
  // rollout leaves the domain.
  bool EvaluatePeople(double const* const* blocks, bool robust,
                      std::vector<PersonRows>* people) const;
  const RolloutProblem& problem() const { return *problem_; }
  int num_people() const { return problem_->recording->num_people(); }
  int num_rows() const { return problem_->num_residuals(); }  // before they were condensed

  // The problem, where it has lanes and they are to be used; null otherwise.
  const RolloutProblem* in_lanes() const { return HasLanes(*problem_) ? problem_.get() : nullptr; }
  // The outputs of Evaluate and EvaluatePeople from sums that were computed before.
  bool FillRows(const RolloutSums& sums, double* residuals, double** jacobians) const;
  bool FillPeople(const std::vector<RolloutSums>& sums, bool robust,
                  std::vector<PersonRows>* people) const;

 private:
  // Sums of the recording, where it has lanes, in a group of its own that is laid out at the first
  // call. Ceres evaluates a block from one thread at a time.
  RolloutSums Alone(double const* const* blocks, LaneSums sums) const;

  std::shared_ptr<const RolloutProblem> problem_;
  ActingColumns columns_;
  mutable std::unique_ptr<LaneGroup> alone_;
};

}  // namespace pushid
