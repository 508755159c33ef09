// ident: a path to a pose.
#include "ident/generators/path_search.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"

namespace pushid {

Result<PathChoice> MostProbablePath(const std::vector<SampledFuture>& futures,
                                    const Eigen::VectorXf& target, double distance,
                                    const ParticleLayout& layout) {
  PathChoice choice;
  double nearest = HUGE_VAL;
  for (size_t i = 0; i < futures.size(); ++i) {
    const Trajectories end = futures[i].motion.rightCols(1);
    const double away = MeanDistance(end, target, layout)(0);
    nearest = std::min(nearest, away);
    if (away > distance) continue;
    ++choice.near;
    if (choice.near > 1 && futures[i].log_likelihood <= choice.log_likelihood) continue;
    choice.future = static_cast<int>(i);
    choice.distance = away;
    choice.log_likelihood = futures[i].log_likelihood;
  }
  if (choice.near > 0) return choice;
  return Error{"none of " + std::to_string(futures.size()) + " sampled futures ends within " +
               Rounded(distance, 3) + " m of the target; the nearest is " + Rounded(nearest, 3) +
               " m away: raise --samples or --target_distance"};
}

}  // namespace pushid
