// residuals: the passes of autodiff_rollout.h for the file that includes this, which says how many
// doubles a vector has (vector_jet.h). What is compiled here for wide vectors must not be linked to
// by other files: every template is one of a type without linkage, and the few inline functions
// that have linkage use no vectors (tests/residuals/shared_code.sh looks into the objects).
#pragma once

#include "residuals/jets/autodiff_rollout.h"
#include "residuals/jets/vector_jet.h"

namespace pushid {
namespace {

// What a rollout is run with, with its derivatives by eight columns.
struct JetInputs {
  using Jet = VectorJet;
  std::vector<ParameterSet<Jet>> parameters;
  std::vector<Vector4<Jet>> velocity;
  std::vector<Jet> weights;

  JetInputs(const ModelOptions& options, const SensitivityInputs& in, int first) {
    const auto seed = [first](Jet* jet, int column, double slope) {
      if (column < first || column >= first + Jet::kColumns) return;
      jet->AddSlope(column - first, slope);
    };
    const size_t people = in.parameters.size();
    parameters.resize(people);
    velocity.resize(people);
    for (size_t n = 0; n < people; ++n) {
      for (int i = 0; i < kNumParameters; ++i) parameters[n][i] = Jet(in.parameters[n][i]);
      for (const ColumnEntry& entry : in.entries[n]) {
        seed(&parameters[n][entry.parameter], entry.column, entry.derivative);
      }
      for (int i = 0; i < 4; ++i) {
        velocity[n][i] = Jet(in.initial_velocity[n][i]);
        if (in.velocity_column < 0) continue;
        seed(&velocity[n][i], in.velocity_column + 4 * static_cast<int>(n) + i, 1.0);
      }
    }
    if (options.learned == nullptr) return;
    const double* const from =
        in.network_weights != nullptr ? in.network_weights : options.learned->weights.data();
    weights.resize(options.learned->weights.size());
    for (size_t i = 0; i < weights.size(); ++i) {
      weights[i] = Jet(from[i]);
      if (in.weight_column < 0) continue;
      seed(&weights[i], in.weight_column + static_cast<int>(i), 1.0);
    }
  }
  const Jet* network() const { return weights.empty() ? nullptr : weights.data(); }
};

RolloutStatus PassOfRows(const RolloutProblem& problem, const SensitivityInputs& in, int first,
                         double* residuals, double* rows) {
  thread_local std::vector<VectorJet> jets;
  jets.resize(problem.num_residuals());
  const JetInputs inputs(problem.options, in, first);
  const RolloutStatus status = RolloutResidual::Rows<VectorJet>(
      problem, inputs.parameters, inputs.velocity, inputs.network(), jets.data());
  if (!status.ok) return status;
  for (size_t i = 0; i < jets.size(); ++i) {
    residuals[i] = jets[i].a;
    jets[i].StoreSlopes(rows + i * in.num_columns + first);
  }
  return status;
}

RolloutStatus PassOfStates(const Scene& scene, const ModelOptions& options,
                           const SensitivityInputs& in, int num_frames, int first,
                           RolloutPath<double>* path, StateColumns* columns) {
  thread_local RolloutPath<VectorJet> jets;
  const JetInputs inputs(options, in, first);
  const RolloutStatus status =
      Rollout<VectorJet>(scene, options, inputs.parameters, inputs.velocity, num_frames, &jets,
                         nullptr, inputs.network());
  const int end = status.ok ? num_frames : status.frame + 1;
  for (int t = 0; t < end; ++t) {
    for (int n = 0; n < scene.num_people(); ++n) {
      const PendulumState<VectorJet>& from = jets.At(t, n);
      PendulumState<double>& to = path->At(t, n);
      double* const rows = columns->At(t, n).data() + first;
      for (int i = 0; i < 4; ++i) {
        to.q[i] = from.q[i].a;
        to.qd[i] = from.qd[i].a;
        from.q[i].StoreSlopes(rows + i * in.num_columns);
        from.qd[i].StoreSlopes(rows + (4 + i) * in.num_columns);
      }
      to.rod = from.rod.a;
    }
  }
  return status;
}

StateStep* MakeStep(const Scene& scene, const ModelOptions& options,
                    const std::vector<ParameterSet<double>>& parameters) {
  return new DualStep<VectorJet>(scene, options, parameters);
}

}  // namespace

template <>
const RolloutJets& RolloutJetsOf<PUSHID_WIDTH>() {
  static constexpr RolloutJets jets = {PUSHID_WIDTH, alignof(Vector4<double>), PassOfRows,
                                       PassOfStates, MakeStep};
  return jets;
}

}  // namespace pushid
