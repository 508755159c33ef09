// models: the rollout of a scene, frame by frame by the step of the model (step.h), and the forces
// of a step near rest.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include "models/ipm.h"
#include "models/process_noise.h"
#include "models/step.h"

namespace pushid {

// Quantity that has left the domain, or an empty name. A rod that does not move may have any
// length.
template <typename T>
std::string_view OutsideDomain(const Body& body, const PendulumState<T>& state) {
  const double rod = RealPart(state.rod), length = body.rod_length + rod;
  double sum = rod + RealPart(state.feet.clock);
  for (int i = 0; i < 4; ++i) sum += RealPart(state.q[i]) + RealPart(state.qd[i]);
  if (!std::isfinite(sum)) return "state";
  if (std::abs(RealPart(state.q[2])) > kMaxAngle) return "theta";
  if (std::abs(RealPart(state.q[3])) > kMaxAngle) return "phi";
  if (rod != 0.0 && !(kShortestRod <= length && length <= kLongestRod)) return "rod";
  return {};
}

// The step from frame t of a path to the next, or of the last frame the forces alone; arguments as
// RollOn has them.
template <typename T>
RolloutStatus StepOn(const Scene& scene, ModelStep<T>* forces, int t, RolloutPath<T>* path,
                     FrameTable<NetForce<T>>* trace = nullptr,
                     const FrameTable<Vector4<double>>* noise = nullptr) {
  const bool last = t + 1 == path->num_frames();
  forces->Update(*path, t);
  forces->PrepareAll();
  for (int n = 0; n < scene.num_people(); ++n) {
    const Vector4<T>& qd_previous = path->At(t > 0 ? t - 1 : 0, n).qd;
    NetForce<T> force = forces->On(n, t, qd_previous);
    if (noise != nullptr) {
      const Vector4<double> white = noise->At(t, n) / std::sqrt(scene.dt);
      force[ForcePart::kNoise] =
          NoiseFactor<T>(scene.people[n].body, forces->Parameters(n)) * white.template cast<T>();
    }
    const Vector4<T> qdd = forces->AccelerationOf(n, force);
    if (trace != nullptr) {
      trace->At(t, n) = force;
      trace->At(t, n).AddGround(path->At(t, n).qd + scene.dt * qdd);
    }
    if (last) continue;
    path->At(t + 1, n) = forces->Next(n, qdd, force, qd_previous);
    const std::string_view outside = OutsideDomain(scene.people[n].body, path->At(t + 1, n));
    if (!outside.empty()) return {false, t + 1, n, outside};
  }
  return {};
}

// Goes on from frame `from` of a path, whose states up to there are given; the posture stays that
// of the scene's start. On failure the path holds the frames before the named one. trace may be
// null. noise: standard normal draws by frame and person that drive the process noise
// (process_noise.h); null: none.
template <typename T>
RolloutStatus RollOn(const Scene& scene, ModelStep<T>* forces, int from, RolloutPath<T>* path,
                     FrameTable<NetForce<T>>* trace = nullptr,
                     const FrameTable<Vector4<double>>* noise = nullptr) {
  const int steps = path->num_frames() - (trace == nullptr ? 1 : 0);
  for (int t = from; t < steps; ++t) {
    const RolloutStatus status = StepOn<T>(scene, forces, t, path, trace, noise);
    if (!status.ok) return status;
  }
  return {};
}

// Frame 0 of a path. initial_velocity: one entry per person.
template <typename T>
void StartPath(const Scene& scene, const std::vector<Vector4<T>>& initial_velocity,
               RolloutPath<T>* path) {
  for (int n = 0; n < scene.num_people(); ++n) {
    path->At(0, n).q = scene.people[n].start.q.template cast<T>();
    path->At(0, n).qd = initial_velocity[n];
    path->At(0, n).feet.apart = scene.people[n].start.feet.apart.template cast<T>();
  }
}

// initial_velocity: as above; parameters and network_weights as in ModelStep. path is
// overwritten; on failure, trace and noise: RollOn.
template <typename T>
RolloutStatus Rollout(const Scene& scene, const ModelOptions& options,
                      const std::vector<ParameterSet<T>>& parameters,
                      const std::vector<Vector4<T>>& initial_velocity, int num_frames,
                      RolloutPath<T>* path, FrameTable<NetForce<T>>* trace = nullptr,
                      const T* network_weights = nullptr,
                      const FrameTable<Vector4<double>>* noise = nullptr) {
  const int people = scene.num_people();
  ModelStep<T> forces(scene, options, parameters, network_weights);
  path->Reset(num_frames, people);
  if (trace != nullptr) *trace = FrameTable<NetForce<T>>(num_frames, people);
  StartPath(scene, initial_velocity, path);
  return RollOn<T>(scene, &forces, 0, path, trace, noise);
}

// The instances for doubles are compiled once (rollout.cc): it takes the compiler seconds.
extern template RolloutStatus StepOn<double>(const Scene&, ModelStep<double>*, int,
                                             RolloutPath<double>*, FrameTable<NetForce<double>>*,
                                             const FrameTable<Vector4<double>>*);
extern template RolloutStatus RollOn<double>(const Scene&, ModelStep<double>*, int,
                                             RolloutPath<double>*, FrameTable<NetForce<double>>*,
                                             const FrameTable<Vector4<double>>*);
extern template RolloutStatus Rollout<double>(const Scene&, const ModelOptions&,
                                              const std::vector<ParameterSet<double>>&,
                                              const std::vector<Vector4<double>>&, int,
                                              RolloutPath<double>*, FrameTable<NetForce<double>>*,
                                              const double*, const FrameTable<Vector4<double>>*);

// First derivatives, at rest in the reference posture, of the net force on a person whom nobody
// pushes or touches less gravity: does a small deviation die out (ident/problem/behaviour.h), and
// what are the margins of the loop (ident/problem/linear_loop.h)? Where feet stand or hold, rest is
// standing: the ankles balance, and the ground resists the cart.
struct RestJacobian {
  Eigen::Matrix<double, 4, 6> by_state;  // over [theta, phi, qd]
  Eigen::Vector2d by_previous;           // diagonal: cart rows by the cart's velocity a step before
  double ground = 0.0;  // N s/m, on the cart's velocity after a step, where feet stand
};

// The pendulum that a person is at rest.
template <typename T>
BodyOf<T> BodyAtRest(const ModelOptions& options, const Body& body, const ParameterSet<T>& p) {
  return DynamicBody(options, body, p, options.stance == Stance::kFixed);
}

// What a model at rest is linearized by: the state with all that is perceived of it at once, as
// without a delay, or one of these alone.
enum class RestInput { kAll, kState, kAnkle, kStep };

RestJacobian LinearizeAtRest(const ModelOptions& options, const SelfForce& self,
                             const ParameterSet<double>& p, RestInput by = RestInput::kAll);

// The initial velocities that the scene itself holds.
inline std::vector<Vector4<double>> InitialVelocities(const Scene& scene) {
  std::vector<Vector4<double>> velocities;
  for (const ScenePerson& person : scene.people) velocities.push_back(person.start.qd);
  return velocities;
}

}  // namespace pushid
