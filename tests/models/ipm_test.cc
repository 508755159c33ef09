// The equations of motion against an independent derivation: kinetic and potential energy of a cart
// and of a point mass at HipPosition, differentiated.
#include "models/ipm.h"

#include <ceres/jet.h>

#include <Eigen/Geometry>

#include "models/decompositions.h"
#include "models/skeleton_mapping.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

using Jet4 = ceres::Jet<double, 4>;

// d HipPosition / d q, by automatic differentiation.
Eigen::Matrix<double, 3, 4> HipJacobian(const Body& body, const Vector4<double>& q) {
  Vector4<Jet4> jets;
  for (int i = 0; i < 4; ++i) jets[i] = Jet4(q[i], i);
  const Vector3<Jet4> hip = HipPosition(body, jets);
  Eigen::Matrix<double, 3, 4> jacobian;
  for (int i = 0; i < 3; ++i) jacobian.row(i) = hip[i].v.transpose();
  return jacobian;
}

// The matrix of the kinetic energy T = qd^T A qd / 2.
Matrix4<double> EnergyMatrix(const Body& body, const Vector4<double>& q) {
  const auto jacobian = HipJacobian(body, q);
  Matrix4<double> matrix = body.point_mass() * jacobian.transpose() * jacobian;
  matrix.topLeftCorner<2, 2>() += kCartShare * body.mass * Eigen::Matrix2d::Identity();
  return matrix;
}

double Energy(const Body& body, const PendulumState<double>& state) {
  return 0.5 * state.qd.dot(EnergyMatrix(body, state.q) * state.qd) +
         body.point_mass() * kGravity * HipPosition(body, state.q).z();
}

// Euler-Lagrange: (dA/dt) qd - grad(qd^T A qd) / 2, with A differentiated numerically.
Vector4<double> VelocityForces(const Body& body, const PendulumState<double>& state) {
  constexpr double kStep = 1e-5;
  Vector4<double> force = Vector4<double>::Zero();
  for (int i = 0; i < 4; ++i) {
    const Vector4<double> step = kStep * Vector4<double>::Unit(i);
    const Matrix4<double> derivative =
        (EnergyMatrix(body, state.q + step) - EnergyMatrix(body, state.q - step)) / (2 * kStep);
    force += derivative * state.qd * state.qd[i];
    force[i] -= 0.5 * state.qd.dot(derivative * state.qd);
  }
  return force;
}

TEST(Ipm, MassMatrixIsSymmetricPositiveDefiniteAndThatOfTheKineticEnergy) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const Vector4<double> q = RandomState(&random).q;
    const Matrix4<double> mass = MassMatrix(body, q);
    EXPECT_EQ(mass, mass.transpose());
    EXPECT_GT(DecomposeSymmetric(mass).values.minCoeff(), 0.0);
    ExpectClose(mass, EnergyMatrix(body, q), 1e-13, body.mass);
  }
}

TEST(Ipm, InverseMassMatrixTimesMassMatrixIsIdentity) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const Vector4<double> q = RandomState(&random).q;
    ExpectClose(InverseMassMatrix(body, Angles<double>(q), body.mass) * MassMatrix(body, q),
                Matrix4<double>::Identity(), 1e-11);
  }
}

TEST(Ipm, CoriolisTermsFollowFromTheKineticEnergy) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const PendulumState<double> state = RandomState(&random);
    ExpectClose(Coriolis(body, Angles<double>(state.q), state.qd), VelocityForces(body, state),
                1e-7, 10.0);
  }
}

TEST(Ipm, GravityIsTheGradientOfThePotentialEnergy) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const Vector4<double> q = RandomState(&random).q;
    const Vector4<double> gradient =
        body.point_mass() * kGravity * HipJacobian(body, q).row(2).transpose();
    ExpectClose(Gravity(body, q), gradient, 1e-13, 100.0);
  }
}

