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

#include <functional>
#include <memory>
#include <vector>

#include "residuals/lanes/person_lanes.h"
#include "residuals/rollout_residual.h"

namespace pushid {

// What is summed up of a rollout, or of one person in it. Covariance, verdict, horizons, profiles
// and the solver make all that they ask of rows from these sums.
struct RolloutSums {
  bool ok = false;                // stayed within the domain
  double squares = 0.0;           // r'r; all there is without derivatives
  NormalEquations plain, robust;  // robust: with the robust loss's own Hessian, where asked for
  std::vector<double> residuals;  // where nothing was to be summed up (LaneSums::kNone)

  void Add(const RolloutSums& other);
};

// Adds the rows of a rollout up, each frame where `to` says. residuals, rows: those of all frames,
// in the order of RolloutResidual, by as many columns as the sums have, padded; overwritten. raw:
// they are without the robust loss and the recording's weight, which they get here.
using SumsOfFrame = std::function<RolloutSums*(int person, int frame)>;
void AddUpRows(const RolloutProblem& problem, bool raw, LaneSums wanted, const SumsOfFrame& to,
               std::vector<double>* residuals, RowMajorMatrix* rows);

// Rows, one more than there are columns, that have the sums of all (normal_equations.h).
struct PersonRows {
  RowMajorMatrix jacobian;
  Eigen::VectorXd residuals;
  RowMajorMatrix robust_jacobian;  // with the robust loss's own Hessian (frame_residual.h)
};
PersonRows FewestRows(const RolloutSums& sums);

// Recordings of people alone, rolled out and summed up side by side (person_lanes.h).
//
// A recording's numbers do not depend on those beside it, nor on how many these are, to the last
// bit; other widths of vectors round otherwise (to 1e-12 of a sum).

// Whether a recording can be rolled out so.
bool HasLanes(const RolloutProblem& problem);

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

// By rollout, nothing where it is not wanted: the sums of each person, or of all in one. Rollouts
// that are in no group go by jets. kNone: of all in one.
std::vector<std::vector<RolloutSums>> SumUp(const std::vector<SideBySide>& groups,
                                            const std::vector<RolloutAt>& rollouts, LaneSums wanted,
                                            bool by_person = false);

class CondensedRollout : public ceres::CostFunction {
 public:
  explicit CondensedRollout(std::shared_ptr<const RolloutProblem> problem);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;
  const RolloutProblem& problem() const { return *problem_; }

  // By acting column; weights_held: without those of learned weights.
  RolloutSums SumsAt(double const* const* blocks, LaneSums wanted, bool weights_held) const;
  // The outputs of Evaluate. False where the rollout left the domain.
  bool FillRows(const RolloutSums& sums, double* residuals, double** jacobians) const;
  // One for each of the sums, by all columns of the blocks, side by side; none where the rollout
  // left the domain.
  std::vector<PersonRows> RowsOf(const std::vector<RolloutSums>& sums) const;

 private:
  std::shared_ptr<const RolloutProblem> problem_;
  ActingColumns columns_;
  // Where it has lanes: a group of its own, laid out at the first call. Ceres evaluates a block
  // from one thread at a time.
  mutable std::unique_ptr<LaneGroup> alone_;
};

}  // namespace pushid
