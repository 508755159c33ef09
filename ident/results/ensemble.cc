// ident: fitting seed after seed.
#include "ident/results/ensemble.h"

#include "ident/parameters/learned_terms_io.h"
#include "ident/solver/solver.h"

namespace pushid {

std::vector<EnsembleMember> FitOtherSeeds(const std::vector<PendulumRecording>& recordings,
                                          const FitOptions& options) {
  std::vector<EnsembleMember> members;
  for (int k = 1; k < options.ensemble; ++k) {
    FitOptions seeded = options;
    seeded.seed = options.seed + k;
    const LearnedTerms& network = *options.model.learned;
    seeded.model.learned = InitialNetwork(network.shape, seeded.seed, network.rod, network.pair);
    const FitProblem problem(recordings, seeded);
    const Solution solution = Solve(problem);
    if (solution.best < 0) continue;
    const FitPoint& point = solution.Best().to;
    members.push_back({problem.Parameters(point, ""), problem.ModelAt(point).learned});
  }
  return members;
}

}  // namespace pushid
