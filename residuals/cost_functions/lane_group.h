// residuals: recordings of people alone, rolled out and summed up side by side (person_lanes.h).
//
// A recording's numbers do not depend on those beside it, nor on how many these are, to the last
// bit; other widths of vectors round otherwise (to 1e-12 of a sum).
#pragma once

#include <memory>
#include <vector>

#include "residuals/cost_functions/lane_tables.h"
#include "residuals/cost_functions/rollout_problem.h"
#include "residuals/normal_equations.h"

namespace pushid {

// Whether a recording can be rolled out so.
bool HasLanes(const RolloutProblem& problem);

// What a rollout's residuals sum up to.
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
                     const PersonLanes& lanes = BestPersonLanes());

  // At the given blocks of each, by LaneSums.
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

}  // namespace pushid
