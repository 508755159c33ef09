// Recordings that cannot be right: pushes against the motion they made, copies, masses, rates.
#include "datasets/inspection/findings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "datasets/files/random.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kBodyMass = 70.0, kDt = 1.0 / 60.0, kStart = 0.5;  // kg, s, s

// Someone of 70 kg who is pushed 0.5 s after frame 0 by a half-sine of 0.2 s and `impulse` N s
// along +x. Who stands is held by a spring and a damper; who steps has a drag at the feet alone.
struct PushedPerson {
  double impulse = 20.0;
  bool stands = false;
  double noise = 0.001;  // m
  double turned = 0.0;   // rad, of what the push's file says
  double scale = 1.0;    // of that
  double late = 0.0;     // s, of that
  double rest = 0.0;     // N, added to every row of it
  double again = 0.0;    // N s, of a second push 1.5 s after the first
  int frames = 120;
  PushKind kind = PushKind::kExternal;
};

double ForceAt(const PushedPerson& how, double t) {
  const bool second = t > kStart + 1.0;
  const double phase = (t - kStart - (second ? 1.5 : 0.0)) / 0.2;
  const double impulse = second ? how.again : how.impulse;
  return phase > 0.0 && phase < 1.0 ? impulse * M_PI / 0.4 * std::sin(M_PI * phase) : 0.0;
}

PendulumRecording Make(const PushedPerson& how, uint64_t seed = 1) {
  Random random(seed);
  PendulumRecording r;
  r.id = "a";
  r.subject_ids = {"anna"};
  r.scene.dt = kDt;
  r.scene.people.resize(1);
  r.scene.people[0].body = {kBodyMass, 0.9, 0.1};
  r.hip.resize(1);
  r.states.resize(1);
  r.weight.resize(1);
  double x = 0.0, v = 0.0;
  std::vector<Vector4<double>> rows;
  for (int t = 0; t < how.frames; ++t) {
    const auto noise = [&] { return how.noise * random.Normal(); };
    r.hip[0].push_back({x + noise(), noise(), 0.9});
    PendulumState<double> state;
    state.q = {how.stands ? 0.0 : x, 0.0, 0.0, 0.0};
    state.qd.setZero();
    r.states[0].push_back(state);
    const double said = how.scale * ForceAt(how, (t + 0.5) * kDt - how.late) + how.rest;
    const Eigen::Vector2d row = said * Eigen::Vector2d(std::cos(how.turned), std::sin(how.turned));
    rows.push_back({row.x(), row.y(), 0.9 * row.x(), -0.9 * row.y()});  // at the hip
    const int steps = 20;
    for (int k = 0; k < steps; ++k) {
      const double held = how.stands ? 8.0 * x + 1.5 * v : 0.5 * v;
      v += kDt / steps * (ForceAt(how, (t + (k + 0.5) / steps) * kDt) / kBodyMass - held);
      x += kDt / steps * v;
    }
  }
  while (rows.size() > 1 && rows.back().isZero()) rows.pop_back();
  r.scene.pushes = {MakeScenePush(0, 0, how.kind, rows)};
  return r;
}

std::vector<FindingKind> KindsOf(const PendulumRecording& recording) {
  std::vector<FindingKind> kinds;
  for (const Finding& finding : FindingsOf(recording)) kinds.push_back(finding.kind);
  return kinds;
}

using Kinds = std::vector<FindingKind>;

TEST(PushAndMotion, AWorkedCase) {
  PushedPerson how;
  how.noise = 0.0;
  const std::optional<PushAndMotion> found = ComparePush(Make(how), 0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->speed, 20.0 / 70.0, 1e-3);
  EXPECT_NEAR(found->gain, 0.93, 0.05);  // what the drag leaves of it
  EXPECT_NEAR(*found->angle, 0.0, 1e-9);
  EXPECT_EQ(found->push_late, 0.0);
  EXPECT_EQ(found->push_early, 0.0);
}

TEST(Findings, NothingIsWrongWithARightPush) {
  int told = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    for (bool stands : {false, true}) {
      PushedPerson how;
      how.stands = stands;
      how.noise = 0.001 * static_cast<double>(1 + seed % 8);
      told += KindsOf(Make(how, seed)).empty() ? 0 : 1;
    }
  }
  EXPECT_LE(told, 2);  // of 80
}

