// ident: the linearized loop of a person at rest.
#include "ident/problem/linear_loop.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "models/decompositions.h"
#include "models/rollout.h"

namespace pushid {
namespace {

constexpr int kNodes = 24;  // of the past: growth to 1e-6 up to 30 1/s with a delay of 0.3 s
// Frequencies among which margins are looked for: beyond them, neither the ankles nor the senses
// of their angle respond.
constexpr double kLowestHz = 1e-3, kHighestHz = 100.0;
constexpr int kSteps = 4000;

// One plane's part of the derivatives: rows of cart and angle, columns e, v, w.
Eigen::Matrix<double, 2, 3> InPlane(const RestJacobian& rest, int plane) {
  return rest.by_state(Eigen::seqN(plane, 2, 2), Eigen::seqN(plane, 3, 2));
}

// The differentiation matrix of Chebyshev's points of [-1, 0], 0 first: derivatives of the
// polynomial through the values there.
Eigen::MatrixXd Differentiation(const Eigen::VectorXd& x) {
  const Eigen::Index n = x.size();
  const auto c = [n](Eigen::Index i) {
    return (i == 0 || i == n - 1 ? 2.0 : 1.0) * (i % 2 == 0 ? 1.0 : -1.0);
  };
  Eigen::MatrixXd by(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    double sum = 0.0;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i == j) continue;
      by(i, j) = c(i) / (c(j) * (x[i] - x[j]));
      sum += by(i, j);
    }
    by(i, i) = -sum;
  }
  return by;
}

// Weights of the values at the points for the value at `at` (barycentric).
Eigen::RowVectorXd Interpolation(const Eigen::VectorXd& x, double at) {
  const Eigen::Index n = x.size();
  Eigen::RowVectorXd weight(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (std::abs(at - x[i]) < 1e-14) return Eigen::RowVectorXd::Unit(n, i);
    const double end = i == 0 || i == n - 1 ? 0.5 : 1.0;
    weight[i] = (i % 2 == 0 ? end : -end) / (at - x[i]);
  }
  return weight / weight.sum();
}

}  // namespace

std::string WithoutLinearLoop(const ModelOptions& options) {
  if (options.learned != nullptr) return "what is learned has no closed form at rest";
  if (options.delay != Delay::kNone && options.cart_derivative != CartDerivative::kNone) {
    return "a late derivative of the cart's velocity has no limit of short steps";
  }
  return "";
}

LinearLoop::LinearLoop(const ModelOptions& options, const Body& person,
                       const ParameterSet<double>& p, int plane)
    : plane_(plane) {
  ModelOptions upright = options;
  upright.posture = Posture::kUpright;
  // Quadratic damping vanishes at rest: the floor under its norm, there for the rollout's
  // derivatives, is nothing to rely on.
  ParameterSet<double> linear = p;
  linear[kCq] = linear[kDq] = 0.0;
  constexpr double kStep = 1.0;  // s; any: what follows does not depend on it
  const SelfForce self(upright, person, Vector4<double>::Zero(), kStep);
  const RestJacobian rest = LinearizeAtRest(upright, self, linear);
  const bool late = options.delay != Delay::kNone;
  // Derivatives of the whole person at once, to be taken apart below.
  const auto by = [&](RestInput input) {
    return InPlane(LinearizeAtRest(options, self, linear, input), plane);
  };
  now_ = by(RestInput::kState);
  const Row ankle = by(RestInput::kAnkle);
  step_ = by(RestInput::kStep);
  // All that the ankles feel of the cart's velocity is late (Perceive).
  Eigen::Array3d at_once{0.0, 0.0, 0.0};
  if (late) {
    at_once = {p[kPassiveStiffness], 0.0, p[kPassiveDamping]};
    ankle_delay_ = p[kReactionDelay];
    step_delay_ = p[StepDelayOf(options.delay)];
  }
  now_ += ankle * at_once.matrix().asDiagonal();
  ankle_ = ankle * (1.0 - at_once).matrix().asDiagonal();

  const Body body = BodyAtRest(upright, person, p);
  const Matrix4<double> mass = MassMatrix(body, Angles<double>());
  mass_ << mass(plane, plane), mass(plane, 2 + plane), mass(2 + plane, plane),
      mass(2 + plane, 2 + plane);
  mgl_ = kGravity * body.point_mass() * body.pendulum_length();
  // A backward difference of the cart's velocity: in short steps a mass.
  const double by_previous = rest.by_previous[plane];
  inertia_ = mass_;
  inertia_(0, 0) += kStep * by_previous;
  now_(0, 1) += by_previous - rest.ground;
}

Eigen::Matrix2cd LinearLoop::Impedance(const Complex& s, bool with_ankle) const {
  Eigen::Matrix<Complex, 2, 3> j = now_.cast<Complex>() + std::exp(-s * step_delay_) * step_;
  if (with_ankle) j += std::exp(-s * ankle_delay_) * ankle_;
  Matrix2c z = (s * s) * inertia_.cast<Complex>();
  z.col(0) -= s * j.col(1);
  z.col(1) -= j.col(0) + s * j.col(2);
  return z;
}

LoopAnswer LinearLoop::Answer(Disturbance disturbance, double hz) const {
  const Complex s(0.0, 2.0 * M_PI * hz), s2 = s * s;
  const bool tilts = disturbance == Disturbance::kGroundTilt;
  Eigen::Vector2cd felt{s2, 0.0};
  if (tilts) felt = {plane_ == 0 ? -kGravity : kGravity, s2};
  const Eigen::Vector2cd of_ground = -mass_.cast<Complex>() * felt;
  const Eigen::Vector2cd at = Impedance(s, true).inverse() * of_ground;
  const Complex torque =
      s2 * (mass_(1, 0) * at[0] + mass_(1, 1) * at[1]) - of_ground[1] - mgl_ * at[1];
  return {at[1] + (tilts ? 1.0 : 0.0), torque};
}

