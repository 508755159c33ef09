// The hip over the feet, and how far it may go.
#include "models/support.h"

#include "tests/models/model_samples.h"

namespace pushid {
namespace {

TEST(Support, CapturePointIsThatOfTheHip) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const PendulumState<double> state = RandomState(&random, 0.3);
    constexpr double kStep = 1e-6;
    const Vector4<double> after = state.q + kStep * state.qd, before = state.q - kStep * state.qd;
    const Eigen::Vector2d velocity =
        (HipPosition(body, after) - HipPosition(body, before)).head<2>() / (2 * kStep);
    const Eigen::Vector2d place = HipPosition(body, state.q).head<2>() - state.q.head<2>();
    const Eigen::Vector2d expected = place + velocity / std::sqrt(kGravity / body.rod_length);
    const SelfForce self({}, body, Vector4<double>::Zero(), 1.0 / 60);
    const HipOverFeet<double> hip(self.standing, Angles<double>(state.q), state.qd);
    ExpectClose(hip.Capture(self.standing), expected, 1e-8);
  }
}

TEST(Support, LimitIsSmoothAndKept) {
  for (double u : {-30.0, -1.0, -0.8, -0.3, 0.0, 0.3, 0.8, 1.0, 5.0, 1e4}) {
    EXPECT_LE(std::abs(SmoothLimit(u, 1.0)), 1.0);
    EXPECT_NEAR(SmoothLimit(40.0 * u, 40.0), 40.0 * SmoothLimit(u, 1.0), 1e-12 * 40.0);
    if (std::abs(u) > 0.8) continue;
    EXPECT_NEAR(SmoothLimit(u, 1.0), u, 0.09 * std::abs(u));
  }
}

}  // namespace
}  // namespace pushid
