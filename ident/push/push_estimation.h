// ident: the push of a recording that has none, by inverse dynamics over a window of frames:
//   F_t = M(q_t) (qd_{t+1} - qd_t) / dt + C(q_t, qd_t) + G(q_t),   t in [start, end).
// This is the exact inverse of the semi-implicit Euler step: a rollout from (q_start, qd_start) in
// which F is the whole generalized force (PushKind::kNet, PushUse::kAsRecorded) passes through the
// recording's pendulum states up to frame `end`.
//
//   PushEstimationOptions options;
//   Result<PushWindow> window = DetectPushWindow(recording, options);
//   Result<EstimatedPush> estimated = EstimatePush(recording, window.value(), options);
//   WritePushCsv("push.csv", estimated.value().push.force);
//
// Marker noise of s metres makes force noise of about M s / dt^2 (600 N for 2 mm at 60 Hz, 85 kg),
// hence the smoothing; its price is that a sharp onset is spread over half the smoothing window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"

namespace pushid {

// Rows of the push drive the steps start -> start + 1, ..., end - 1 -> end.
struct PushWindow {
  int start = 0;
  int end = 0;
};

struct PushEstimationOptions {
  int person = 0;
  // Window of the zero-phase smoothing of q (Savitzky-Golay, cubic) in frames; odd and at least 5,
  // or 0 for none, which keeps the inverse exact.
  int smoothing_frames = 0;
  // Speed of the person where the window begins: none (zero), or the backward difference
  // (estimated), of which noise makes a first row as large as any. Unset: estimated where the
  // smoothed hip is faster than onset_speed. At frame 0 it is the recording's own start velocity.
  std::optional<InitialVelocity> initial_velocity;
  // Detection: the hip's speed that counts as moving, and its acceleration, as a fraction of the
  // peak, below which the push is over.
  double onset_speed = 0.1;  // m/s
  double end_fraction = 0.05;
};

struct EstimatedPush {
  Push push;
  PushKind kind = PushKind::kNet;
  // The motion that the rows reproduce, frames start .. end: the recording's, smoothed if asked.
  std::vector<PendulumState<double>> motion;
  Vector4<double> impulse = Vector4<double>::Zero();  // N s, N s, N m s, N m s
  double peak_force = 0.0;                            // N, horizontal
  double start_speed = 0.0;                           // m/s, of the cart, at the window's start
};

// The window from the frame where the hip sets off (slowest before it first moves at onset_speed)
// to the end of its acceleration along its way, judged on the hip smoothed over 0.15 s.
Result<PushWindow> DetectPushWindow(const PendulumRecording& recording,
                                    const PushEstimationOptions& options);

// `given` where both of its ends are at least 0; a negative one is detected.
Result<PushWindow> PushWindowFrom(const PushWindow& given, const PendulumRecording& recording,
                                  const PushEstimationOptions& options);

// Reads an initial_velocity by name: zero, estimated or auto (unset). what: --initial_velocity.
MaybeError ParseInitialVelocity(const std::string& what, const std::string& name,
                                std::optional<InitialVelocity>* value);

// Errors: no such person, a window outside the recording or of no frames, an unsound smoothing
// window, angles outside the model's domain (|angle| > 1.4 rad).
Result<EstimatedPush> EstimatePush(const PendulumRecording& recording, const PushWindow& window,
                                   const PushEstimationOptions& options);

}  // namespace pushid