// Each fault, for people who step and for those who stand.
TEST(Findings, FaultsOfAPushAreTold) {
  for (bool stands : {false, true}) {
    PushedPerson how;
    how.stands = stands;
    const auto kinds = [&how](const std::function<void(PushedPerson*)>& fault) {
      PushedPerson wrong = how;
      fault(&wrong);
      return KindsOf(Make(wrong));
    };
    EXPECT_EQ(kinds([](PushedPerson*) {}), Kinds{}) << stands;
    EXPECT_EQ(kinds([](PushedPerson* p) { p->scale = -1.0; }), Kinds{FindingKind::kAgainst})
        << stands;
    EXPECT_EQ(kinds([](PushedPerson* p) { p->turned = M_PI / 2; }), Kinds{FindingKind::kAside})
        << stands;
    EXPECT_EQ(kinds([](PushedPerson* p) { p->scale = 1e-3; }), Kinds{FindingKind::kGain}) << stands;
    EXPECT_EQ(kinds([](PushedPerson* p) { p->scale = 1.0 / 9.81; }), Kinds{FindingKind::kGain});
    EXPECT_EQ(kinds([](PushedPerson* p) { p->scale = 1000.0; }), Kinds{FindingKind::kGain});
    EXPECT_EQ(kinds([](PushedPerson* p) { p->late = 0.3; }), Kinds{FindingKind::kLate}) << stands;
    EXPECT_EQ(kinds([](PushedPerson* p) { p->rest = 6.0; }), Kinds{FindingKind::kZero}) << stands;
  }
  PushedPerson early;
  early.late = -0.3;
  EXPECT_EQ(KindsOf(Make(early)), Kinds{FindingKind::kEarly});
}

TEST(Findings, ValuesAreWhatIsWrong) {
  PushedPerson how;
  how.scale = 1e-3;
  EXPECT_NEAR(FindingsOf(Make(how))[0].value, 930.0, 50.0);
  how.scale = 1.0;
  how.late = 0.3;
  EXPECT_NEAR(FindingsOf(Make(how))[0].value, 0.2, 0.08);  // the onset is seen a little later
  how.late = 0.0;
  how.rest = 6.0;
  EXPECT_NEAR(FindingsOf(Make(how))[0].value, 6.0, 1e-9);
}

TEST(Findings, APushWithoutAnEnd) {
  PendulumRecording recording = Make({});
  std::vector<Vector4<double>> rows = recording.scene.pushes[0].force;
  rows.resize(rows.size() - 6);  // in the middle of the half-sine
  recording.scene.pushes = {MakeScenePush(0, 0, PushKind::kExternal, rows)};
  EXPECT_EQ(KindsOf(recording), Kinds{FindingKind::kNoEnd});
  // One that starts at once may stop at once.
  std::fill(rows.begin(), rows.end(), rows.back());
  EXPECT_FALSE(HasNoEnd(MakeScenePush(0, 0, PushKind::kExternal, rows), 120));
  EXPECT_TRUE(
      HasNoEnd(MakeScenePush(0, 0, PushKind::kExternal, rows), static_cast<int>(rows.size())));
}

// A half-sine of 0.2 s, cut at 70 % of its peak of 157 N; smooth pushes in steps of 1 N, and a
// force that is held, have flat tops as well.
TEST(Findings, ASensorThatIsClipped) {
  PendulumRecording recording = Make({});
  std::vector<Vector4<double>> rows = recording.scene.pushes[0].force, slow, held;
  const double limit = 0.7 * 157.0;
  for (Vector4<double>& row : rows) row *= std::min(1.0, limit / std::max(1e-9, row[0]));
  recording.scene.pushes = {MakeScenePush(0, 0, PushKind::kExternal, rows)};
  const std::vector<Finding> found = FindingsOf(recording);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, FindingKind::kClipped);
  EXPECT_NEAR(found[0].value, limit, 1e-9);
  for (int t = 0; t <= 60; ++t) {
    slow.push_back({std::round(100.0 * std::sin(M_PI * t / 60.0)), 0.0, 0.0, 0.0});
    held.push_back({std::min({20.0 * t, 100.0, 20.0 * (60 - t)}), 0.0, 0.0, 0.0});
  }
  EXPECT_FALSE(IsClipped(MakeScenePush(0, 0, PushKind::kExternal, slow)));
  EXPECT_FALSE(IsClipped(MakeScenePush(0, 0, PushKind::kExternal, held)));
}

// A motor pushes the cart, and the pole lags behind: its end goes back at first.
TEST(Findings, ACartThatIsPushedIsLookedAtItself) {
  PendulumRecording recording = Make({});
  for (int t = 0; t < recording.num_frames(); ++t) {
    recording.states[0][t].q[0] = recording.hip[0][t].x();
    recording.hip[0][t].x() *= -1.0;
  }
  EXPECT_EQ(KindsOf(recording), Kinds{FindingKind::kAgainst});
  std::vector<Vector4<double>> rows = recording.scene.pushes[0].force;
  for (Vector4<double>& row : rows) row.tail<2>().setZero();
  recording.scene.pushes = {MakeScenePush(0, 0, PushKind::kExternal, rows)};
  EXPECT_EQ(KindsOf(recording), Kinds{});
}

