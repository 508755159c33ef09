// models: how long pushes and their tails are, and the push of the settling simulations.
#include "models/push.h"

#include <algorithm>

namespace pushid {

double LogTailDuration(double push_duration) {
  return std::log(std::min(push_duration, kLongestTailDuration) / kTailReferenceDuration);
}

TailOf<double> TailAt(const ScenePush& push, double mass, int frame, double dt) {
  const double force = push.mean.head<2>().norm();
  return {push.mean, force > 0.0 ? mass / force : 0.0,
          LogTailDuration(static_cast<double>(push.force.size()) * dt),
          (frame - push.EndFrame()) * dt};
}

double TailImpulse(const ScenePush& push, double mass, const ParameterSet<double>& p, double dt) {
  if (push.kind == PushKind::kExternal || push.force.empty()) return 0.0;
  const TailOf<double> tail = TailAt(push, mass, push.EndFrame(), dt);
  // The sum of TailForce over all frames to come, a geometric series.
  return push.mean.head<2>().norm() * tail.Gain(p) * dt /
         -std::expm1(-dt / TailDecayTime(p, tail.log_duration));
}

double WholeImpulse(const ScenePush& push, double mass, const ParameterSet<double>& p, double dt) {
  const double duration = static_cast<double>(push.force.size()) * dt;
  return push.mean.head<2>().norm() * duration + TailImpulse(push, mass, p, dt);
}

std::vector<Vector4<double>> HalfSinePush(const Body& body, double impulse, int frames, double dt) {
  double sum = 0.0;
  std::vector<double> shape;
  for (int k = 0; k < frames; ++k) {
    shape.push_back(std::sin(M_PI * (k + 0.5) / frames));
    sum += shape.back() * dt;
  }
  std::vector<Vector4<double>> force;
  const Vector4<double> upright = Vector4<double>::Zero();
  for (double value : shape) {
    force.push_back(
        GeneralizedForce<double>(body, upright, {value * impulse / sum, 0.0, 0.0}, 1.0));
  }
  return force;
}

}  // namespace pushid
