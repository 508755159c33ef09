// models: two planes a person, and the step of the rollout.
#include "models/input_filter.h"

#include <Eigen/LU>
#include <cmath>

#include "models/ipm.h"
#include "models/rollout.h"

namespace pushid {
namespace {

constexpr double kStartPlace = 1e-3, kStartSpeed = 0.02;  // m and m/s; rad and rad/s
constexpr double kRounding = 5e-4;  // m and rad, of measurements: white, and keeps S regular

// The plane's rows of friction, balance and the linear self force (self_terms.h).
InputPlane::Gains PlaneGains(const ModelOptions& options, const ParameterSet<double>& p,
                             const Body& body, int plane) {
  const GainScale scale(options.gain_scaling, body);
  const CartDamping damping = CartDampings(options.friction)[plane];
  InputPlane::Gains gains;
  gains.damping = damping.Of(p) * scale.force;
  gains.stiffness = p[plane == 0 ? kKpTheta : kKpPhi] * scale.stiffness;
  gains.rate = p[plane == 0 ? kKdTheta : kKdPhi] * scale.damping;
  gains.cross = p[plane == 0 ? kAx : kAy] * body.mass;
  return gains;
}

}  // namespace

InputPlane::InputPlane(const Body& body, const Gains& gains, const InputNoise& noise, double dt)
    : input_decay_(std::exp(-dt / noise.force_time)),
      error_decay_(std::exp(-dt / noise.measured_time)) {
  const double m = body.point_mass(), l = body.pendulum_length();
  Eigen::Matrix2d mass, by_place, by_rate;
  mass << body.mass, m * l, m * l, m * l * l;
  by_place << 0.0, gains.cross, 0.0, m * kGravity * l - gains.stiffness;
  by_rate << -gains.damping, 0.0, 0.0, -gains.rate;
  const Eigen::Matrix2d inverse = mass.inverse();
  Eigen::Matrix<double, 2, 6> acceleration;
  acceleration << inverse * by_place, inverse * by_rate, inverse;
  step_.setIdentity();
  step_.block<2, 6>(2, 0) += dt * acceleration;
  step_.block<2, 6>(0, 0) += dt * step_.block<2, 6>(2, 0);
  step_.block<2, 2>(4, 4) *= input_decay_;
  step_.block<2, 2>(6, 6) *= error_decay_;
  const Eigen::Vector2d force = noise.force * body.mass * Eigen::Vector2d(1.0, l);
  const Eigen::Vector2d error = noise.measured * Eigen::Vector2d(1.0, 1.4 / l);
  spread_.segment<2>(4) = (1.0 - input_decay_ * input_decay_) * force.cwiseAbs2();
  spread_.segment<2>(6) = (1.0 - error_decay_ * error_decay_) * error.cwiseAbs2();
  Correction start;
  start << Eigen::Vector2d::Constant(kStartPlace), Eigen::Vector2d::Constant(kStartSpeed),
      Eigen::Vector2d::Zero(), error;
  covariance_.diagonal() = start.cwiseAbs2();
}

void InputPlane::Predict() {
  const Matrix moved = step_.lazyProduct(covariance_);
  const Matrix spread = moved.lazyProduct(step_.transpose());
  // Rounding must not make it lopsided: that grows.
  covariance_ = 0.5 * (spread + spread.transpose());
  covariance_.diagonal() += spread_;
  input_ *= input_decay_;
  error_ *= error_decay_;
}

InputPlane::Correction InputPlane::Update(const Eigen::Vector2d& innovation) {
  // A measurement is place and error.
  const Eigen::Matrix<double, 8, 2> with_measured =
      covariance_.leftCols<2>() + covariance_.rightCols<2>();
  Eigen::Matrix2d expected = with_measured.topRows<2>() + with_measured.bottomRows<2>();
  expected.diagonal().array() += kRounding * kRounding;
  const Eigen::Matrix2d information = expected.inverse();
  const Eigen::Matrix<double, 8, 2> gain = with_measured.lazyProduct(information);
  covariance_ -= gain.lazyProduct(with_measured.transpose());
  const Correction moved = gain.lazyProduct(innovation);
  input_ += moved.segment<2>(4);
  error_ += moved.segment<2>(6);
  return moved;
}

InputFilter::InputFilter(const Scene& scene, const ModelOptions& options,
                         std::vector<ParameterSet<double>> parameters, const InputNoise& noise,
                         int num_frames)
    : scene_(scene),
      known_pushes_(scene.pushes.size()),
      options_(options),
      parameters_(std::move(parameters)),
      path_(num_frames, scene.num_people()) {
  for (int n = 0; n < scene.num_people(); ++n) {
    path_.At(0, n) = scene.people[n].start;
    scene_.pushes.push_back(
        {n, 0, PushKind::kExternal,
         std::vector<Vector4<double>>(num_frames, Vector4<double>(Vector4<double>::Zero()))});
    const Body& body = scene.people[n].body;
    const auto plane = [&](int i) {
      return InputPlane(body, PlaneGains(options, parameters_[n], body, i), noise, scene.dt);
    };
    planes_.push_back({plane(0), plane(1)});
  }
}

Eigen::Vector2d InputFilter::InPlane(int plane, const Vector4<double>& q) {
  return plane == 0 ? Eigen::Vector2d(q[0], q[2]) : Eigen::Vector2d(q[1], -q[3]);
}

Vector4<double> InputFilter::FromPlanes(const Eigen::Vector2d& first,
                                        const Eigen::Vector2d& second) {
  return {first[0], second[0], first[1], -second[1]};
}

Vector4<double> InputFilter::Input(int person) const {
  return FromPlanes(planes_[person][0].input(), planes_[person][1].input());
}

RolloutStatus InputFilter::Observe(const std::vector<PendulumState<double>>& measured,
                                   const std::vector<bool>& seen) {
  if (!status_.ok || observed_ >= path_.num_frames()) return status_;
  const int people = scene_.num_people(), t = observed_ - 1;
  for (int n = 0; n < people; ++n) scene_.pushes[known_pushes_ + n].force[t] = Input(n);
  ModelStep<double> forces(scene_, options_, parameters_);
  status_ = StepOn<double>(scene_, &forces, t, &path_);
  if (!status_.ok) return status_;
  ++observed_;
  for (int n = 0; n < people; ++n) {
    PendulumState<double>& state = path_.At(t + 1, n);
    std::array<InputPlane::Correction, 2> moved;
    for (int i : {0, 1}) {
      InputPlane& plane = planes_[n][i];
      plane.Predict();
      moved[i] = seen[n] ? plane.Update(InPlane(i, measured[n].q - state.q) - plane.error())
                         : InputPlane::Correction::Zero();
    }
    state.q += FromPlanes(moved[0].head<2>(), moved[1].head<2>());
    state.qd += FromPlanes(moved[0].segment<2>(2), moved[1].segment<2>(2));
  }
  return status_;
}

RolloutStatus InputFilter::Forecast(RolloutPath<double>* path) const {
  *path = path_;
  if (!status_.ok) return status_;
  Scene scene = scene_;
  for (int n = 0; n < scene.num_people(); ++n) {
    Vector4<double> left = Input(n);
    ScenePush& push = scene.pushes[known_pushes_ + n];
    for (int t = observed_ - 1; t < path->num_frames(); ++t) {
      push.force[t] = left;
      left *= planes_[n][0].input_decay();
    }
  }
  ModelStep<double> forces(scene, options_, parameters_);
  return RollOn<double>(scene, &forces, observed_ - 1, path);
}

}  // namespace pushid