TEST(Ipm, InverseDynamicsGivesBackTheForce) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const PendulumState<double> state = RandomState(&random);
    const Vector4<double> force = RandomVector(&random, 300.0);
    const Vector4<double> qdd = Acceleration(body, state, force);
    ExpectClose(InverseDynamics(body, state, qdd), force, 1e-11, 300.0);
  }
}

// Half a second without force. The integrator is of first order: a tenth of the step must leave
// about a tenth of the energy error.
TEST(Ipm, EnergyIsConservedWithoutForce) {
  Random random(6);
  for (int trial = 0; trial < 5; ++trial) {
    const Body body = RandomBody(&random);
    PendulumState<double> start = RandomState(&random, 0.2);
    const auto energy_error = [&](int steps) {
      PendulumState<double> state = start;
      const double dt = 0.5 / steps;
      for (int i = 0; i < steps; ++i) {
        state = Step<double>(state, Acceleration<double>(body, state, Vector4<double>::Zero()), dt);
      }
      return std::abs(Energy(body, state) - Energy(body, start));
    };
    const double coarse = energy_error(5000), fine = energy_error(50000);
    EXPECT_LT(coarse, 0.5);  // J, of several hundred
    EXPECT_NEAR(fine / coarse, 0.1, 0.02);
  }
}

TEST(Ipm, MirroredMotionsMirrorTheAccelerations) {
  Random random(7);
  const Vector4<double> left_right(1, -1, 1, -1), front_back(-1, 1, -1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const Body body = RandomBody(&random);
    const PendulumState<double> state = RandomState(&random);
    const Vector4<double> force = RandomVector(&random, 300.0);
    const Vector4<double> qdd = Acceleration(body, state, force);
    for (const Vector4<double>& mirror : {left_right, front_back}) {
      const PendulumState<double> mirrored{mirror.cwiseProduct(state.q),
                                           mirror.cwiseProduct(state.qd)};
      ExpectClose(Acceleration<double>(body, mirrored, mirror.cwiseProduct(force)),
                  mirror.cwiseProduct(qdd).eval(), 1e-12, 1.0);
    }
  }
}

// theta and phi are not interchangeable angles, but the physics knows no preferred direction: the
// whole motion turned by any angle about z has the turned accelerations.
TEST(Ipm, PhysicsDoesNotDependOnTheHeading) {
  Random random(8);
  for (int trial = 0; trial < 20; ++trial) {
    const Body body = RandomBody(&random);
    const PendulumState<double> state = RandomState(&random, 0.5);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random.Uniform(-3.0, 3.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const auto turned_pose = [&](double time) {
      const Vector4<double> q = state.q + time * state.qd;
      const Eigen::Vector3d cart = turn * Eigen::Vector3d(q[0], q[1], body.cart_height);
      return MapSkeleton(turn * HipPosition(body, q), cart, cart).q;
    };
    constexpr double kStep = 1e-5;
    const PendulumState<double> turned{turned_pose(0.0),
                                       (turned_pose(kStep) - turned_pose(-kStep)) / (2.0 * kStep)};
    const Vector4<double> none = Vector4<double>::Zero();
    const Vector4<double> before = Acceleration(body, state, none);
    const Vector4<double> after = Acceleration(body, turned, none);
    const Eigen::Vector3d expected = turn * Eigen::Vector3d(before[0], before[1], 0.0);
    ExpectClose(after.head<2>().eval(), expected.head<2>().eval(), 1e-7, 1.0);
  }
}

TEST(Ipm, HipStandsAboveTheCartWhenUpright) {
  const Body body{80.0, 0.95, 0.1};
  const Vector3<double> hip = HipPosition<double>(body, {1.0, 2.0, 0.0, 0.0});
  EXPECT_EQ(hip, Vector3<double>(1.0, 2.0, 1.05));
  // theta leans forward, phi leans to the right (-y).
  EXPECT_GT(HipPosition<double>(body, {0.0, 0.0, 0.1, 0.0}).x(), 0.0);
  EXPECT_LT(HipPosition<double>(body, {0.0, 0.0, 0.0, 0.1}).y(), 0.0);
}

}  // namespace
}  // namespace pushid
