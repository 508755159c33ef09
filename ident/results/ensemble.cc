// ident: fitting seed after seed.
#include "ident/results/ensemble.h"

#include "ident/parameters/self_network_io.h"
#include "ident/solver/solver.h"

namespace pushid {

std::vector<EnsembleMember> FitOtherSeeds(const std::vector<PendulumRecording>& recordings,
                                          const FitOptions& options) {
  std::vector<EnsembleMember> members;
  for (int k = 1; k < options.ensemble; ++k) {
    FitOptions seeded = options;
    seeded.seed = options.seed + k;
    const SelfNetwork& network = *options.model.self_network;
    seeded.model.self_network = InitialNetwork(network.shape, seeded.seed, network.rod);
    const FitProblem problem(recordings, seeded);
    const Solution solution = Solve(problem);
    if (solution.best < 0) continue;
    const FitPoint& point = solution.Best().to;
    members.push_back({problem.Parameters(point, ""), problem.ModelAt(point).self_network});
  }
  return members;
}

}  // namespace pushid
