// ident: an external push from a measured force: the samples are averaged over the recording's
// frames, so that the impulse is kept, and turned into a generalized force at the contact point.
//
// Between samples the force is taken as linear, outside them as zero. Row t is the mean over
// [t dt, (t + 1) dt). Rejected: sampling the force at the frames, which loses part of a short push.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/sensors/sensor_choice.h"
#include "datasets/sensors/sensor_csv.h"

namespace pushid {

struct SensorPushOptions {
  int person = 0;
  // Of a force given along the sensor's axis: where it pushes the person, in the project's axes; of
  // any length. A record with fx, fy, fz has its own.
  Vector3<double> direction = {1.0, 0.0, 0.0};
  // Where it acts: fraction of the rod from cart to hip (above 1: above the hip), or, when given,
  // metres above the recording's zero height, judged at the push's first frame.
  double height_fraction = 1.0;
  std::optional<double> height_m;
  double frame_zero_time_s = 0.0;  // on the sensor's clock
  double clock_error_s = 0.0;      // of that: so far outside the recording a force is not lost
  // Forces up to this size (N) before and after the push are the sensor's idling: rows whose mean
  // is no greater, or (but one row) below a hundredth of the largest row's, are cut off at both
  // ends: a push that goes on in noise would have no end.
  double idle_force = 0.0;
};

// The rows' kind is PushKind::kExternal. Errors: no such person, no direction, a contact height
// that is not finite, no force at all, or more than 1 % of the impulse outside the recording.
Result<Push> PushFromSensor(const SensorRecord& record, const PendulumRecording& recording,
                            const SensorPushOptions& options);

// The push of a person from one force sensor, or from several that push together.

struct SensorSetup {
  std::vector<SensorChoice> sensors;  // which push together
  bool start_given = false;           // their clocks at frame 0 are not taken from the motion
  bool estimate_offset = false;       // of their clocks from the motion's
  double max_offset_s = 0.5;          // how far estimate_offset looks on either side
};

struct SensorPush {
  Push push;
  std::string how;                    // for people
  std::vector<std::string> warnings;  // for stderr
};

// The sum of the sensors' pushes on a person; `recorded` is the recording as it was read.
Result<SensorPush> PushFromSensors(const SensorSetup& setup, const Recording& recorded,
                                   const PendulumRecording& recording, int person);

}  // namespace pushid
