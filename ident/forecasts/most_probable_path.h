// ident: most probable paths of a person under the process noise of a model.
//
// The path between two ends is that of least action
// (residuals/cost_functions/likelihood_residual.h), with its nodes as parameter blocks of one
// sparse least-squares problem. Of several ends, the most probable one has the least action (Fig. 5
// of Lyu et al., ACM MM 2021, by minimization instead of sampling).
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/model/identified_model.h"
#include "models/rollout.h"

namespace pushid {

// The first or the last state of a path.
struct PathEnd {
  PendulumState<double> state;
  bool rates_held = true;  // false: only the place is held
};

struct ProbablePath {
  RolloutPath<double> states;
  FrameTable<Vector4<double>> noise;  // generalized force in addition to the model's, by frame
  // -log probability of the noise and of the divergence, in nats, up to a constant for paths of the
  // same length under the same model.
  double noise_action = 0.0, divergence_action = 0.0;

  double action() const { return noise_action + divergence_action; }
};

// The most probable path of one person without a push. Errors: no process noise in the model; too
// few frames; ends outside the domain; no optimum.
Result<ProbablePath> PathBetween(const IdentifiedModel& model, const Body& body, double fps,
                                 const PathEnd& from, const PathEnd& to, int num_frames);

// "x=0.1,theta=0.05,xd=0.3": q x, y (m), theta, phi (rad), qd xd, yd, thetad, phid; values that are
// not named are 0. Rates are held if one of them is named, or with `always`.
Result<PathEnd> ParsePathEnd(const std::string& flag, const std::string& text, bool always);

// frame, time_s, q, qd and the noise (p0_x, ...).
MaybeError WritePathCsv(const std::string& file, const ProbablePath& path, double dt);

}  // namespace pushid
