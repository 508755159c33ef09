// models: two planes a person, and the step of the rollout.
#include "models/input_filter.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "models/ipm.h"
#include "models/rollout.h"

namespace pushid {
namespace {

constexpr double kStartPlace = 1e-3, kStartSpeed = 0.02;  // m and m/s; rad and rad/s
constexpr double kRounding = 5e-4;  // m and rad, of measurements: white, and keeps S regular

constexpr int kWindow = 64;  // frames that a filter keeps at most, beside those it needs

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

InputFilter::InputFilter(Scene scene, const ModelOptions& options,
                         std::vector<ParameterSet<double>> parameters,
                         const std::optional<InputNoise>& noise)
    : model_(std::make_unique<Model>(std::move(scene), options, std::move(parameters))),
      known_pushes_(model_->scene.pushes.size()) {
  const Scene& of = model_->scene;
  double back = 0.0;  // s
  for (const ParameterSet<double>& p : model_->parameters) {
    if (options.delay != Delay::kNone) back = std::max({back, p[kReactionDelay], p[kStepDelay]});
  }
  kept_ = static_cast<int>(std::ceil(back / of.dt)) + DelayedFrames<double>::kCount + 1;
  path_.Reset(kept_ + kWindow, of.num_people());
  StartPath(of, InitialVelocities(of), &path_);
  if (!noise) return;
  for (int n = 0; n < of.num_people(); ++n) {
    const auto plane = [&](int i) {
      const Body& body = of.people[n].body;
      return InputPlane(body, PlaneGains(options, model_->parameters[n], body, i), *noise, of.dt);
    };
    planes_.push_back({plane(0), plane(1)});
  }
  model_->scene.pushes.resize(known_pushes_ + planes_.size());
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

void InputFilter::SetInputs(int rows) const {
  for (size_t n = 0; n < planes_.size(); ++n) {
    ScenePush& push = model_->scene.pushes[known_pushes_ + n];
    push.person = static_cast<int>(n);
    push.start_frame = now_;
    push.force.assign(rows, Input(push.person));
    for (int i = 1; i < rows; ++i) {
      push.force[i] = planes_[n][0].input_decay() * push.force[i - 1];
    }
  }
}

void InputFilter::Push(int person, const Vector4<double>& force) {
  model_->scene.pushes.push_back({person, now_, PushKind::kExternal, {force}});
}

// Makes room in the window.
void InputFilter::Forget() {
  Scene& scene = model_->scene;
  const int by = now_ + 1 - kept_;
  for (int t = 0; t < kept_; ++t) {
    for (int n = 0; n < scene.num_people(); ++n) path_.At(t, n) = path_.At(t + by, n);
  }
  for (ScenePush& push : scene.pushes) push.start_frame -= by;
  const auto over = [](const ScenePush& push) { return push.EndFrame() < 0; };
  const auto given = scene.pushes.begin() + known_pushes_ + planes_.size();
  scene.pushes.erase(std::remove_if(given, scene.pushes.end(), over), scene.pushes.end());
  std::vector<GroundStep>& ground = scene.ground.steps;
  ground.erase(ground.begin(), ground.begin() + std::min<size_t>(by, ground.size()));
  first_ += by;
  now_ -= by;
}

RolloutStatus InputFilter::Observe(const std::vector<PendulumState<double>>& measured,
                                   const std::vector<bool>& seen) {
  if (!status_.ok) return status_;
  if (now_ + 1 == path_.num_frames()) Forget();
  SetInputs(1);
  status_ = StepOn<double>(model_->scene, &model_->step, now_, &path_);
  if (!status_.ok) status_.frame += first_;
  if (!status_.ok) return status_;
  ++now_;
  for (size_t n = 0; n < planes_.size(); ++n) {
    PendulumState<double>& state = path_.At(now_, static_cast<int>(n));
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

RolloutStatus InputFilter::Forecast(int ahead, RolloutPath<double>* path) const {
  const int people = path_.num_people();
  path->Reset(ahead + 1, people);
  if (!status_.ok) return status_;
  RolloutPath<double> window(now_ + 1 + ahead, people);
  for (int t = 0; t <= now_; ++t) std::copy_n(path_.Frame(t), people, &window.At(t, 0));
  SetInputs(ahead + 1);
  ModelStep<double> step = model_->step;
  RolloutStatus status = RollOn<double>(model_->scene, &step, now_, &window);
  for (int t = 0; t <= ahead; ++t) std::copy_n(window.Frame(now_ + t), people, &path->At(t, 0));
  if (!status.ok) status.frame += first_;
  return status;
}

}  // namespace pushid
