// Rollouts: which forces act when, several people and pushes, and what a failure names.
#include "models/rollout.h"

#include "tests/models/model_samples.h"

namespace pushid {
namespace {

ParameterSet<double> UprightParameters() {
  ParameterSet<double> p{};
  p[kMu] = 40.0;
  p[kKpTheta] = 1700.0;
  p[kKdTheta] = 90.0;
  p[kKpPhi] = 1700.0;
  p[kKdPhi] = 90.0;
  p[kAx] = p[kAy] = -9.0;
  p[kTailGain] = 1.1;
  p[kTailTorque] = 0.3;
  p[kTailTime] = 0.2;
  p[kTailExponent] = 1.5, p[kTailBase] = 0.3;
  return p;
}

Scene PeopleScene(int num_people) {
  Scene scene;
  for (int n = 0; n < num_people; ++n) {
    ScenePerson person;
    person.body = {60.0 + 10.0 * n, 0.85 + 0.05 * n, 0.1};
    person.start.q = {0.8 * n, 0.1 * n, 0.02 + 0.01 * n, -0.03};
    scene.people.push_back(person);
  }
  return scene;
}

std::vector<Vector4<double>> ConstantForce(int rows, const Vector4<double>& force) {
  return std::vector<Vector4<double>>(rows, force);
}

RolloutPath<double> Roll(const Scene& scene, const ModelOptions& options,
                         const std::vector<ParameterSet<double>>& p, int frames,
                         RolloutStatus* status = nullptr) {
  RolloutPath<double> path;
  const RolloutStatus result = Rollout(scene, options, p, InitialVelocities(scene), frames, &path);
  if (status != nullptr) {
    *status = result;
  } else {
    EXPECT_TRUE(result.ok) << result.quantity << " at frame " << result.frame;
  }
  return path;
}

TEST(Rollout, StandingPersonStaysAtRest) {
  const Scene scene = PeopleScene(3);
  ModelOptions options;
  options.posture = Posture::kInitial;
  const auto path = Roll(scene, options, std::vector(3, UprightParameters()), 300);
  for (int n = 0; n < 3; ++n) {
    ExpectClose(path.At(299, n).q, scene.people[n].start.q, 1e-12);
    EXPECT_LT(path.At(299, n).qd.norm(), 1e-12);
  }
}

struct PushCase {
  PushKind kind;
  PushUse use;
  bool balance, friction, tail;  // what acts beside the push; whether a tail follows it
};

class PushSemantics : public testing::TestWithParam<PushCase> {};

TEST_P(PushSemantics, ForcesDuringAndAfterThePush) {
  const PushCase& expected = GetParam();
  Random random(1);
  Scene scene = PeopleScene(2);
  scene.pushes = {
      MakeScenePush(1, 5, expected.kind, ConstantForce(4, {120.0, -30.0, 100.0, 20.0}))};
  ModelOptions options;
  options.push = expected.use;
  const ParameterSet<double> p = UprightParameters();
  const PosedPendulum<double> state = RandomState(&random, 0.3);
  const std::vector<SelfForce> self = SelfForces(scene, options);
  const Vector4<double> push(120.0, -30.0, 100.0, 20.0), none = Vector4<double>::Zero();
  const Vector4<double> friction = self[1].Friction(p, state.qd);
  const Vector4<double> balance = self[1].Balance(p, state, state.qd);
  const Vector4<double> linear = self[1].Linear(p, state);

  for (int frame : {0, 4, 5, 8, 9, 20}) {
    const NetForce<double> force =
        NetForceAt(scene, options, self[1], p, 1, frame, state, state.qd);
    const bool during = frame >= 5 && frame < 9;
    EXPECT_EQ(force[ForcePart::kPush], during ? push : none) << frame;
    EXPECT_EQ(force[ForcePart::kFriction], during && !expected.friction ? none : friction) << frame;
    EXPECT_EQ(force[ForcePart::kBalance], during && !expected.balance ? none : balance) << frame;
    EXPECT_EQ(force[ForcePart::kLinear], during && !expected.balance ? none : linear) << frame;
    EXPECT_EQ(force[ForcePart::kTail].norm() > 0.0, frame >= 9 && expected.tail) << frame;
    // The other person notices nothing.
    const NetForce<double> other =
        NetForceAt(scene, options, self[0], p, 0, frame, state, state.qd);
    EXPECT_EQ((other[ForcePart::kPush] + other[ForcePart::kTail]).norm(), 0.0);
    EXPECT_EQ(other[ForcePart::kFriction], self[0].Friction(p, state.qd));
  }
  options.push_tail = PushTail::kNone;
  EXPECT_EQ(NetForceAt(scene, options, self[1], p, 1, 9, state, state.qd)[ForcePart::kTail], none);
}

INSTANTIATE_TEST_SUITE_P(
    EveryKindAndUse, PushSemantics,
    testing::Values(PushCase{PushKind::kNet, PushUse::kAsRecorded, false, false, true},
                    PushCase{PushKind::kNetWithoutFriction, PushUse::kAsRecorded, false, true,
                             true},
                    PushCase{PushKind::kExternal, PushUse::kAsRecorded, true, true, false},
                    PushCase{PushKind::kNet, PushUse::kAdded, true, true, true},
                    PushCase{PushKind::kNetWithoutFriction, PushUse::kAdded, true, true, true},
                    PushCase{PushKind::kExternal, PushUse::kAdded, true, true, false}));

// A `net` push is the whole force while it lasts, so no earlier push's tail comes on top of it.
TEST(Rollout, LaterNetPushReplacesTheTailOfAnEarlierOne) {
  Scene scene = PeopleScene(1);
  scene.pushes = {MakeScenePush(0, 0, PushKind::kNet, ConstantForce(4, {120, 0, 100, 0})),
                  MakeScenePush(0, 10, PushKind::kNet, ConstantForce(4, {50, 10, 0, 0}))};
  const ParameterSet<double> p = UprightParameters();
  const PosedPendulum<double> state = scene.people[0].start;
  ModelOptions options;
  const std::vector<SelfForce> self = SelfForces(scene, options);
  const auto tail = [&](PushUse use, int frame) {
    options.push = use;
    return NetForceAt(scene, options, self[0], p, 0, frame, state, state.qd)[ForcePart::kTail];
  };
  EXPECT_EQ(tail(PushUse::kAsRecorded, 11).norm(), 0.0);
  EXPECT_GT(tail(PushUse::kAdded, 11).norm(), 0.0);
  // Afterwards both tails act.
  ExpectClose(tail(PushUse::kAsRecorded, 14),
              (TailForce(scene.pushes[0], scene.people[0].body.mass, p, 14, scene.dt) +
               TailForce(scene.pushes[1], scene.people[0].body.mass, p, 14, scene.dt))
                  .eval(),
              1e-14);
}

TEST(Rollout, OverlappingPushesAddUp) {
  Scene scene = PeopleScene(2);
  scene.pushes = {MakeScenePush(0, 2, PushKind::kExternal, ConstantForce(4, {10, 0, 0, 0})),
                  MakeScenePush(0, 4, PushKind::kExternal, ConstantForce(4, {0, 7, 1, 0})),
                  MakeScenePush(1, 4, PushKind::kExternal, ConstantForce(1, {0, 0, 0, 5}))};
  EXPECT_EQ(PushForceAt(scene, 0, 1), Vector4<double>(0, 0, 0, 0));
  EXPECT_EQ(PushForceAt(scene, 0, 2), Vector4<double>(10, 0, 0, 0));
  EXPECT_EQ(PushForceAt(scene, 0, 5), Vector4<double>(10, 7, 1, 0));
  EXPECT_EQ(PushForceAt(scene, 0, 7), Vector4<double>(0, 7, 1, 0));
  EXPECT_EQ(PushForceAt(scene, 0, 8), Vector4<double>(0, 0, 0, 0));
  EXPECT_EQ(PushForceAt(scene, 1, 4), Vector4<double>(0, 0, 0, 5));
}

// A push that starts late finds a person who has stood still until then, and moves them as an early
// one would.
TEST(Rollout, LatePushIsAnEarlyOneLater) {
  const std::vector<ParameterSet<double>> p(1, UprightParameters());
  Scene early = PeopleScene(1), late = PeopleScene(1);
  const auto force = ConstantForce(8, {60.0, 15.0, 50.0, -10.0});
  early.pushes = {MakeScenePush(0, 0, PushKind::kExternal, force)};
  late.pushes = {MakeScenePush(0, 30, PushKind::kExternal, force)};
  const auto a = Roll(early, {}, p, 90), b = Roll(late, {}, p, 120);
  for (int t : {1, 8, 40, 89}) {
    ExpectClose(b.At(t + 30, 0).q, a.At(t, 0).q, 1e-11);
    ExpectClose(b.At(t + 30, 0).qd, a.At(t, 0).qd, 1e-11);
  }
  EXPECT_GT(a.At(40, 0).qd.norm(), 0.05);
}

TEST(Rollout, PermutingPeopleChangesNothing) {
  constexpr int kPeople = 3, kFrames = 90;
  const int order[kPeople] = {2, 0, 1};  // place in the permuted scene -> person
  Scene scene = PeopleScene(kPeople), permuted = scene;
  std::vector<ParameterSet<double>> p(kPeople, UprightParameters()), permuted_p = p;
  for (int n = 0; n < kPeople; ++n) {
    p[n][kMu] += 10.0 * n;
    scene.pushes.push_back(
        MakeScenePush(n, 2 * n, PushKind::kNet, ConstantForce(5, {60.0 - n, 5.0, 50.0, 2.0 * n})));
  }
  for (int place = 0; place < kPeople; ++place) {
    permuted.people[place] = scene.people[order[place]];
    permuted_p[place] = p[order[place]];
    ScenePush push = scene.pushes[order[place]];
    push.person = place;
    permuted.pushes.insert(permuted.pushes.begin(), push);
  }
  const auto path = Roll(scene, {}, p, kFrames),
             permuted_path = Roll(permuted, {}, permuted_p, kFrames);
  for (int t = 0; t < kFrames; ++t) {
    for (int place = 0; place < kPeople; ++place) {
      ASSERT_EQ(permuted_path.At(t, place).q, path.At(t, order[place]).q);
      ASSERT_EQ(permuted_path.At(t, place).qd, path.At(t, order[place]).qd);
    }
  }
}

TEST(Rollout, FailureNamesFramePersonAndQuantity) {
  const std::vector<ParameterSet<double>> p(2);  // no balance at all: everybody falls
  Scene scene = PeopleScene(2);
  for (ScenePerson& person : scene.people) person.start.q.setZero();
  for (const auto& [coordinate, name] : {std::pair{2, "theta"}, {3, "phi"}}) {
    scene.people[1].start.q.setZero();
    scene.people[1].start.q[coordinate] = -0.4;
    ModelOptions options;
    options.posture = Posture::kUpright;
    RolloutStatus status;
    const auto path = Roll(scene, options, p, 200, &status);
    EXPECT_FALSE(status.ok);
    EXPECT_EQ(status.person, 1);
    EXPECT_EQ(status.quantity, name);
    ASSERT_GT(status.frame, 1);
    ASSERT_LT(status.frame, 200);
    EXPECT_LE(std::abs(path.At(status.frame - 1, 1).q[coordinate]), kMaxAngle);
    EXPECT_GT(std::abs(path.At(status.frame, 1).q[coordinate]), kMaxAngle);
  }
}

TEST(Rollout, InfiniteStateIsNamed) {
  Scene scene = PeopleScene(1);
  scene.pushes = {MakeScenePush(0, 7, PushKind::kExternal, ConstantForce(1, {1e308, 0, 0, 0}))};
  scene.people[0].start.qd = {1e307, 0, 0, 0};
  ModelOptions options;
  std::vector<ParameterSet<double>> p(1, UprightParameters());
  p[0][kMu] = -1e300;
  RolloutStatus status;
  Roll(scene, options, p, 20, &status);
  EXPECT_FALSE(status.ok);
  EXPECT_EQ(status.quantity, "state");
  EXPECT_EQ(status.frame, 1);
}

TEST(Rollout, MatchesStepsByHand) {
  Random random(3);
  Scene scene = SettlingScene(80.0, 25.0);
  ModelOptions options;
  options.cart_derivative = CartDerivative::kBackward;
  std::vector<ParameterSet<double>> p(1, UprightParameters());
  p[0][kKdX] = 4.0;
  const auto path = Roll(scene, options, p, 40);
  PendulumState<double> state = scene.people[0].start, before = state;
  const SelfForce self = SelfForces(scene, options)[0];
  for (int t = 0; t + 1 < 40; ++t) {
    const Vector4<double> force = OwnForce(self, p[0], state, before.qd) + PushForceAt(scene, 0, t);
    before = state;
    state = Step(state, Acceleration(scene.people[0].body, state, force), scene.dt);
    ExpectClose(path.At(t + 1, 0).q, state.q, 1e-13);
  }
}

}  // namespace
}  // namespace pushid
