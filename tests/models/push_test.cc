// Pushes: the tail, generalized forces, the push of the settling simulations.
#include "models/push.h"

#include "models/scene.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

constexpr double kMass = 80.0;  // kg, of who is pushed

ScenePush RandomPush(Random* random, int rows, PushKind kind, int start_frame = 3) {
  std::vector<Vector4<double>> force;
  for (int i = 0; i < rows; ++i) force.push_back(RandomVector(random, 400.0));
  return MakeScenePush(0, start_frame, kind, force);
}

TEST(PushTail, FollowsItsFormula) {
  Random random(1);
  const ScenePush push = RandomPush(&random, 6, PushKind::kNet);
  ParameterSet<double> p = RandomParameters(&random);
  p[kTailTime] = 0.2;
  ASSERT_EQ(push.EndFrame(), 9);
  EXPECT_EQ(TailForce(push, kMass, p, 8, kSampleDt), Vector4<double>(Vector4<double>::Zero()));
  Vector4<double> mean = Vector4<double>::Zero();
  for (const Vector4<double>& row : push.force) mean += row / 6.0;
  const double share = p[kTailBase] * kMass / (0.2 * mean.head<2>().norm());
  const double force = p[kTailGain] + share, torque = p[kTailTorque] * (1.0 + share);
  const Vector4<double> gain(force, force, torque, torque);
  // A push of six frames lasts the reference duration, whatever the exponent.
  EXPECT_NEAR(TailDecayTime(p, LogTailDuration(6 * kSampleDt)), 0.2, 1e-15);
  EXPECT_NEAR(TailDecayTime(p, LogTailDuration(12 * kSampleDt)),
              0.2 * std::pow(2.0, p[kTailExponent]), 1e-14);
  for (int k : {0, 1, 12}) {
    const Vector4<double> expected = gain.cwiseProduct(mean) * std::exp(-k * kSampleDt / 0.2);
    ExpectClose(TailForce(push, kMass, p, 9 + k, kSampleDt), expected, 1e-13, 1.0);
  }
}

TEST(PushTail, ExternalAndEmptyPushesHaveNone) {
  Random random(2);
  const ParameterSet<double> p = RandomParameters(&random);
  for (const ScenePush& push :
       {RandomPush(&random, 6, PushKind::kExternal), RandomPush(&random, 0, PushKind::kNet)}) {
    EXPECT_EQ(TailForce(push, kMass, p, 20, kSampleDt), Vector4<double>(Vector4<double>::Zero()));
  }
}

// The part that does not depend on the push gives everybody the same speed, along the push.
TEST(PushTail, ItsBaseIsASpeed) {
  ParameterSet<double> p{};
  p[kTailBase] = 0.8, p[kTailTime] = 0.25;
  const double frame = 1e-3;
  for (double mass : {50.0, 100.0}) {
    for (double strength : {1.0, 7.0}) {
      const Vector4<double> force(30.0 * strength, -40.0 * strength, 9.0, 2.0);
      const ScenePush push = MakeScenePush(0, 0, PushKind::kNet, {force, force});
      Eigen::Vector2d impulse = Eigen::Vector2d::Zero();
      for (int t = 0; t < 10000; ++t) {
        impulse += frame * TailForce(push, mass, p, t, frame).head<2>();
      }
      EXPECT_NEAR(impulse[0] / mass, 0.8 * 0.6, 2e-3);
      EXPECT_NEAR(impulse[1] / mass, -0.8 * 0.8, 2e-3);
      EXPECT_NEAR(TailImpulse(push, mass, p, frame), impulse.norm(), 1e-9 * mass);
    }
  }
  const ScenePush none = MakeScenePush(0, 0, PushKind::kNet, {{0.0, 0.0, 5.0, 0.0}});
  EXPECT_EQ(TailForce(none, 80.0, p, 3, frame).norm(), 0.0);
}

