// What the tests of early predictions share: recordings whose effects and errors are known.
#pragma once

#include <cmath>
#include <vector>

#include "datasets/files/random.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/online_predictor.h"
#include "tests/ident/fit_samples.h"

namespace pushid {

inline IdentifiedModel TrueModel(const SyntheticOptions& study) {
  IdentifiedModel model;
  model.options = study.model;
  model.table = MakePreset("tail").value().table;
  model.parameters = study.parameters;
  return model;
}

struct PlantedEffects {
  double spread = 0.4, error_scale = 0.1;
  uint64_t seed = 1;
};

// An error of velocity that dies out in 0.3 s, added up, and a little noise; on the scale of a
// recording: along the push, across and upwards.
inline std::vector<Vector3<double>> DrawnErrors(int frames, double dt, double scale,
                                                Random* random) {
  const double r = std::exp(-dt / 0.3);
  // var p after 31 frames of a process with unit velocity.
  const int reference = static_cast<int>(std::lround(31.0 / 60.0 / dt));
  double variance = 0.0;
  for (int t = 1; t <= reference; ++t) {
    for (int u = 1; u <= reference; ++u) {
      variance += dt * dt * (std::pow(r, std::abs(t - u)) - std::pow(r, t + u));
    }
  }
  const double c = 1.0 / std::sqrt(variance);
  const Vector3<double> axis(1.0, 0.3, 0.3);
  std::vector<Vector3<double>> errors = {Vector3<double>::Zero()};
  Vector3<double> p = Vector3<double>::Zero(), v = p;
  for (int t = 1; t < frames; ++t) {
    Vector3<double> y;
    for (int i = 0; i < 3; ++i) {
      v[i] = r * v[i] + c * std::sqrt(1.0 - r * r) * random->Normal();
      p[i] += dt * v[i];
      y[i] = p[i] + 0.05 * random->Normal();
    }
    errors.push_back(scale * axis.cwiseProduct(y));
  }
  return errors;
}

// The model's own motions with errors, of tails that differ from recording to recording.
inline std::vector<PendulumRecording> PlantEffects(const IdentifiedModel& model,
                                                   std::vector<PendulumRecording> recordings,
                                                   const PlantedEffects& planted) {
  Random random(planted.seed);
  for (PendulumRecording& recording : recordings) {
    IdentifiedModel own = model;
    const double factor = std::exp(planted.spread * random.Normal());
    for (Parameter id : {kTailGain, kTailBase}) own.parameters[id] *= factor;
    const Prediction motion = Predict(own, recording);
    EXPECT_TRUE(motion.status.ok);
    const Eigen::Vector2d u = PushDirection(recording);
    Eigen::Matrix3d axes;
    axes << u.x(), -u.y(), 0, u.y(), u.x(), 0, 0, 0, 1;
    const double scale =
        planted.error_scale * FittedPushRange(model, {recording}).impulse_per_mass.upper;
    for (int n = 0; n < recording.num_people(); ++n) {
      const auto errors = DrawnErrors(recording.num_frames(), recording.scene.dt, scale, &random);
      for (int t = 0; t < recording.num_frames(); ++t) {
        recording.hip[n][t] = motion.hip[n][t] + axes * errors[t];
        recording.states[n][t] = motion.path.At(t, n);
      }
    }
  }
  return recordings;
}

}  // namespace pushid
