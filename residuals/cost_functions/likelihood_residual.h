// residuals: a recording by its likelihood under process noise: one Ceres residual block per
// recording, a Gaussian density per frame and person.
//
//   transition   of the measured velocity, one step on from the measured state:
//                v = M (qd' - qd) / dt - (F_net - C - G) ~ N(0, L L' / dt)
//                (Eq. 5 and 6 of Lyu et al., ACM MM 2021, as what they mean). Errors of the
//                measured velocities count as process noise.
//   innovation   of every measurement given all before it (models/pendulum_filter.h)
//
// Steps under a net push are no evidence: its rows were made from this very motion, by inverse
// dynamics. A filter goes through them, and their densities count as not measured.
//
//   residuals: kGaussianRows for frames 1 .. T - 1; ordered by frame, then person
//   blocks:    BlockLayout without initial velocities: a filter knows how little it knows of them
// Jacobian of transitions by jets over the acting columns; of innovations by differences of whole
// filters, good to 3e-4, which cost 12 filters for twelve parameters. Rejected: jets over jets,
// exact, for a filter's covariance needs the derivatives of the step's own derivatives; they
// cost 55.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/jet.h>

#include <cmath>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/jet.h"
#include "models/options.h"
#include "models/pendulum_filter.h"
#include "residuals/frame_residual.h"
#include "residuals/parameter_map.h"
#include "residuals/rollout_residual.h"

namespace pushid {

// The negative log likelihood of a Gaussian as squares, exactly.
//   -log N(v; 0, L L') = |L^-1 v|^2 / 2 + sum_i log L_ii + const
//   rows: L^-1 v, and sqrt(2 (log L_ii + c_i)), half of whose squares is log L_ii + c_i.
// Any shift c gives the same optimum. With c_i = 1/2 - log L_ii at the point where a problem is
// built, J'J there is the Fisher information, in expectation, so that Gauss-Newton is Fisher
// scoring and a covariance from J'J is right; but log L_ii may fall by 1/2 only before the rows
// end. Far from the optimum a larger shift lets it fall further, at a curvature that is too low; a
// solve goes on from a problem built anew. Eq. 5 of Lyu et al., ACM MM 2021, is this density.

inline constexpr double kFisherShift = 0.5;

// shift: c_i. rows: 2 N of them. False where log L_ii + c_i is no longer positive.
template <typename T, int N>
bool GaussianRows(const Eigen::Matrix<T, N, 1>& v, const Eigen::Matrix<T, N, N>& lower,
                  const double* shift, T* rows) {
  using std::log, std::sqrt;
  Eigen::Map<Eigen::Matrix<T, N, 1>> white(rows);
  white = SolveLower<T, N, 1>(lower, v);
  for (int i = 0; i < N; ++i) {
    const T log_scale = log(lower(i, i)) + shift[i];
    if (!(RealPart(log_scale) > 0.0)) return false;
    rows[N + i] = sqrt(2.0 * log_scale);
  }
  return true;
}

// Half the squared rows less this is -log N(v; 0, L L') of one v.
template <int N>
double GaussianOffset(const double* shift) {
  constexpr double kLogTwoPi = 1.8378770664093453;
  double offset = -0.5 * N * kLogTwoPi;
  for (int i = 0; i < N; ++i) offset += shift[i];
  return offset;
}

// Rows of one person in one frame.
inline constexpr int kGaussianRows = 8;

// A recording, its model and the blocks it hangs on.
struct LikelihoodProblem {
  Likelihood likelihood = Likelihood::kInnovation;
  const PendulumRecording* recording = nullptr;  // must outlive the residual
  ModelOptions options;
  ParameterMap map;
  BlockLayout layout;
  double weight = 1.0;  // on every row: the square root of how often the recording counts

