// ident: residuals before any weight; of people alone side by side.
#include "ident/problem/raw_residuals.h"

#include "residuals/cost_functions/lane_group.h"

namespace pushid {

ResidualSigmas PlainSigmas(const FitProblem& problem) {
  ResidualSigmas plain = problem.options().sigmas;
  plain.robust = 0.0;
  return plain;
}

std::vector<std::vector<double>> ResidualsOf(const std::vector<RolloutAt>& rollouts) {
  std::vector<std::vector<double>> raw(rollouts.size());
  std::vector<const RolloutProblem*> in_lanes(rollouts.size(), nullptr);
  for (size_t i = 0; i < rollouts.size(); ++i) {
    const RolloutProblem* const problem = rollouts[i].problem.get();
    if (problem == nullptr) continue;
    if (HasLanes(*problem)) {
      in_lanes[i] = problem;
      continue;
    }
    raw[i].resize(problem->num_residuals());
    if (!RolloutResiduals(*problem, rollouts[i].blocks.data(), raw[i].data())) raw[i].clear();
  }
  for (const SideBySide& group : PutSideBySide(in_lanes)) {
    std::vector<double const* const*> at;
    for (int i : group.members) at.push_back(rollouts[i].blocks.data());
    std::vector<RolloutSums> results = group.lanes.Evaluate(at, LaneSums::kNone);
    for (size_t k = 0; k < results.size(); ++k) {
      raw[group.members[k]] = std::move(results[k].residuals);
    }
  }
  return raw;
}

ResidualsByRecording RawResiduals(const FitProblem& problem, const FitPoint& point,
                                  const std::vector<bool>& wanted) {
  FitPoint copy = point;
  const ResidualSigmas plain = PlainSigmas(problem);
  std::vector<RolloutAt> rollouts(problem.recordings().size());
  for (int i = 0; i < static_cast<int>(rollouts.size()); ++i) {
    if (!wanted.empty() && !wanted[i]) continue;
    rollouts[i] = {MakeRolloutProblem(problem.recordings()[i], problem.options().model,
                                      problem.map(), plain, 1.0, 0),
                   problem.RecordingBlocks(&copy, i)};
  }
  return ResidualsOf(rollouts);
}

}  // namespace pushid