TEST(Findings, OnGroundThatMovesNoPushIsJudged) {
  PushedPerson how;
  how.scale = -1.0;
  PendulumRecording recording = Make(how);
  EXPECT_EQ(KindsOf(recording), Kinds{FindingKind::kAgainst});
  recording.scene.ground = GroundThrough(std::vector<GroundPose>(120, GroundPose::Zero()), kDt);
  EXPECT_FALSE(ComparePush(recording, 0));
}

// A net push is the beginning of one, and what it reads while it lasts is the motion's.
TEST(Findings, NetPushes) {
  PushedPerson how;
  how.kind = PushKind::kNet;
  EXPECT_EQ(KindsOf(Make(how)), Kinds{});
  how.scale = 0.05;
  EXPECT_EQ(KindsOf(Make(how)), Kinds{FindingKind::kNetGain});
}

// A robot's log is one record of many pushes, whose impulses may cancel.
TEST(Findings, OfARecordWithSeveralPushesTheFirstIsJudged) {
  PushedPerson how;
  how.frames = 240;
  for (double again : {-20.0, -18.0, 20.0}) {
    how.again = again;
    for (bool stands : {false, true}) {
      how.stands = stands;
      EXPECT_EQ(KindsOf(Make(how)), Kinds{}) << again;
    }
  }
  how.stands = false;
  how.scale = 1000.0;
  EXPECT_EQ(KindsOf(Make(how)), Kinds{FindingKind::kGain});
}

TEST(Findings, WhatIsNotSeenIsNotJudged) {
  PushedPerson how;
  how.scale = -1.0;
  PendulumRecording recording = Make(how);
  recording.weight[0].assign(recording.num_frames(), 1.0);
  recording.weight[0][40] = 0.0;
  EXPECT_FALSE(ComparePush(recording, 0));
  EXPECT_EQ(KindsOf(recording), Kinds{});
  recording.scene.pushes.clear();
  EXPECT_FALSE(ComparePush(recording, 0));
}

TEST(Findings, Bodies) {
  PendulumRecording recording = Make({});
  Body& body = recording.scene.people[0].body;
  recording.scene.pushes.clear();
  for (double kg : {18.0, 140.0, 70000.0}) {
    body.mass = kg;
    EXPECT_EQ(KindsOf(recording), Kinds{FindingKind::kMass}) << kg;
  }
  for (double kg : {45.0, 110.0}) {
    body.mass = kg;
    EXPECT_EQ(KindsOf(recording), Kinds{}) << kg;
  }
  body.mass = kBodyMass;
  body.rod_length = 9.0;
  EXPECT_EQ(KindsOf(recording), Kinds{FindingKind::kRod});
  body.rod_length = 0.9;
  recording.hip[0][7].x() += 3.0;
  EXPECT_EQ(KindsOf(recording), Kinds{FindingKind::kSpeed});
  recording.hip[0][7].x() -= 3.0;
  recording.scene.dt = 1e-5;
  EXPECT_EQ(KindsOf(recording)[0], FindingKind::kRate);
}

TEST(Findings, CopiesNameEachOther) {
  std::vector<PendulumRecording> recordings = {Make({}, 1), Make({}, 2), Make({}, 1), Make({}, 1)};
  recordings[1].id = "b";
  EXPECT_EQ(CopyOf(recordings), (std::vector<int>{-1, -1, -1, -1}));  // a replica's
  recordings[2].id = "c";
  recordings[3].id = "d";
  EXPECT_EQ(CopyOf(recordings), (std::vector<int>{-1, -1, 0, 0}));
  const std::vector<std::string> texts = FindingTexts(FindingsOf(recordings));
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_TRUE(Contains(texts[0], "the same motion is repeated in 1 case (a in c, d)")) << texts[0];
}

TEST(Findings, OneSentenceAKind) {
  std::vector<Finding> findings;
  for (const char* id : {"a", "b", "c", "d", "e"}) {
    findings.push_back({FindingKind::kClipped, id, "", 1650.0});
  }
  findings.push_back({FindingKind::kMass, "a", "anna", 18.0});
  EXPECT_EQ(FindingTexts(findings),
            (std::vector<std::string>{
                "the force rises and then stays at its largest value in 5 cases (a: 1650 N; b: "
                "1650 N; c: 1650 N; d: 1650 N; ...); the sensor's range was exceeded, and the push "
                "was larger: leave these recordings out (--leave_out)",
                "the mass is unusual for the height of the hip in 1 case (a, anna: 18 kg); is "
                "mass_kg right, and in kg?"}));
  EXPECT_TRUE(RowsAreInOrder(Names(FindingKind{})));
}

}  // namespace
}  // namespace pushid
