// The polynomial of the free modes against the eigenvalues of the linearized equations of motion,
// and the Routh-Hurwitz conditions against the roots.
#include "models/modal_stability.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <complex>

#include "models/decompositions.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

ParameterSet<double> Gains(Random* random) {
  ParameterSet<double> p{};
  p[kMu] = random->Uniform(-30, 60), p[kMuY] = random->Uniform(10, 60);
  p[kKpX] = random->Uniform(0, 10), p[kKpY] = random->Uniform(0, 10);
  p[kKpTheta] = random->Uniform(500, 2500), p[kKpPhi] = random->Uniform(500, 2500);
  p[kKdTheta] = random->Uniform(20, 100), p[kKdPhi] = random->Uniform(20, 100);
  for (Parameter id : {kAx, kAy}) p[id] = random->Uniform(-20, 5);
  for (Parameter id : {kBx, kBy, kTx, kTy}) p[id] = random->Uniform(-1, 1);
  return p;
}

// Eigenvalues of the equations of motion linearized by Jets: [theta, phi, qd], six of them.
Eigen::VectorXcd Eigenvalues(const ModelOptions& options, const Body& body,
                             const ParameterSet<double>& p) {
  using Jet = ceres::Jet<double, 6>;
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kNumParameters; ++i) parameters[i] = Jet(p[i]);
  PendulumState<Jet> state;
  state.q = {Jet(0.0), Jet(0.0), Jet(0.0, 0), Jet(0.0, 1)};
  for (int i = 0; i < 4; ++i) state.qd[i] = Jet(0.0, 2 + i);
  const SelfForce self(options, body, Vector4<double>::Zero(), 1.0 / 60.0);
  const Vector4<Jet> force = self.Total(parameters, state, state.qd);
  const Vector4<Jet> a = Acceleration(body, state, force);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6, 6);
  matrix(0, 4) = matrix(1, 5) = 1.0;
  for (int i = 0; i < 4; ++i) matrix.row(2 + i) = a[i].v.transpose();
  return pushid::Eigenvalues(matrix);
}

// A pendulum with no forces but gravity on a cart that rolls freely: the cart runs back under it,
// m_c v' = -m g e, so w' = (g / l) (M / m_c) e, with m_c = 0.1 M: rates 0 and +-sqrt(10 g / l).
TEST(FreeModes, ByHand) {
  for (int plane : {0, 1}) {
    const ModePolynomial<double> c =
        FreeModes(UprightRest<double>({}, {70.0, 0.9, 0.0}, {}), plane);
    EXPECT_NEAR(c.c2, 0.0, 1e-12);
    EXPECT_NEAR(c.c1, -10.0 * 9.81 / 0.9, 1e-9);
    EXPECT_NEAR(c.c0, 0.0, 1e-12);
  }
}

// What the equations at the head of self_force.h and ipm.h come to, worked out on paper. The y
// plane mirrored (phi turns towards -y) obeys those of the x plane; K acts like a mass.
ModePolynomial<double> OnPaper(const ModelOptions& options, const Body& body,
                               const ParameterSet<double>& p, int plane) {
  const GainScale scale(options.gain_scaling, body);
  const auto of = [&](Parameter x, Parameter y) { return p[plane == 0 ? x : y]; };
  const bool isotropic = options.friction == FrictionKind::kIsotropic;
  const double mass = body.mass, m = body.point_mass(), l = body.rod_length;
  const double f_v = -scale.force * (of(kMu, isotropic ? kMu : kMuY) + of(kKpX, kKpY));
  const double f_e = mass * of(kAx, kAy), f_w = mass * of(kBx, kBy), t_v = mass * of(kTx, kTy);
  const double t_e = m * kGravity * l - scale.stiffness * of(kKpTheta, kKpPhi);
  const double t_w = -scale.damping * of(kKdTheta, kKdPhi);
  const bool backward = options.cart_derivative == CartDerivative::kBackward;
  const double inertia = mass + (backward ? scale.force * of(kKdX, kKdY) : 0.0);
  const double det = inertia * m * l * l - m * l * m * l;
  const auto cart = [&](double f, double t) { return (m * l * l * f - m * l * t) / det; };
  const auto angle = [&](double f, double t) { return (inertia * t - m * l * f) / det; };
  const double a_v = cart(f_v, t_v), b_v = angle(f_v, t_v), b_e = angle(f_e, t_e);
  return {-(a_v + angle(f_w, t_w)), a_v * angle(f_w, t_w) - cart(f_w, t_w) * b_v - b_e,
          a_v * b_e - cart(f_e, t_e) * b_v};
}

