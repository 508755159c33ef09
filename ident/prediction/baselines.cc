// ident: what any prediction has to beat: standing still, going on, and the model started anew.
#include <algorithm>

#include "ident/prediction/evaluation.h"
#include "ident/results/model_rollout.h"
#include "models/scene_forces.h"

namespace pushid {

HipPaths StaticBaseline(const PendulumRecording& recording, int observed) {
  HipPaths paths;
  for (const auto& hip : recording.hip) {
    HipPath path(hip.begin(), hip.begin() + std::max(1, observed));
    path.resize(hip.size(), Vector3<double>(path.back()));
    paths.push_back(std::move(path));
  }
  return paths;
}

HipPaths ConstantVelocityBaseline(const PendulumRecording& recording, int observed) {
  HipPaths paths;
  const int known = observed > 0 ? observed - 1 : recording.scene.LastPushEnd();
  const int last = std::min(known, recording.num_frames() - 1);
  for (const auto& hip : recording.hip) {
    std::vector<Vector3<double>> path(hip.begin(), hip.begin() + last + 1);
    const Vector3<double> step =
        last > 0 ? Vector3<double>(hip[last] - hip[last - 1]) : Vector3<double>::Zero();
    while (path.size() < hip.size()) path.push_back(path.back() + step);
    paths.push_back(std::move(path));
  }
  return paths;
}

Prediction PredictReanchored(const IdentifiedModel& model, const PendulumRecording& recording,
                             int observed) {
  Prediction prediction = Predict(model, recording);
  if (!prediction.status.ok || observed <= 1) return prediction;
  const int people = recording.num_people(), from = observed - 1;
  for (int n = 0; n < people; ++n) {
    for (int t = 1; t <= from; ++t) {
      PendulumState<double>& state = prediction.path.At(t, n);
      state.q = recording.states[n][t].q;
      state.qd = recording.states[n][t].qd;
    }
  }
  const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  SceneForces<double> forces(recording.scene, model.options, parameters);
  prediction.status =
      RollOn<double>(recording.scene, model.options, &forces, from, &prediction.path);
  if (!prediction.status.ok) return prediction;
  for (int n = 0; n < people; ++n) {
    // From where the hip was seen, which the rod of frame 0 puts elsewhere.
    const auto tip = [&](int t) {
      return HipPosition(prediction.BodyAt(recording.scene, t, n), prediction.path.At(t, n).q);
    };
    const Vector3<double> off = recording.hip[n][from] - tip(from);
    for (int t = 1; t < recording.num_frames(); ++t) {
      prediction.hip[n][t] = t <= from ? recording.hip[n][t] : Vector3<double>(tip(t) + off);
    }
  }
  return prediction;
}

}  // namespace pushid
