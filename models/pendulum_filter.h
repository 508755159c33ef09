// models: the extended Kalman filter of a scene: what is known of everybody's state after each
// measurement of q, where forces are disturbed and measurements err (process_noise.h).
//   predict: s <- step(s),  P <- A P A' + Q,  A = d step / ds,  Q = dt B M^-1 L L' M^-1 B'
//   update:  S = P_qq + R,  P <- P - P_q S^-1 P_q',  s <- s + P_q S^-1 (z - q)
// B = [dt; 1] as the step has it; A by jets through the very forces of the rollout.
// Sources: Jazwinski, Stochastic Processes and Filtering Theory, 1970 (8.8); as used by CTSM-R and
// ctsmTMB.
//
// Each of several people has a covariance of their own: what people do to each other is taken at
// the filtered states, whose errors (millimetres) are small against the distances at which contact
// changes. Rejected: one covariance of all 8 N states, 25 times the work of five people.
#pragma once

#include <memory>
#include <vector>

#include "models/jet.h"
#include "models/process_noise.h"
#include "models/rollout.h"

namespace pushid {

// Velocities at frame 0 are known so well; m/s and rad/s.
inline constexpr double kStartRate = 0.05;

// L of covariance = L L'.
template <typename T, int N>
Eigen::Matrix<T, N, N> CholeskyFactor(const Eigen::Matrix<T, N, N>& covariance) {
  using std::sqrt;
  Eigen::Matrix<T, N, N> lower = Eigen::Matrix<T, N, N>::Zero();
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j <= i; ++j) {
      T sum = covariance(i, j);
      for (int k = 0; k < j; ++k) sum -= lower(i, k) * lower(j, k);
      lower(i, j) = i == j ? sqrt(sum) : T(sum / lower(j, j));
    }
  }
  return lower;
}

// L^-1 columns, by substitution.
template <typename T, int N, int kColumns>
Eigen::Matrix<T, N, kColumns> SolveLower(const Eigen::Matrix<T, N, N>& lower,
                                         Eigen::Matrix<T, N, kColumns> columns) {
  for (int i = 0; i < N; ++i) {
    for (int k = 0; k < i; ++k) columns.row(i) -= lower(i, k) * columns.row(k);
    columns.row(i) /= lower(i, i);
  }
  return columns;
}

// A step of everybody from known states, and its derivatives by each person's own state.
class StateStep {
 public:
  virtual ~StateStep();
  // states: of everybody at the frame that the next steps start from.
  virtual void Begin(const std::vector<PendulumState<double>>& states) = 0;
  // A person's velocity one step on, 4 numbers, and by [q, qd], 4 x 8 by rows.
  virtual void Velocity(int frame, int person, double* next, double* by_state) = 0;
};

// A step whose scalar D holds a value and eight derivatives.
template <typename D>
class StepByJet final : public StateStep {
 public:
  // All arguments must outlive the object.
  StepByJet(const Scene& scene, const ModelOptions& options,
            const std::vector<ParameterSet<double>>& parameters)
      : scene_(scene), parameters_(Constants(parameters)), forces_(scene, options, parameters_) {}
  StepByJet(const StepByJet&) = delete;
  StepByJet& operator=(const StepByJet&) = delete;

  void Begin(const std::vector<PendulumState<double>>& states) override {
    states_.resize(states.size());
    for (size_t n = 0; n < states.size(); ++n) {
      for (int i = 0; i < 4; ++i) {
        states_[n].q[i] = D::Constant(states[n].q[i]);
        states_[n].qd[i] = D::Constant(states[n].qd[i]);
      }
    }
  }

  void Velocity(int frame, int person, double* next, double* by_state) override {
    const PendulumState<D> kept = states_[person];
    for (int i = 0; i < 4; ++i) {
      states_[person].q[i] = D::Input(kept.q[i].a, i);
      states_[person].qd[i] = D::Input(kept.qd[i].a, 4 + i);
    }
    forces_.Update(states_.data());
    forces_.Prepare(person, &scratch_);
    const NetForce<D> force = forces_.On(person, frame, states_[person].qd);
    const Vector4<D> qd = states_[person].qd + D(scene_.dt) * forces_.AccelerationOf(person, force);
    states_[person] = kept;
    for (int i = 0; i < 4; ++i) {
      next[i] = qd[i].a;
      for (int k = 0; k < 8; ++k) by_state[8 * i + k] = qd[i].Slope(k);
    }
  }

 private:
  static std::vector<ParameterSet<D>> Constants(
      const std::vector<ParameterSet<double>>& parameters) {
    std::vector<ParameterSet<D>> constants(parameters.size());
    for (size_t n = 0; n < parameters.size(); ++n) {
      for (int i = 0; i < kNumParameters; ++i) constants[n][i] = D::Constant(parameters[n][i]);
    }
    return constants;
  }

  const Scene& scene_;
  std::vector<ParameterSet<D>> parameters_;
  ModelStep<D> forces_;
  std::vector<PendulumState<D>> states_;
  std::vector<int> scratch_;
};

class PendulumFilter {
 public:
  using Covariance = Eigen::Matrix<double, 8, 8>;
  // A measurement less its expectation: v ~ N(0, lower lower').
  struct Innovation {
    Vector4<double> v;
    Matrix4<double> lower;
  };

  // parameters: one entry per person. Starts at the scene's own start, whose place is a measurement
  // as well. step: of the same; null for one by narrow jets. Scene and options must outlive the
  // filter.
  PendulumFilter(const Scene& scene, const ModelOptions& options,
                 const std::vector<ParameterSet<double>>& parameters,
                 std::unique_ptr<StateStep> step = nullptr);

  // Goes on from `frame` to the next.
  RolloutStatus Predict(int frame);

  // weight: of the measurement, in (0, 1]; its errors are as much larger as that is less.
  Innovation Update(int person, const Vector4<double>& q, double weight);

  const PendulumState<double>& state(int person) const { return states_[person]; }
  const Covariance& covariance(int person) const { return covariances_[person]; }

 private:
  using ByState = Eigen::Matrix<double, 4, 8, Eigen::RowMajor>;
  // P one step on. With V = d qd' / ds and q' = q + dt qd', the new blocks follow from V P and Q.
  void Spread(int n, const ByState& by_state);

  const Scene& scene_;
  std::vector<ParameterSet<double>> parameters_;
  std::unique_ptr<StateStep> step_;
  std::vector<PendulumState<double>> states_;
  std::vector<Covariance> covariances_;
};

}  // namespace pushid
