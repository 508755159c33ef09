// residuals: derivatives of what everybody gets from others, beside those of the rollout
// (rollout_sensitivities.h).
#pragma once

#include <optional>
#include <vector>

#include "residuals/sensitivities/learned_pair_jacobian.h"
#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {

// A force's derivative by a parameter, onto the column that depends on it: most parameters act on
// one row or two.
template <typename Vector>
void AddWhereAny(const ColumnEntry& entry, const Vector& by_parameter, ForceColumns* by_column) {
  for (int row = 0; row < 4; ++row) {
    if (by_parameter[row] == 0.0) continue;
    (*by_column)(row, entry.column) += entry.derivative * by_parameter[row];
  }
}

// Of all that is learned: those given, or the options' own.
const double* LearnedWeights(const ModelOptions& options, const SensitivityInputs& inputs);

class ReceivedSensitivities {
 public:
  ReceivedSensitivities(const Scene& scene, const ModelOptions& options,
                        const SensitivityInputs& inputs);

  // Of the interaction at one frame; forces: prepared for it.
  void Update(const RolloutSensitivities& sensitivities, int frame,
              const SceneForces<double>& forces);

  // Adds what person n feels of it.
  void AddTo(int n, ForceColumns* by_column) const {
    if (options_.interaction.Any()) *by_column += now_[n];
  }

 private:
  // Of the k-th two who act on each other; by_weight_ as well where weights are fitted.
  PairJacobian Of(size_t k, const SceneForces<double>& forces);

  const ModelOptions& options_;
  const SensitivityInputs& inputs_;
  std::vector<ColumnEntry> pair_entries_;
  const double* weights_;  // of what is learned; null where no interaction is
  PairByWeight by_weight_;
  std::optional<HeldPairs> held_;  // where weights are, and are not fitted
  std::vector<ForceColumns> now_;
};

}  // namespace pushid
