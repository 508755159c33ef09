// ident: pushes by inverse dynamics, and where in a recording they are.
#include "ident/push/push_estimation.h"

#include <algorithm>
#include <cmath>

#include "models/rollout.h"
#include "models/skeleton_mapping.h"

namespace pushid {
namespace {

constexpr double kDetectionSpan = 0.15;  // s, smoothing of the hip for detection
constexpr int kSustained = 3;            // frames above the onset speed that make an onset

MaybeError CheckEstimationOptions(const PendulumRecording& recording,
                                  const PushEstimationOptions& options) {
  const std::string where = "recording " + recording.id + ": ";
  if (options.person < 0 || options.person >= recording.num_people()) {
    return Error{where + "there is no person " + std::to_string(options.person) + "; it has " +
                 std::to_string(recording.num_people()) + ", counted from 0"};
  }
  const int smoothing = options.smoothing_frames;
  if (smoothing != 0 && (smoothing < 5 || smoothing % 2 == 0)) {
    return Error{"a smoothing window of " + std::to_string(smoothing) +
                 " frames: must be 0 (none) or an odd number from 5"};
  }
  return {};
}

// Smoothed horizontal motion of the hip.
std::vector<SmoothedSample> SmoothedHip(const PendulumRecording& recording, int person) {
  std::vector<Eigen::Vector4d> hip;
  for (const Vector3<double>& p : recording.hip[person]) hip.emplace_back(p.x(), p.y(), 0.0, 0.0);
  const int half = static_cast<int>(std::lround(0.5 * kDetectionSpan / recording.scene.dt));
  return SavitzkyGolay(hip, std::max(5, 2 * half + 1), recording.scene.dt);
}

bool StartsAtRest(const PendulumRecording& recording, int start,
                  const PushEstimationOptions& options) {
  if (options.initial_velocity) return *options.initial_velocity == InitialVelocity::kZero;
  return SmoothedHip(recording, options.person)[start].rate.norm() <= options.onset_speed;
}

}  // namespace

Result<PushWindow> DetectPushWindow(const PendulumRecording& recording,
                                    const PushEstimationOptions& options) {
  if (MaybeError wrong = CheckEstimationOptions(recording, options)) return *std::move(wrong);
  const std::vector<SmoothedSample> hip = SmoothedHip(recording, options.person);
  const int frames = recording.num_frames();
  const auto speed = [&](int t) { return hip[t].rate.norm(); };

  int onset = 0, above = 0;
  for (; onset < frames && above < kSustained; ++onset) {
    above = speed(onset) > options.onset_speed ? above + 1 : 0;
  }
  if (above < kSustained) {
    return Error{"recording " + recording.id + ": the hip of person " +
                 std::to_string(options.person) + " never moves faster than " +
                 std::to_string(options.onset_speed) +
                 " m/s for three frames, so no push is found; name the window or lower the speed"};
  }
  onset -= kSustained;
  PushWindow window;
  window.start = onset;
  while (window.start > 0 && speed(window.start - 1) < speed(window.start)) --window.start;

  // Along the way the person goes: mean direction of the first 0.15 s after the onset.
  const int later =
      std::min(frames - 1, onset + static_cast<int>(kDetectionSpan / recording.scene.dt));
  const Eigen::Vector4d way = (hip[later].value - hip[window.start].value).normalized();
  double peak = 0.0;
  for (window.end = window.start + 1; window.end < frames - 1; ++window.end) {
    const double acceleration = hip[window.end].acceleration.dot(way);
    peak = std::max(peak, acceleration);
    if (window.end > onset && acceleration <= options.end_fraction * peak) break;
  }
  return window;
}

Result<PushWindow> PushWindowFrom(const PushWindow& given, const PendulumRecording& recording,
                                  const PushEstimationOptions& options) {
  if (given.start >= 0 && given.end >= 0) return given;
  const Result<PushWindow> found = DetectPushWindow(recording, options);
  if (!found.ok()) return found;
  return PushWindow{given.start >= 0 ? given.start : found.value().start,
                    given.end >= 0 ? given.end : found.value().end};
}

MaybeError ParseInitialVelocity(const std::string& what, const std::string& name,
                                std::optional<InitialVelocity>* value) {
  if (name == "auto") return std::nullopt;
  *value = FromName<InitialVelocity>(name);
  if (*value && **value != InitialVelocity::kFree) return std::nullopt;
  return Error{what + " is '" + name + "'; it must be zero, estimated or auto"};
}

Result<EstimatedPush> EstimatePush(const PendulumRecording& recording, const PushWindow& window,
                                   const PushEstimationOptions& options) {
  if (MaybeError wrong = CheckEstimationOptions(recording, options)) return *std::move(wrong);
  const int frames = recording.num_frames();
  if (window.start < 0 || window.end <= window.start || window.end >= frames) {
    return Error{"recording " + recording.id + ": a push from frame " +
                 std::to_string(window.start) + " to " + std::to_string(window.end) +
                 " is not within its frames 0 to " + std::to_string(frames - 1)};
  }
  const double dt = recording.scene.dt;
  std::vector<PendulumState<double>> states = recording.states[options.person];
  if (options.smoothing_frames > 0) {
    std::vector<Eigen::Vector4d> q;
    for (const PendulumState<double>& state : states) q.push_back(state.q);
    const std::vector<SmoothedSample> smoothed = SavitzkyGolay(q, options.smoothing_frames, dt);
    for (int t = 0; t < frames; ++t) {
      states[t].q = smoothed[t].value;
      // The smoother's rate is not used: qd must be what an Euler step makes of q.
      if (t > 0) states[t].qd = (states[t].q - states[t - 1].q) / dt;
    }
  }
  if (window.start > 0 && StartsAtRest(recording, window.start, options)) {
    states[window.start].qd.setZero();
  }

  EstimatedPush result;
  result.start_speed = states[window.start].qd.head<2>().norm();
  result.push.person = options.person;
  result.push.start_frame = window.start;
  const Body& body = recording.scene.people[options.person].body;
  for (int t = window.start; t <= window.end; ++t) {
    const PendulumState<double>& state = states[t];
    const std::string_view outside = OutsideDomain(body, state);
    if (!outside.empty()) {
      return Error{"recording " + recording.id + ": " + std::string(outside) + " at frame " +
                   std::to_string(t) + " is outside the model's domain of +-1.4 rad"};
    }
    result.motion.push_back(state);
    if (t == window.end) break;
    const Vector4<double> force =
        InverseDynamics<double>(body, state, (states[t + 1].qd - state.qd) / dt);
    result.push.force.push_back(force);
    result.impulse += dt * force;
    result.peak_force = std::max(result.peak_force, force.head<2>().norm());
  }
  return result;
}

}  // namespace pushid
