// ident: most probable paths of a person under the process noise of a model.
//
// Between two ends: the path of least action (residuals/cost_functions/likelihood_residual.h), with
// its nodes as parameter blocks of one sparse least-squares problem. Of several ends the most
// probable one has the least action (Fig. 5 of Lyu et al., ACM MM 2021, by minimization instead of
// by drawing).
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/model/identified_model.h"
#include "models/rollout.h"

namespace pushid {

// Where a path begins or ends.
struct PathEnd {
  PendulumState<double> state;
  bool rates_held = true;  // false: only the place is held
};

// A path of one person.
struct ProbablePath {
  RolloutPath<double> states;
  FrameTable<Vector4<double>> noise;  // generalized force that drove each frame beside the model's
  // -log probability, relative to other paths of the same frames under the same model: of the noise
  // and of the divergence, nats.
  double noise_action = 0.0, divergence_action = 0.0;

  double action() const { return noise_action + divergence_action; }
};

// One person of the model's, upright at rest in frame 0 of a scene of `body`, without a push.
// Errors: no process noise in the model; noise that grows with the speed, for which the action is
// another; too few frames; ends outside the domain; no optimum.
Result<ProbablePath> PathBetween(const IdentifiedModel& model, const Body& body, double fps,
                                 const PathEnd& from, const PathEnd& to, int num_frames);

// "x=0.1,theta=0.05,xd=0.3": q x, y (m), theta, phi (rad), qd xd, yd, thetad, phid; what is not
// named is 0. Rates are held where one of them is named, or `always`.
Result<PathEnd> ParsePathEnd(const std::string& flag, const std::string& text, bool always);

// frame, time_s, q, qd and the noise (p0_x, ...).
MaybeError WritePathCsv(const std::string& file, const ProbablePath& path, double dt);

}  // namespace pushid
