// residuals: scenes of people alone laid out in lanes (person_lanes.h): what is constant over a
// rollout, and from step to step.
#pragma once

#include <memory>
#include <vector>

#include "models/options.h"
#include "models/parameters.h"
#include "models/scene.h"
#include "residuals/lanes/person_lanes.h"
#include "residuals/normal_equations.h"
#include "residuals/parameter_map.h"
#include "residuals/rollout_residual.h"

namespace pushid {

// Whether a scene can be rolled out so: one person, of sliding feet, with no force that remembers
// or that a user brings.
bool HasLanes(const Scene& scene, const ModelOptions& options);

// The parameters of people in lanes, and what columns move of them.
class LaneParameters {
 public:
  explicit LaneParameters(int width = 0) { Clear(width); }
  void Clear(int width);
  // entries: in ascending order of column, of the same columns and parameters in every lane; none
  // without derivatives.
  void Set(int lane, const ParameterSet<double>& values, const std::vector<ColumnEntry>& entries);
  void In(LaneInputs* in) const;

 private:
  int width_ = 0;
  std::vector<double> values_, slopes_;
  std::vector<LaneEntry> entries_;
};

class LaneTables {
 public:
  // frames, num_tails: the most that one of them has. steps: those that differ, where frames after
  // are as the last of them.
  LaneTables(const PersonLanes& lanes, int frames, int num_tails, int steps);

  // Puts a scene into a lane. All lanes share their options but for the tail.
  void Set(int lane, const Scene& scene, const ModelOptions& options, int frames);
  void SetMeasured(int lane, int frame, const Vector3<double>& hip,
                   const PendulumState<double>& state, double weight);

  // All but parameters, columns and sigmas.
  LaneInputs Inputs() const;
  const std::vector<double>& constants() const { return constants_; }
  int width() const { return lanes_->lanes; }
  // All of `out` but its storage is the caller's.
  void Roll(const LaneInputs& in, LaneSums sums, LaneOutputs out) const;

 private:
  void SetSteps(int lane, const Scene& scene, const ModelOptions& options, int frames);
  void SetTails(int lane, const Scene& scene, const ModelOptions& options);
  double* Step(int lane, int frame) { return steps_.data() + frame * kLaneFields * width() + lane; }
  double& Constant(int id, int lane) { return constants_[id * width() + lane]; }

  const PersonLanes* lanes_;
  int frames_, num_tails_, num_steps_;
  FrictionKind friction_ = FrictionKind::kIsotropic;
  bool cart_derivative_ = false;
  std::vector<double> constants_, steps_, tails_;
};

// Steps that differ where nothing is measured: until all pushes have ended.
int NumSteps(const Scene& scene, int frames);
// Pushes on the person with a tail.
int NumTails(const Scene& scene, const ModelOptions& options);

// Recordings of people alone, rolled out and summed up side by side (person_lanes.h).
//
// A recording's numbers do not depend on those beside it, nor on how many these are, to the last
// bit; other widths of vectors round otherwise (to 1e-12 of a sum).

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

}  // namespace pushid