std::complex<double> LinearLoop::LoopGain(double hz) const {
  const Complex s(0.0, 2.0 * M_PI * hz);
  const Eigen::Vector2cd torque{0.0, 1.0};
  const Eigen::Vector2cd place = Impedance(s, false).inverse() * torque;
  const Complex felt =
      ankle_(1, 0) * place[1] + s * (ankle_(1, 1) * place[0] + ankle_(1, 2) * place[1]);
  return -(std::exp(-s * ankle_delay_) * felt);
}

std::vector<std::complex<double>> LinearLoop::Modes() const {
  const Eigen::Matrix2d inverse = inertia_.inverse();
  const auto rates = [&inverse](const Row& by) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    a.bottomRows<2>() = inverse * by;
    return a;
  };
  Eigen::Matrix3d present = rates(now_);
  present(0, 2) = 1.0;  // e' = w
  const double longest = std::max(ankle_delay_, step_delay_);
  Eigen::MatrixXd generator;
  if (longest <= 0.0) {
    generator = present + rates(ankle_) + rates(step_);
  } else {
    Eigen::VectorXd x(kNodes);
    for (int i = 0; i < kNodes; ++i) x[i] = 0.5 * (std::cos(M_PI * i / (kNodes - 1)) - 1.0);
    const Eigen::MatrixXd by = Differentiation(x) / longest;
    const Eigen::RowVectorXd of_ankle = Interpolation(x, -ankle_delay_ / longest);
    const Eigen::RowVectorXd of_step = Interpolation(x, -step_delay_ / longest);
    generator = Eigen::MatrixXd::Zero(3 * kNodes, 3 * kNodes);
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; i > 0 && j < kNodes; ++j) {
        generator.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(by(i, j));
      }
      generator.block<3, 3>(0, 3 * i) = of_ankle[i] * rates(ankle_) + of_step[i] * rates(step_);
    }
    generator.topLeftCorner<3, 3>() += present;
  }
  const Eigen::VectorXcd found = Eigenvalues(generator);
  return {found.data(), found.data() + found.size()};
}

void LinearLoop::FindMargins(LoopNumbers* numbers) const {
  // Where a sign changes between two frequencies, to the last bit.
  const auto root = [this](double a, double b, double (*value)(const Complex&)) {
    const bool rises = value(LoopGain(b)) > 0.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = std::sqrt(a * b);
      ((value(LoopGain(middle)) > 0.0) == rises ? b : a) = middle;
    }
    return std::sqrt(a * b);
  };
  const auto over_one = [](const Complex& gain) { return std::abs(gain) - 1.0; };
  const auto side = [](const Complex& gain) { return gain.imag(); };
  const auto take_gain = [numbers](double factor) {
    if (factor > 1.0) {
      numbers->gain_up = std::min(factor, numbers->gain_up.value_or(factor));
    } else {
      numbers->gain_down = std::max(factor, numbers->gain_down.value_or(factor));
    }
  };
  const double ratio = std::pow(kHighestHz / kLowestHz, 1.0 / kSteps);
  double hz = kLowestHz;
  Complex gain = LoopGain(hz);
  // At rest L is real.
  if (gain.real() < 0.0 && std::abs(std::remainder(std::arg(gain), M_PI)) < 0.1) {
    take_gain(1.0 / std::abs(gain));
  }
  for (int i = 0; i < kSteps; ++i) {
    const double next_hz = hz * ratio;
    const Complex next = LoopGain(next_hz);
    if ((over_one(gain) > 0.0) != (over_one(next) > 0.0)) {
      const double at = root(hz, next_hz, over_one);
      const double margin = std::remainder(std::arg(LoopGain(at)) + M_PI, 2.0 * M_PI);
      if (!numbers->phase_margin || std::abs(margin) < std::abs(*numbers->phase_margin)) {
        numbers->phase_margin = std::abs(margin);
        numbers->crossover_hz = at;
      }
      const double later = (margin < 0.0 ? margin + 2.0 * M_PI : margin) / (2.0 * M_PI * at);
      numbers->delay_margin = std::min(later, numbers->delay_margin.value_or(later));
    }
    if (gain.real() < 0.0 && next.real() < 0.0 && (side(gain) > 0.0) != (side(next) > 0.0)) {
      take_gain(1.0 / std::abs(LoopGain(root(hz, next_hz, side))));
    }
    hz = next_hz;
    gain = next;
  }
}

LoopNumbers LinearLoop::Numbers() const {
  LoopNumbers numbers;
  // Gravity is in what is felt at once.
  numbers.stiffness_ratio = 1.0 - (now_(1, 0) + ankle_(1, 0)) / mgl_;
  numbers.fastest_growth = -INFINITY;
  double slowest = -INFINITY;
  for (const Complex& rate : Modes()) {
    numbers.fastest_growth = std::max(numbers.fastest_growth, rate.real());
    if (rate.imag() <= 1e-9 * std::abs(rate) || rate.real() <= slowest) continue;
    slowest = rate.real();
    numbers.damping_ratio = -rate.real() / std::abs(rate);
    numbers.natural_hz = std::abs(rate) / (2.0 * M_PI);
  }
  numbers.stable = numbers.fastest_growth < 0.0;
  if (numbers.stable) FindMargins(&numbers);
  return numbers;
}

}  // namespace pushid
