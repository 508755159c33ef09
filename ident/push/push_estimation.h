// ident: the push of a recording that has none: by inverse dynamics, or from force sensors.
//
// Inverse dynamics over a window of frames give it as
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

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/force_csv.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/sensors/force_sensors.h"

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
};

struct EstimatedPush {
  Push push;
  PushKind kind = PushKind::kNet;
  // The motion that the rows reproduce, frames start .. end: the recording's, smoothed if asked.
  std::vector<PendulumState<double>> motion;
  double start_speed = 0.0;  // m/s, of the cart, at the window's start
};

// The window from the frame where the hip sets off (slowest before it first moves at 0.1 m/s)
// to the end of its acceleration along its way, judged on the hip smoothed over 0.15 s. given: ends
// of at least 0 are taken as they are.
Result<PushWindow> DetectPushWindow(const PendulumRecording& recording,
                                    const PushEstimationOptions& options,
                                    const PushWindow& given = {-1, -1});

// The person is at rest where the window begins, unless the smoothed hip is faster than 0.1 m/s
// there (of a backward difference noise makes a first row as large as any); at frame 0 it is the
// recording's own start velocity. Errors: no such person, a window outside the recording or of no
// frames, an unsound smoothing window, angles outside the model's domain (|angle| > 1.4 rad).
Result<EstimatedPush> EstimatePush(const PendulumRecording& recording, const PushWindow& window,
                                   const PushEstimationOptions& options);

// An external push from a measured force: the samples are averaged over the recording's
// frames, so that the impulse is kept, and turned into a generalized force at the contact point.
//
// Between samples the force is taken as linear, outside them as zero. Row t is the mean over
// [(t - 1/2) dt, (t + 1/2) dt): a step changes the rates, which are those between two frames, from
// half a frame before frame t to half a frame after it (models/reaction_delay.h). Positions are
// then of second order. Rejected: the mean over [t dt, (t + 1) dt), which pushes half a frame
// early; sampling the force at the frames, which loses part of a short push.

// sensor: its direction (of any length) counts where the record is no vector; heights are judged at
// the push's first frame, in metres where height_m is given. Forces up to idle_force before and
// after the push are the sensor's idling: rows whose mean is no greater, or (but one row) below a
// hundredth of the largest row's, are cut off at both ends: a push that goes on in noise would have
// no end.
//
// The rows' kind is PushKind::kExternal. Errors: no such person, no direction, a contact height
// that is not finite, no force at all, or more than 1 % of the impulse outside the recording.
Result<Push> PushFromSensor(const SensorRecord& record, const SensorChoice& sensor,
                            const PendulumRecording& recording, int person);

// The push of a person from one force sensor, or from several that push together.

struct SensorPush {
  Push push;
  std::string how;                    // for people
  std::vector<std::string> warnings;  // for stderr
};

// The sum of the sensors' pushes on a person; `recorded` is the recording as it was read.
Result<SensorPush> PushFromSensors(const std::vector<SensorChoice>& sensors,
                                   const Recording& recorded, const PendulumRecording& recording,
                                   int person);

}  // namespace pushid
