// residuals: the action of a path under process noise, whose minimum is the most probable path.
//
// Of dS = f(S) dt + g dW the probability of a smooth path is exp(-A) (Onsager and Machlup 1953;
// Eq. 3 and 4 of Lyu et al., ACM MM 2021):
//   A = sum over steps of dt |g^-1 ((S' - S) / dt - f(mid))|^2 / 2 + dt div f(mid) / 2
// Rows of a step: sqrt(dt) g^-1 (...), and sqrt(2 (dt div f / 2 + c)): exact while positive.
//
// People: q at every frame is a node, and f is a force. At a frame the force that the motion needs
// beside the model's own, with the velocity of the interval around it, is the noise that drove it:
//   v = M (q+ - 2 q + q-) / dt^2 + C + G - F_net(q, (q+ - q-) / 2 dt),  rows sqrt(dt) L^-1 v
// and the divergence is that of the acceleration by the velocity, for the places' own is zero.
#pragma once

#include <ceres/jet.h>

#include <cmath>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/dual.h"
#include "models/pendulum_filter.h"

namespace pushid {

// Keeps what is under the divergence's root positive: a system whose phase volume shrinks faster
// than by this many units a step has too long steps.
inline constexpr double kDivergenceShift = 10.0;

template <typename T>
bool DivergenceRow(const T& divergence, double dt, T* row) {
  using std::sqrt;
  const T half = 0.5 * dt * divergence + kDivergenceShift;
  if (!(RealPart(half) > 0.0)) return false;
  *row = sqrt(2.0 * half);
  return true;
}

// Everybody at one frame of a scene; parameters: one entry per person.
struct SceneAction {
  const Scene* scene = nullptr;
  const ModelOptions* options = nullptr;
  const std::vector<ParameterSet<double>>* parameters = nullptr;
  int frame = 0;

  static constexpr int kRows = 5;  // of a person

  // nodes: q of everybody at the frame before, at this one and at the next; each 4 x people long.
  template <typename T>
  bool operator()(T const* const* nodes, T* rows) const;
};

// Places and velocities of one frame, by the rule of the header.
template <typename T>
std::vector<PendulumState<T>> StatesAtNode(T const* const* nodes, int people, double dt) {
  std::vector<PendulumState<T>> states(people);
  for (int n = 0; n < people; ++n) {
    for (int i = 0; i < 4; ++i) {
      states[n].q[i] = nodes[1][4 * n + i];
      states[n].qd[i] = (nodes[2][4 * n + i] - nodes[0][4 * n + i]) / (2.0 * dt);
    }
  }
  return states;
}

template <typename T>
bool SceneAction::operator()(T const* const* nodes, T* rows) const {
  using D = Dual<T, 4>;  // by the velocity of one person
  const double dt = scene->dt;
  const int people = scene->num_people();
  const std::vector<PendulumState<T>> states = StatesAtNode(nodes, people, dt);
  std::vector<PendulumState<D>> duals(people);
  std::vector<ParameterSet<D>> constants(people);
  for (int n = 0; n < people; ++n) {
    if (!OutsideDomain(scene->people[n].body, states[n]).empty()) return false;
    for (int i = 0; i < 4; ++i) {
      duals[n].q[i] = D::Constant(states[n].q[i]);
      duals[n].qd[i] = D::Constant(states[n].qd[i]);
    }
    for (int i = 0; i < kNumParameters; ++i) constants[n][i] = D((*parameters)[n][i]);
  }
  ModelStep<D> forces(*scene, *options, constants);
  std::vector<int> scratch;
  for (int n = 0; n < people; ++n, rows += kRows) {
    for (int i = 0; i < 4; ++i) duals[n].qd[i].v[i] = T(1.0);
    forces.Update(duals.data());
    forces.Prepare(n, &scratch);
    const NetForce<D> force = forces.On(n, frame, duals[n].qd);
    const Vector4<D> acceleration = forces.AccelerationOf(n, force);
    for (int i = 0; i < 4; ++i) duals[n].qd[i].v[i] = T(0.0);
    Vector4<T> apart;
    T divergence(0.0);
    for (int i = 0; i < 4; ++i) {
      const T second =
          (nodes[2][4 * n + i] - 2.0 * nodes[1][4 * n + i] + nodes[0][4 * n + i]) / (dt * dt);
      apart[i] = second - acceleration[i].a;
      divergence += acceleration[i].v[i];
    }
    const Body& body = scene->people[n].body;
    ParameterSet<T> p;
    for (int i = 0; i < kNumParameters; ++i) p[i] = T((*parameters)[n][i]);
    const Matrix4<T> factor = NoiseFactor<T>(body, p);
    const Vector4<T> needed = MassMatrix<T>(body, states[n].q) * apart;
    Eigen::Map<Vector4<T>> white(rows);
    white = std::sqrt(dt) * SolveLower<T, 4, 1>(factor, needed);
    if (!DivergenceRow(divergence, dt, rows + 4)) return false;
  }
  return true;
}

}  // namespace pushid