  int num_densities() const { return (recording->num_frames() - 1) * recording->num_people(); }
};

LikelihoodProblem MakeLikelihoodProblem(Likelihood likelihood, const PendulumRecording& recording,
                                        const ModelOptions& options, const ParameterMap& map,
                                        double weight);

// v ~ N(0, lower lower'); where nothing was measured, v = 0 and lower = 1.
template <typename T>
struct GaussianDensity {
  Vector4<T> v = Vector4<T>::Zero();
  Matrix4<T> lower = Matrix4<T>::Identity();
  bool measured = false;
};

// By frame from frame 1 on, then person; parameters: one entry per person. A filter that leaves the
// model's domain is a failure.
RolloutStatus Densities(const LikelihoodProblem& problem,
                        const std::vector<ParameterSet<double>>& parameters,
                        std::vector<GaussianDensity<double>>* densities);

// -2 log likelihood, and of how many numbers. Infinite where the filter leaves the domain.
struct Deviance {
  double value = 0.0;
  int measured = 0;
};
Deviance DevianceOf(const LikelihoodProblem& problem,
                    const std::vector<ParameterSet<double>>& parameters);

class LikelihoodResidual : public ceres::CostFunction {
 public:
  // blocks: where the problem is built (GaussianRows). status(): whether it can be, there. fall: by
  // how much log L may fall from there.
  LikelihoodResidual(LikelihoodProblem problem, double const* const* blocks,
                     double fall = kFisherShift);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

  const RolloutStatus& status() const { return status_; }
  // Half the squared rows of weight 1 less this is the negative log likelihood.
  double offset() const { return offset_; }
  int PersonOfRow(Eigen::Index row) const {
    return static_cast<int>(row / kGaussianRows % problem_.layout.num_people());
  }

 private:
  template <typename T>
  bool RowsOf(const std::vector<GaussianDensity<T>>& densities, std::vector<T>* rows) const;
  bool Rows(const std::vector<ParameterSet<double>>& parameters, std::vector<double>* rows) const;

  // By acting column; false where the likelihood is not defined.
  bool ByJets(const SensitivityInputs& in, RowMajorMatrix* by_acting) const;
  bool ByDifferences(const SensitivityInputs& in, const std::vector<double>& rows,
                     RowMajorMatrix* by_acting) const;

  LikelihoodProblem problem_;
  RolloutStatus status_;
  std::vector<double> shift_;  // four per density
  double offset_ = 0.0;
};

// The action of a path under process noise, whose minimum is the most probable path.
//
// A smooth path of dS = f(S) dt + g dW has the probability exp(-A) (Onsager and Machlup 1953;
// Eq. 3 and 4 of Lyu et al., ACM MM 2021):
//   A = sum over steps of dt |g^-1 ((S' - S) / dt - f(mid))|^2 / 2 + dt div f(mid) / 2
// Rows of a step: sqrt(dt) g^-1 (...), and sqrt(2 (dt div f / 2 + c)): exact while positive.
//
// People: q at every frame is a node, and f is a force. At a frame the force that the motion needs
// beside the model's own, with the velocity of the interval around it, is the noise that drove it:
//   v = M (q+ - 2 q + q-) / dt^2 + C + G - F_net(q, (q+ - q-) / 2 dt),  rows sqrt(dt) L^-1 v
// and the divergence is that of the acceleration by the velocity, for the places' own is zero.

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
  using D = JetOf<T, 4>;  // by the velocity of one person
  const double dt = scene->dt;
  const int people = scene->num_people();
  const std::vector<PendulumState<T>> states = StatesAtNode(nodes, people, dt);
  std::vector<PendulumState<D>> jets(people);
  std::vector<ParameterSet<D>> constants(people);
  for (int n = 0; n < people; ++n) {
    if (!OutsideDomain(scene->people[n].body, states[n]).empty()) return false;
    for (int i = 0; i < 4; ++i) {
      jets[n].q[i] = D::Constant(states[n].q[i]);
      jets[n].qd[i] = D::Constant(states[n].qd[i]);
    }
    for (int i = 0; i < kNumParameters; ++i) constants[n][i] = D((*parameters)[n][i]);
  }
  ModelStep<D> forces(*scene, *options, constants);
  std::vector<int> scratch;
  for (int n = 0; n < people; ++n, rows += kRows) {
    for (int i = 0; i < 4; ++i) jets[n].qd[i] = D::Input(states[n].qd[i], i);
    forces.Update(jets.data());
    forces.Prepare(n, &scratch);
    const NetForce<D> force = forces.On(n, frame, jets[n].qd);
    const Vector4<D> acceleration = forces.AccelerationOf(n, force);
    for (int i = 0; i < 4; ++i) jets[n].qd[i] = D::Constant(states[n].qd[i]);
    Vector4<T> apart;
    T divergence(0.0);
    for (int i = 0; i < 4; ++i) {
      const T second =
          (nodes[2][4 * n + i] - 2.0 * nodes[1][4 * n + i] + nodes[0][4 * n + i]) / (dt * dt);
      apart[i] = second - acceleration[i].a;
      divergence += acceleration[i].Slope(i);
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
