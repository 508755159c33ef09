// ident: residuals before any weight; of people alone side by side.
#include "ident/problem/raw_residuals.h"

namespace pushid {

ResidualSigmas PlainSigmas(const FitProblem& problem) {
  ResidualSigmas plain = problem.options().sigmas;
  plain.robust = 0.0;
  return plain;
}

std::vector<std::vector<double>> ResidualsOf(const std::vector<RolloutAt>& rollouts) {
  std::vector<RolloutSums> sums = SumUp(PutSideBySide(rollouts), rollouts, LaneSums::kNone);
  std::vector<std::vector<double>> raw(rollouts.size());
  for (size_t i = 0; i < rollouts.size(); ++i) {
    const RolloutProblem* const problem = rollouts[i].problem.get();
    raw[i] = std::move(sums[i].residuals);
    if (problem == nullptr || HasLanes(*problem)) continue;
    raw[i].resize(problem->num_residuals());
    if (!RolloutResiduals(*problem, rollouts[i].blocks.data(), raw[i].data())) raw[i].clear();
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
