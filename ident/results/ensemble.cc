// ident: fitting seed after seed, and the median of their predictions.
#include "ident/results/ensemble.h"

#include <algorithm>

#include "ident/parameters/self_network_io.h"
#include "ident/prediction/prediction.h"
#include "ident/solver/solver.h"

namespace pushid {
namespace {

// The median of what `value` picks from each of them.
template <typename Pick>
double MedianOf(const std::vector<Prediction>& predictions, const Pick& value) {
  std::vector<double> values;
  for (const Prediction& prediction : predictions) values.push_back(value(prediction));
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

template <typename Vector, typename Pick>
Vector MedianVector(const std::vector<Prediction>& predictions, const Pick& vector) {
  Vector median;
  for (int i = 0; i < median.size(); ++i) {
    median[i] = MedianOf(predictions, [&](const Prediction& p) { return vector(p)[i]; });
  }
  return median;
}

NetForce<double> MedianForce(const std::vector<Prediction>& predictions, int frame, int person) {
  NetForce<double> median;
  for (ForcePart part : kForceParts) {
    median[part] = MedianVector<Vector4<double>>(
        predictions, [&](const Prediction& p) { return p.forces.At(frame, person)[part]; });
  }
  return median;
}

}  // namespace

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

Prediction MedianPrediction(const PendulumRecording& recording,
                            const std::vector<Prediction>& predictions) {
  Prediction median = predictions.front();
  for (int n = 0; n < static_cast<int>(median.rod_lift.size()); ++n) {
    median.rod_lift[n] = MedianOf(predictions, [n](const Prediction& p) { return p.Lift(n); });
  }
  for (int t = 0; t < median.path.num_frames(); ++t) {
    for (int n = 0; n < recording.num_people(); ++n) {
      PendulumState<double>& state = median.path.At(t, n);
      state.q = MedianVector<Vector4<double>>(
          predictions, [&](const Prediction& p) { return p.path.At(t, n).q; });
      state.qd = MedianVector<Vector4<double>>(
          predictions, [&](const Prediction& p) { return p.path.At(t, n).qd; });
      state.rod = MedianOf(predictions, [&](const Prediction& p) { return p.path.At(t, n).rod; });
      median.hip[n][t] = HipPosition(median.BodyAt(recording.scene, t, n), state.q);
      median.forces.At(t, n) = MedianForce(predictions, t, n);
    }
  }
  return median;
}

}  // namespace pushid
