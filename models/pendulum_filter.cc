// models: the filter of a scene.
#include "models/pendulum_filter.h"

#include <utility>

namespace pushid {

StateStep::~StateStep() = default;

PendulumFilter::PendulumFilter(const Scene& scene, const ModelOptions& options,
                               const std::vector<ParameterSet<double>>& parameters,
                               std::unique_ptr<StateStep> step)
    : scene_(scene), parameters_(parameters), step_(std::move(step)) {
  if (step_ == nullptr) {
    step_ = std::make_unique<StepByJet<VectorJet>>(scene_, options, parameters_);
  }
  for (int n = 0; n < scene.num_people(); ++n) {
    PendulumState<double>& state = states_.emplace_back();
    state.q = scene.people[n].start.q;
    state.qd = scene.people[n].start.qd;
    Covariance start = Covariance::Zero();
    start.topLeftCorner<4, 4>() =
        MeasurementCovariance<double>(scene.people[n].body, parameters[n]);
    for (int i = 4; i < 8; ++i) start(i, i) = kStartRate * kStartRate;
    covariances_.push_back(start);
  }
}

RolloutStatus PendulumFilter::Predict(int frame) {
  std::vector<Vector4<double>> velocities(states_.size());
  ByState by_state;
  step_->Begin(states_);
  for (int n = 0; n < scene_.num_people(); ++n) {
    step_->Velocity(frame, n, velocities[n].data(), by_state.data());
    Spread(n, by_state);
  }
  for (int n = 0; n < scene_.num_people(); ++n) {
    states_[n].qd = velocities[n];
    states_[n].q += scene_.dt * velocities[n];
    const std::string_view outside = OutsideDomain(scene_.people[n].body, states_[n]);
    if (!outside.empty()) return {false, frame + 1, n, outside};
  }
  return {};
}

PendulumFilter::Innovation PendulumFilter::Update(int person, const Vector4<double>& q,
                                                  double weight) {
  Covariance& P = covariances_[person];
  PendulumState<double>& state = states_[person];
  const Matrix4<double> expected =
      P.topLeftCorner<4, 4>() +
      MeasurementCovariance<double>(scene_.people[person].body, parameters_[person]) /
          (weight * weight);
  const Innovation innovation{q - state.q, CholeskyFactor<double, 4>(expected)};
  const Eigen::Matrix<double, 4, 8> rows =
      SolveLower<double, 4, 8>(innovation.lower, P.topRows<4>());
  const Vector4<double> white = SolveLower<double, 4, 1>(innovation.lower, innovation.v);
  const Eigen::Matrix<double, 8, 1> moved = rows.transpose() * white;
  state.q += moved.head<4>();
  state.qd += moved.tail<4>();
  P -= rows.transpose().lazyProduct(rows);  // of such sizes Eigen would call its large kernel
  return innovation;
}

void PendulumFilter::Spread(int n, const ByState& by_state) {
  const Body& body = scene_.people[n].body;
  const PendulumState<double>& state = states_[n];
  const double dt = scene_.dt;
  const Matrix4<double> gain = InverseMassMatrix<double>(body, Angles<double>(state.q), body.mass) *
                               NoiseFactor<double>(body, parameters_[n]);
  Covariance& P = covariances_[n];
  const Eigen::Matrix<double, 4, 8> moved = by_state.lazyProduct(P);
  const Matrix4<double> rates =
      moved.lazyProduct(by_state.transpose()) + dt * (gain * gain.transpose());
  const Matrix4<double> places_rates = moved.leftCols<4>().transpose();  // cov(q, qd')
  const Matrix4<double> mixed = places_rates + dt * rates;
  const Matrix4<double> places =
      P.topLeftCorner<4, 4>() + dt * (places_rates + places_rates.transpose()) + (dt * dt) * rates;
  P.topLeftCorner<4, 4>() = places;
  P.topRightCorner<4, 4>() = mixed;
  P.bottomLeftCorner<4, 4>() = mixed.transpose();
  P.bottomRightCorner<4, 4>() = rates;
}

}  // namespace pushid
