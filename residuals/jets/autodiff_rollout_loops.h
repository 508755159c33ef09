// residuals: the passes of autodiff_rollout.h for the file that includes this, which says how many
// doubles a vector has (models/jet.h). What is compiled here for wide vectors must not be linked to
// by other files: every template is one of a type without linkage, and the few inline functions
// that have linkage use no vectors (tests/residuals/shared_code.sh looks into the objects).
#pragma once

#include "residuals/jets/autodiff_rollout.h"

namespace pushid {
namespace {

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
  return new StepByJet<VectorJet>(scene, options, parameters);
}

}  // namespace

template <>
const RolloutJets& OfWidth<RolloutJets, PUSHID_WIDTH>() {
  static constexpr RolloutJets jets = {PUSHID_WIDTH, alignof(Vector4<double>), PassOfRows,
                                       PassOfStates, MakeStep};
  return jets;
}

}  // namespace pushid
