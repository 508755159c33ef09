// ident: what moves people who stand on and on, and how they answer, as series over frames.
//
// Input u: of the ground's shift (m) or tilt (rad) and of external pushes (N), in both planes, what
// accelerates a person most. Output y: the angle of the body in the laboratory (rad), and the
// ankles' torque (N m),
//   about theta  tau = -F_z (p_x - x) - h F_x,   about phi  tau = F_z (p_y - y) + h F_y
// by platforms where these measured (ground_reaction.h; less that at rest, F_z = M g_n), else by
// inverse dynamics of the recorded motion with the model's body,
//   tau = [M (a + A) + C + (g_n / g) G - Q_push] in the angle's row.
#pragma once

#include <optional>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/problem/linear_loop.h"

namespace pushid {

enum class LoopOutput { kAngle, kTorque };
constexpr EnumNames<LoopOutput, 2> Names(LoopOutput) {
  return {{{"angle", LoopOutput::kAngle}, {"torque", LoopOutput::kTorque}}};
}

// What moves a person on and on: none where nothing does, as pushes of a fraction of a second.
struct ContinuousInput {
  Disturbance kind = Disturbance::kGroundShift;
  int plane = 0;
  int person = 0;              // who is pushed
  double lever = 0.0;          // m, of a force
  std::vector<double> series;  // one per frame
};
std::optional<ContinuousInput> ContinuousInputOf(const PendulumRecording& recording);

// One value per frame; where the person was not seen, that of the frame before. recording: as the
// model sees it (own_axes.h).
std::vector<double> OutputSeries(const PendulumRecording& recording, int person, int plane,
                                 LoopOutput output, const ModelOptions& options,
                                 const ParameterSet<double>& p);

}  // namespace pushid
