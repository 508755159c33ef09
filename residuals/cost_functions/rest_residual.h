// residuals: people must come to rest within a time after a push.
//
// For the people of settling simulations (models/scene.h), from WaitSeconds after the
// push for a second, n = frames times people of one simulation:
//   r = weight / sqrt(n) [ hinge(speed / a_v - 1)             1
//                          hinge(|angles - rest| / a_q - 1)   2 ]     hinge(x) = max(0, x)
// `rest` is the upright or initial posture that the balance aims at. a_v and a_q are nine tenths of
// what counts as settled, so that a finite weight suffices: people who settle are not moved at all,
// and need no derivatives, which are rolled out only up to the last frame that has any.
#pragma once

#include <ceres/cost_function.h>

#include <optional>
#include <string>
#include <vector>

#include "models/rollout.h"
#include "residuals/jets/autodiff_rollout.h"
#include "residuals/lanes/person_lanes.h"
#include "residuals/parameter_map.h"

namespace pushid {

// Scenes of which nothing was measured, rolled out by one model: side by side where they have lanes
// (lanes/person_lanes.h), one after the other where they have none.
class SceneRollouts {
 public:
  // scenes: of as many people each. They are rolled out to frame `end`, and looked at from `begin`.
  SceneRollouts(std::vector<Scene> scenes, const ModelOptions& options, int begin, int end);

  // As Rollout, of all of them. False where one leaves the domain.
  bool Roll(const std::vector<ParameterSet<double>>& parameters,
            const double* network_weights = nullptr);
  bool StaysInside(int scene) const { return inside_[scene]; }
  // The state at a frame; of a scene that has left the domain, the last within.
  PendulumState<double> At(int scene, int frame, int person) const;

  // As RolloutWithSensitivities, of each scene so many frames; 0: of none. columns: those of the
  // inputs without their padding.
  bool Differentiate(const SensitivityInputs& inputs, int columns, const std::vector<int>& frames);
  // d [q, qd] / d columns.
  void DerivativesAt(int scene, int frame, int person, RowMajorMatrix* by_column) const;

 private:
  struct Group {  // of scenes side by side
    LaneTables tables;
    int first, count;
    LaneResults states, derivatives;  // without and with columns
  };
  bool RollGroup(const LanePerson& person, int columns, int end, const Group& group,
                 LaneResults* results);
  const Group& GroupOf(int scene) const;

  std::vector<Scene> scenes_;
  ModelOptions options_;
  int begin_, end_, columns_ = 0;
  std::vector<bool> inside_;
  std::vector<Group> groups_;  // empty without lanes; then, by scene:
  std::vector<RolloutPath<double>> paths_;
  std::vector<int> last_;  // frame within the domain
  std::vector<StateColumns> sensitivities_;
};

struct SettlingProblem {
  std::vector<Scene> scenes;  // of as many people and frames each
  ModelOptions options;
  ParameterMap map;
  BlockLayout layout;
  double weight = 1.0;  // of a mean square
  int first_frame = 0, last_frame = 0;
};

// Settling simulations of people with the shared parameters, or with those of `unit` (whose
// deviations are then the second block).
SettlingProblem MakeSettlingProblem(const std::vector<Scene>& scenes, const ModelOptions& options,
                                    const ParameterMap& map, double weight,
                                    const std::string& unit = "");

class SettlingResidual : public ceres::CostFunction {
 public:
  explicit SettlingResidual(SettlingProblem problem);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  const SettlingProblem problem_;
  // Ceres evaluates a block from one thread at a time. It asks for derivatives where it has asked
  // for residuals just before: the simulations are those of the blocks in rolled_at_.
  mutable SceneRollouts rollouts_;
  mutable std::optional<std::vector<double>> rolled_at_;
};

}  // namespace pushid