// An impulse over ever more frames: the tail brings an ever smaller share of it, also with an
// exponent that once made a push of two seconds go on for minutes.
TEST(PushTail, StaysInProportionToTheWholePush) {
  constexpr double kImpulse = 40.0;  // N s
  ParameterSet<double> p{};
  p[kTailGain] = 1.0, p[kTailTime] = 0.25;
  for (double exponent : {0.0, 1.55}) {
    p[kTailExponent] = exponent;
    double last_share = 10.0;
    for (int frames : {6, 12, 15, 22, 60, 120}) {
      const Vector4<double> force(kImpulse / (frames * kSampleDt), 0.0, 0.0, 0.0);
      const ScenePush push = MakeScenePush(
          0, 2, PushKind::kNet, std::vector<Vector4<double>>(static_cast<size_t>(frames), force));
      double tail = 0.0;
      for (int frame = 0; frame < 20000; ++frame)
        tail += TailForce(push, kMass, p, frame, kSampleDt)[0] * kSampleDt;
      EXPECT_NEAR(WholeImpulse(push, kMass, p, kSampleDt), kImpulse + tail, 1e-9 * tail) << frames;
      const double share = tail / kImpulse;
      if (exponent == 0.0 || frames > 24) {
        EXPECT_LT(share, last_share) << frames;
      }
      EXPECT_LT(share, 6.0) << frames;
      last_share = share;
    }
    EXPECT_LT(last_share, 1.2);
  }
}

TEST(PushTail, WholeImpulseOfAnExternalPushIsItsOwn) {
  ParameterSet<double> p{};
  p[kTailGain] = 1.0, p[kTailTime] = 0.25;
  const ScenePush push =
      MakeScenePush(0, 0, PushKind::kExternal, {{30, 40, 7, 0}, {30, 40, 0, 0}, {0, 0, 0, 0}});
  EXPECT_NEAR(WholeImpulse(push, kMass, p, 0.1), 10.0, 1e-12);
  EXPECT_EQ(WholeImpulse(MakeScenePush(0, 0, PushKind::kNet, {}), kMass, p, 0.1), 0.0);
}

// Virtual work: Q . dq = f . d(point of contact), with the point at the fraction `height` of the
// rod.
TEST(GeneralizedForce, DoesTheWorkOfTheForceAtItsPoint) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const Vector4<double> q = RandomState(&random).q;
    const Vector3<double> force = RandomVector(&random, 300.0).head<3>();
    const double height = random.Uniform(0.0, 1.3);
    const Body lever{body.mass, height * body.rod_length, body.cart_height};
    const Vector4<double> generalized = GeneralizedForce(body, q, force, height);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 4; ++i) {
      const Vector4<double> step = kStep * Vector4<double>::Unit(i);
      const Vector3<double> moved = HipPosition<double>(lever, q + step);
      const double work = force.dot(moved - HipPosition<double>(lever, q - step)) / (2 * kStep);
      EXPECT_NEAR(generalized[i], work, 1e-6) << "coordinate " << i;
    }
  }
}

TEST(HalfSinePush, HasExactlyTheNamedImpulse) {
  const Body body{80.0, 0.95, 0.0};
  for (int frames : {1, 2, 12, 37}) {
    for (double dt : {1.0 / 60.0, 1.0 / 100.0}) {
      const std::vector<Vector4<double>> push = HalfSinePush(body, 25.0, frames, dt);
      ASSERT_EQ(push.size(), static_cast<size_t>(frames));
      Vector4<double> impulse = Vector4<double>::Zero();
      for (size_t k = 0; k < push.size(); ++k) {
        impulse += dt * push[k];
        EXPECT_GT(push[k][0], 0.0);
        EXPECT_NEAR(push[k][0], push[push.size() - 1 - k][0], 1e-9);  // symmetric in time
      }
      ExpectClose(impulse, Vector4<double>(25.0, 0.0, 25.0 * 0.95, 0.0), 1e-13);
    }
  }
}

TEST(Scene, ScaledPushesScaleTheTailToo) {
  Random random(5);
  Scene scene = SettlingScene(80.0, 25.0);
  scene.pushes.push_back(RandomPush(&random, 5, PushKind::kNet));
  const Scene scaled = ScalePushes(scene, 1.4);
  ParameterSet<double> p = RandomParameters(&random);
  p[kTailBase] = 0.0;
  EXPECT_EQ(scene.LastPushEnd(), 12);
  for (int i : {0, 1}) {
    ExpectClose(scaled.pushes[i].force[2], (1.4 * scene.pushes[i].force[2]).eval(), 1e-14);
    ExpectClose(TailForce(scaled.pushes[i], kMass, p, 30, kSampleDt),
                (1.4 * TailForce(scene.pushes[i], kMass, p, 30, kSampleDt)).eval(), 1e-14);
  }
}

}  // namespace
}  // namespace pushid