TEST(FreeModes, AreThoseOfTheEquationsOnPaper) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    ModelOptions options;
    options.gain_scaling = static_cast<GainScaling>(trial % 3);
    options.friction = trial % 2 == 0 ? FrictionKind::kIsotropic : FrictionKind::kAnisotropic;
    options.cart_derivative = trial % 5 < 2 ? CartDerivative::kNone : CartDerivative::kBackward;
    const Body body = RandomBody(&random);
    ParameterSet<double> p = Gains(&random);
    p[kKdX] = random.Uniform(-4, 4), p[kKdY] = random.Uniform(-4, 4);
    p[kCq] = p[kDq] = 1.0;  // vanish at rest
    for (int plane : {0, 1}) {
      const ModePolynomial<double> actual = FreeModes(UprightRest<double>(options, body, p), plane);
      const ModePolynomial<double> expected = OnPaper(options, body, p, plane);
      EXPECT_NEAR(actual.c2, expected.c2, 1e-12 * (1.0 + std::abs(expected.c2)));
      EXPECT_NEAR(actual.c1, expected.c1, 1e-12 * (100.0 + std::abs(expected.c1)));
      EXPECT_NEAR(actual.c0, expected.c0, 1e-12 * (1000.0 + std::abs(expected.c0)));
    }
  }
}

// Of a pole on a cart that rolls freely: g M / (l' (M - m')), with the point and the length of the
// table's masses.
TEST(FreeModes, OfTheTablesBodyFallAsItDoes) {
  ModelOptions options;
  options.body = BodyModel::kTable;
  ParameterSet<double> p{};
  p[kCartMassShare] = 0.3, p[kComHeight] = 0.6, p[kGyrationRadius] = 0.2;
  const Body body{2.0, 0.8, 0.0};
  const double inertia = 0.6 * 0.6 + 0.2 * 0.2;
  const double length = 0.8 * inertia / 0.6, point = 2.0 * 0.7 * 0.6 * 0.6 / inertia;
  for (int plane = 0; plane < 2; ++plane) {
    const ModePolynomial<double> c = FreeModes(UprightRest<double>(options, body, p), plane);
    EXPECT_NEAR(c.c1, -kGravity * 2.0 / (length * (2.0 - point)), 1e-9);
  }
}

TEST(FreeModes, RootsAreTheEigenvalues) {
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    ModelOptions options;
    options.friction = trial % 2 == 0 ? FrictionKind::kIsotropic : FrictionKind::kAnisotropic;
    const Body body = RandomBody(&random);
    const ParameterSet<double> p = Gains(&random);
    const Eigen::VectorXcd eigenvalues = Eigenvalues(options, body, p);
    bool stable = true, both = true;
    for (int i = 0; i < 6; ++i) {
      const std::complex<double> z = eigenvalues[i];
      stable = stable && z.real() < 0.0;
      double smallest = 1e300;
      for (int plane = 0; plane < 2; ++plane) {
        const ModePolynomial<double> c = FreeModes(UprightRest<double>(options, body, p), plane);
        smallest = std::min(smallest, std::abs(((z + c.c2) * z + c.c1) * z + c.c0));
      }
      // The quadratic damping is not quite zero at rest; p's c_q and d_q are.
      EXPECT_LT(smallest, 1e-7 * std::pow(1.0 + std::abs(z), 3));
    }
    for (int plane = 0; plane < 2; ++plane) {
      for (double condition :
           FreeModes(UprightRest<double>(options, body, p), plane).Conditions()) {
        both = both && condition > 0.0;
      }
    }
    EXPECT_EQ(both, stable);
  }
}

TEST(FreeModes, ShiftingMovesTheRoots) {
  const ModePolynomial<double> c{6.0, 11.0, 6.0};  // roots -1, -2, -3
  const auto decays = [&c](double margin) {
    bool all = true;
    for (double condition : c.Shifted(margin).Conditions()) all = all && condition > 0.0;
    return all;
  };
  EXPECT_TRUE(decays(0.0));
  EXPECT_TRUE(decays(0.99));
  EXPECT_FALSE(decays(1.01));
}

}  // namespace
}  // namespace pushid
