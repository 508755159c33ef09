// residuals: the chain rule through what people do to each other.
#include "residuals/sensitivities/received_sensitivities.h"

#include "residuals/packed/packed_matrix.h"

namespace pushid {

const double* LearnedWeights(const ModelOptions& options, const SensitivityInputs& inputs) {
  return inputs.network_weights != nullptr ? inputs.network_weights
                                           : options.learned->weights.data();
}

ReceivedSensitivities::ReceivedSensitivities(const Scene& scene, const ModelOptions& options,
                                             const SensitivityInputs& inputs)
    : options_(options),
      inputs_(inputs),
      weights_(options.interaction.learned ? LearnedWeights(options, inputs) : nullptr),
      now_(scene.people.size(), ForceColumns::Zero(4, inputs.num_columns)) {
  for (const ColumnEntry& entry : inputs.entries[0]) {
    if (IsPairParameter(entry.parameter)) pair_entries_.push_back(entry);
  }
  if (weights_ == nullptr || inputs.weight_column >= 0) return;
  held_.emplace(options.learned->pair, weights_ + options.learned->pair_at());
}

void ReceivedSensitivities::Update(const RolloutSensitivities& sensitivities, int frame,
                                   const SceneForces<double>& forces) {
  if (!options_.interaction.Any()) return;
  for (ForceColumns& columns : now_) columns.setZero();
  if (held_) held_->Ask(forces);
  for (size_t k = 0; k < forces.acting().size(); ++k) {
    const auto& [n, j] = forces.acting()[k];
    const PairJacobian jacobian = Of(k, forces);
    for (int side = 0; side < 2; ++side) {
      ForceColumns& target = now_[side == 0 ? n : j];
      const auto by_states = jacobian.by_states.middleRows<4>(4 * side);
      AddNarrowProduct(by_states.leftCols<8>(), sensitivities.At(frame, n), target);
      AddNarrowProduct(by_states.rightCols<8>(), sensitivities.At(frame, j), target);
      for (const ColumnEntry& entry : pair_entries_) {
        AddWhereAny(
            entry,
            jacobian.by_parameter.block<4, 1>(4 * side, entry.parameter - kFirstPairParameter),
            &target);
      }
      if (weights_ == nullptr || held_) continue;
      target.middleCols(inputs_.weight_column + options_.learned->pair_at(), by_weight_.cols()) +=
          by_weight_.middleRows<4>(4 * side);
    }
  }
}

PairJacobian ReceivedSensitivities::Of(size_t k, const SceneForces<double>& forces) {
  const auto& [n, j] = forces.acting()[k];
  const Pair pair = forces.pairs().Of(n, j);
  PairJacobian jacobian = ComputePairJacobian(options_.interaction, pair, forces.Parameters(0),
                                              forces.state(n), forces.state(j));
  if (held_) {
    held_->AddTo(k, forces, &jacobian);
  } else if (weights_ != nullptr) {
    const LearnedTerms& learned = *options_.learned;
    AddLearnedPairJacobian(learned.pair, weights_ + learned.pair_at(), pair, forces.Parameters(0),
                           forces.state(n), forces.state(j), &jacobian, &by_weight_);
  }
  return jacobian;
}

}  // namespace pushid
