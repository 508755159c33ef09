// residuals: scenes of which nothing was measured, rolled out by one model: side by side where they
// have lanes (person_lanes.h), one after the other where they have none.
#pragma once

#include <vector>

#include "models/rollout.h"
#include "residuals/cost_functions/lane_tables.h"
#include "residuals/jets/autodiff_rollout.h"
#include "residuals/normal_equations.h"

namespace pushid {

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
    std::vector<double> states, derivatives;  // as LaneOutputs has them, without and with columns
  };
  bool RollGroup(const ParameterSet<double>& parameters, const std::vector<ColumnEntry>& entries,
                 int columns, int end, const Group& group, std::vector<double>* states);
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

}  // namespace pushid
