// ident: the offset between the clocks of a force sensor and of the cameras, as a parameter of a
// small fit of its own.
//
// Along the push's direction the momentum of the pendulum changes by the push, the ground's
// friction and the person's own recovery (ipm.h, self_force.h). Integrated twice,
//   s(t) = s_0 + v_0 t + G(t + tau) / M + a iint e + b int (x - x_0),
// s = 0.9 hip + 0.1 cart, G the measured force integrated twice, e the lean, x the cart. tau is the
// only parameter that enters nonlinearly: for each value the others follow by linear least squares
// (variable projection); a grid over the range, then Gauss-Newton. Positions rather than
// accelerations, because their noise is white and is not differentiated. The standard error is that
// of least squares times sqrt((1 + r) / (1 - r)), r the residuals' correlation from frame to frame.
// No bias on motion simulated at 960 Hz and seen at 60 Hz but half a step of the simulation, which
// holds a force for a step (tests/studies/sensors.py; of simulations at 60 Hz half a frame is 8
// ms). Rejected: cross-correlation with the inverse-dynamics force, which takes the person's
// reaction for a later push.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/sensors/sensor_csv.h"

namespace pushid {

// A sensor's forces as vectors in the project's axes, with its clock's reading at frame 0.
struct TimedRecord {
  SensorRecord record;
  double frame_zero_time_s = 0.0;
};

struct SensorOffset {
  double offset_s = 0.0;  // to be added to every frame_zero_time_s
  double standard_error_s = 0.0;
  double rms_m = 0.0;  // of what the fit leaves
  double gain = 1.0;   // the multiple of the force that would fit the motion best
};

// max_offset_s: how far to look on either side. Errors: no such person, no force, too short a
// recording, a best offset at the end of the range, a motion that does not tell the time (a
// standard error of a quarter of the range) or goes against the force.
Result<SensorOffset> EstimateSensorOffset(const std::vector<TimedRecord>& forces,
                                          const PendulumRecording& recording, int person,
                                          double max_offset_s);

}  // namespace pushid
