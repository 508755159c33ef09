// ident: residuals before any weight; of people alone side by side.
#include "ident/problem/raw_residuals.h"

#include "residuals/cost_functions/lane_group.h"

namespace pushid {

ResidualsByRecording RawResiduals(const FitProblem& problem, const FitPoint& point,
                                  const std::vector<bool>& wanted) {
  FitPoint copy = point;
  ResidualSigmas plain = problem.options().sigmas;
  plain.robust = 0.0;
  const int total = static_cast<int>(problem.recordings().size());
  ResidualsByRecording raw(total);
  std::vector<std::shared_ptr<const RolloutProblem>> rollouts(total);
  std::vector<const RolloutProblem*> in_lanes(total, nullptr);
  std::vector<std::vector<double*>> blocks(total);
  for (int i = 0; i < total; ++i) {
    if (!wanted.empty() && !wanted[i]) continue;
    rollouts[i] = MakeRolloutProblem(problem.recordings()[i], problem.options().model,
                                     problem.map(), plain, 1.0, 0);
    blocks[i] = problem.RecordingBlocks(&copy, i);
    if (HasLanes(*rollouts[i])) {
      in_lanes[i] = rollouts[i].get();
      continue;
    }
    raw[i].resize(rollouts[i]->num_residuals());
    if (!RolloutResiduals(*rollouts[i], blocks[i].data(), raw[i].data())) raw[i].clear();
  }
  for (const SideBySide& group : PutSideBySide(in_lanes)) {
    std::vector<double const* const*> at;
    for (int i : group.members) at.push_back(blocks[i].data());
    std::vector<RolloutSums> results = group.lanes.Evaluate(at, LaneSums::kNone);
    for (size_t k = 0; k < results.size(); ++k) {
      raw[group.members[k]] = std::move(results[k].residuals);
    }
  }
  return raw;
}

}  // namespace pushid
