// ident: medians, number by number.
#include "ident/prediction/median_prediction.h"

#include <utility>

#include "ident/uncertainty/median.h"

namespace pushid {
namespace {

// The median of what `value` picks from each of them.
template <typename Pick>
double MedianOf(const std::vector<Prediction>& predictions, const Pick& value) {
  std::vector<double> values;
  for (const Prediction& prediction : predictions) values.push_back(value(prediction));
  return Median(std::move(values));
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

Prediction MedianPrediction(const PendulumRecording& recording,
                            const std::vector<Prediction>& predictions) {
  Prediction median = predictions.front();
  for (int n = 0; n < static_cast<int>(median.rod_lift.size()); ++n) {
    median.rod_lift[n] = MedianOf(predictions, [n](const Prediction& p) { return p.Lift(n); });
  }
  for (int t = 0; t < median.path.num_frames(); ++t) {
    for (int n = 0; n < recording.scene.num_people(); ++n) {
      PendulumState<double>& state = median.path.At(t, n);
      state.q = MedianVector<Vector4<double>>(
          predictions, [&](const Prediction& p) { return p.path.At(t, n).q; });
      state.qd = MedianVector<Vector4<double>>(
          predictions, [&](const Prediction& p) { return p.path.At(t, n).qd; });
      state.rod = MedianOf(predictions, [&](const Prediction& p) { return p.path.At(t, n).rod; });
      state.step = MedianOf(predictions, [&](const Prediction& p) { return p.path.At(t, n).step; });
      median.hip[n][t] = HipPosition(median.BodyAt(recording.scene, t, n), state.q);
      median.forces.At(t, n) = MedianForce(predictions, t, n);
    }
  }
  return median;
}

}  // namespace pushid
