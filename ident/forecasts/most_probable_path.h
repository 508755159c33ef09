// ident: most probable paths under the process noise of a model or a generator, and the same given
// measurements.
//
// Between two ends: the path of least action (residuals/cost_functions/path_residual.h), with its
// nodes as parameter blocks of one sparse least-squares problem. Smoothed: the same with the
// measurements of a recording, which fills gaps and gives states and the forces that drove them.
// Of several ends the most probable one has the least action (Fig. 5 of Lyu et al., ACM MM 2021, by
// minimization instead of by drawing).
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"
#include "models/generators/motion_generator.h"
#include "models/rollout.h"

namespace pushid {

// Where a path begins or ends.
struct PathEnd {
  PendulumState<double> state;
  bool rates_held = true;  // false: only the place is held
};

struct ProbablePath {
  RolloutPath<double> states;
  FrameTable<Vector4<double>> noise;  // generalized force that drove each frame beside the model's
  // -log probability, relative to other paths of the same frames under the same model: of the noise
  // and of the divergence, nats; of the measurements, where there are any.
  double noise_action = 0.0, divergence_action = 0.0, measurement_cost = 0.0;
  int iterations = 0;

  double action() const { return noise_action + divergence_action; }
};

// One person of the model's, upright at rest in frame 0 of a scene of `body`, without a push.
// Errors: no process noise in the model; noise that grows with the speed, for which the action is
// another; too few frames; ends outside the domain; no optimum.
Result<ProbablePath> PathBetween(const IdentifiedModel& model, const Body& body, double fps,
                                 const PathEnd& from, const PathEnd& to, int num_frames);

// Everybody of a recording, given all of it.
Result<ProbablePath> SmoothPath(const IdentifiedModel& model, const PendulumRecording& recording);

// "x=0.1,theta=0.05,xd=0.3": q x, y (m), theta, phi (rad), qd xd, yd, thetad, phid; what is not
// named is 0. Rates are held where one of them is named, or `always`.
Result<PathEnd> ParsePathEnd(const std::string& flag, const std::string& text, bool always);

// frame, time_s and, per person, q, qd and the noise.
MaybeError WritePathCsv(const std::string& file, const ProbablePath& path, double dt);

// The most probable way to a pose (SDE's Fig. 5): among sampled futures, and by minimization.
//
// Among futures whose last pose is near a target, the one whose transitions have the largest
// likelihood: the least action of the sampled paths. With few samples the true optimum is not among
// them; more samples come nearer to it.
//
// Minimized: the action -log p of a path under the learned drift and noise (residuals/
// cost_functions/path_residual.h has that of the physics), with the end held. What was learned
// remembers all of the path, so that all nodes of a path would depend on each other. The
// coordinates are therefore the noise that drives it, and the action is
//   sum |e|^2 / 2 + sum log g(e),   rows e and sqrt(2 (sum log g + c)), and (S_T(e) - target) / w
// one residual block for Ceres, its derivatives by differences of futures rolled out side by side.
struct PathChoice {
  int future = 0;         // its index
  int near = 0;           // how many futures ended near enough
  double distance = 0.0;  // of its last pose from the target, mean of joints, m
  double log_likelihood = 0.0;
};

// Errors: no future ends within `distance` (m) of the target; the message says how near they come.
Result<PathChoice> MostProbablePath(const std::vector<SampledFuture>& futures,
                                    const Eigen::VectorXf& target, double distance,
                                    const ParticleLayout& layout);

struct MinimizedPath {
  Trajectories motion;
  double distance = 0.0;        // of its last pose from the target, mean of joints, m
  double log_likelihood = 0.0;  // of its transitions, with noise that is drawn anew every frame
  double of_forecast = 0.0;     // the same of the path that nothing drives, wherever it ends
  int iterations = 0;
};

// target: the last pose wanted. Errors: a kind without transitions; no optimum.
Result<MinimizedPath> PathToPose(const MotionGenerator& generator, const ObservedMotion& person,
                                 int frames, const Eigen::VectorXf& target);

}  // namespace pushid
