// The pushes that a model was fitted to, and warnings of predictions beyond them.
#include <gtest/gtest.h>

#include "ident/model/identified_model.h"
#include "ident/model/model_rollout.h"
#include "models/formation.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kMass = 80.0, kRate = 60.0;

// One person, pushed along x for so many frames with so many newtons.
PendulumRecording PushedPerson(const std::string& id, PushKind kind, int frames, double force) {
  PendulumRecording recording;
  recording.id = id;
  recording.labels.Set(kSettingLabel, "single");
  recording.subject_ids = {"a"};
  recording.scene.dt = 1.0 / kRate;
  recording.scene.people.resize(1);
  recording.scene.people[0].body = {kMass, 0.95, 0.0};
  recording.scene.pushes = {
      MakeScenePush(0, 0, kind, std::vector<Vector4<double>>(frames, {force, 0.0, 0.0, 0.0}))};
  return recording;
}

IdentifiedModel Model() {
  IdentifiedModel model;
  model.parameters = PublishedTailParameters();
  return model;
}

TEST(PushRange, HoldsDurationsByKindAndWholeImpulses) {
  const IdentifiedModel model = Model();
  const PendulumRecording measured = PushedPerson("e", PushKind::kExternal, 30, 160.0);
  const PendulumRecording part = PushedPerson("n", PushKind::kNet, 6, 200.0);
  const PushRange range = FittedPushRange(model, {measured, part});
  EXPECT_DOUBLE_EQ(range.external_s.lower, 0.5);
  EXPECT_DOUBLE_EQ(range.external_s.upper, 0.5);
  EXPECT_DOUBLE_EQ(range.net_s.upper, 0.1);
  EXPECT_DOUBLE_EQ(range.impulse_per_mass.upper, 160.0 * 0.5 / kMass);
  EXPECT_NEAR(range.impulse_per_mass.lower,
              WholeImpulse(part.scene.pushes[0], kMass, model.parameters, 1.0 / kRate) / kMass,
              1e-12);
  // 200 N for 0.1 s, and after it a tail of 0.25 s: less than for so long altogether.
  EXPECT_GT(range.impulse_per_mass.lower, 200.0 * 0.1 / kMass);
  EXPECT_LT(range.impulse_per_mass.lower, 200.0 * 0.4 / kMass);
}

TEST(PushRange, WithoutATailThePushIsItsRows) {
  IdentifiedModel model = Model();
  model.options.push_tail = PushTail::kNone;
  const PushRange range = FittedPushRange(model, {PushedPerson("n", PushKind::kNet, 6, 200.0)});
  EXPECT_DOUBLE_EQ(range.impulse_per_mass.upper, 200.0 * 0.1 / kMass);
}

TEST(PushRange, WarnsOfWhatLiesOutsideByMoreThanAQuarter) {
  IdentifiedModel model = Model();
  const std::vector<PendulumRecording> fitted = {PushedPerson("a", PushKind::kExternal, 20, 60.0),
                                                 PushedPerson("b", PushKind::kExternal, 40, 60.0)};
  EXPECT_TRUE(ExtrapolationWarnings(model, fitted).empty());  // a file without a range
  model.push_range = FittedPushRange(model, fitted);
  EXPECT_TRUE(ExtrapolationWarnings(model, fitted).empty());
  EXPECT_TRUE(
      ExtrapolationWarnings(model, {PushedPerson("c", PushKind::kExternal, 48, 60.0)}).empty());
  // A push as long as the others and twice as strong.
  const auto strong =
      ExtrapolationWarnings(model, {PushedPerson("c", PushKind::kExternal, 40, 120.0)});
  ASSERT_EQ(strong.size(), 1u);
  EXPECT_EQ(strong[0],
            "the push's impulse over mass of c is 1 m/s; the model was fitted to 0.25 to 0.5 m/s: "
            "an extrapolation");
  // Weak and long; the farther of two is named.
  const auto late =
      ExtrapolationWarnings(model, {fitted[0], PushedPerson("c", PushKind::kExternal, 60, 30.0),
                                    PushedPerson("d", PushKind::kExternal, 120, 10.0)});
  ASSERT_EQ(late.size(), 1u);
  EXPECT_TRUE(Contains(
      late[0], "duration of d is 2 s (the farthest of 2 such among 3 recordings); the model"))
      << late[0];
  // The rows of a net push are its beginning: their durations do not compare.
  IdentifiedModel no_tail = model;
  no_tail.options.push_tail = PushTail::kNone;
  EXPECT_TRUE(
      ExtrapolationWarnings(no_tail, {PushedPerson("e", PushKind::kNet, 6, 200.0)}).empty());
}

// Where pushes from all sides are not alike, as for feet that step.
TEST(PushRange, WarnsOfPushesFromWhereNoneCame) {
  IdentifiedModel model = Model();
  model.options.directions = Directions::kBody;
  PendulumRecording push = PushedPerson("a", PushKind::kExternal, 20, 60.0);
  model.push_range = FittedPushRange(model, {push});
  EXPECT_TRUE(ExtrapolationWarnings(model, {push}).empty());
  push.scene.pushes[0].mean.head<2>() = Eigen::Vector2d(-50.0, 1e-9);
  const auto warnings = ExtrapolationWarnings(model, {push});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Contains(warnings[0], "a points 180 degrees off forwards")) << warnings[0];
  IdentifiedModel of_backwards = model;
  of_backwards.push_range = FittedPushRange(model, {push});
  model.options.directions = Directions::kIsotropic;
  EXPECT_TRUE(ExtrapolationWarnings(model, {push}).empty());
  push.scene.pushes[0].mean.head<2>() = Eigen::Vector2d(50.0, 0.0);
  const auto reverse = ExtrapolationWarnings(of_backwards, {push});
  ASSERT_EQ(reverse.size(), 1u);
  EXPECT_TRUE(
      Contains(reverse[0], "a points 0 degrees off forwards; the model was fitted to 180 to"))
      << reverse[0];
}

// A formation takes people and pushes from a fit, and warns beyond them.
TEST(PushRange, HoldsThePeopleAndTheUsualPush) {
  IdentifiedModel model = Model();
  std::vector<PendulumRecording> fitted = {PushedPerson("a", PushKind::kExternal, 20, 60.0),
                                           PushedPerson("b", PushKind::kExternal, 30, 60.0),
                                           PushedPerson("c", PushKind::kNet, 6, 200.0)};
  for (PendulumRecording& recording : fitted) {
    // Facing left, and leaning that way.
    recording.facing = M_PI / 2.0;
    recording.scene.people[0].start.q[3] = -0.05;
    ScenePush& push = recording.scene.pushes[0];
    for (Vector4<double>& row : push.force) row[2] = 1.3 * 0.95 * std::cos(0.05) * row[0];
    push = MakeScenePush(0, 0, push.kind, push.force);
  }
  ScenePerson other = fitted[0].scene.people[0];
  other.body.mass = 60.0;
  other.start.q[1] = 0.5;
  fitted[0].scene.people.push_back(other);
  fitted[0].subject_ids = {"a", "b"};
  model.push_range = FittedPushRange(model, fitted);
  const PushRange& range = *model.push_range;
  ASSERT_EQ(range.people.size(), 2u) << "everybody once";
  EXPECT_EQ(range.people[1].mass, 60.0);
  EXPECT_NEAR(range.people[0].theta, 0.05, 1e-6) << "forwards is x now";
  EXPECT_NEAR(range.people[0].phi, 0.0, 1e-6);
  EXPECT_NEAR(range.spacing.lower, 0.5, 1e-12);
  EXPECT_NEAR(range.height.upper, 1.3, 1e-9);
  ASSERT_TRUE(range.usual);
  EXPECT_EQ(range.usual->kind, PushKind::kExternal);
  EXPECT_DOUBLE_EQ(range.usual->duration, 25.0 / 60.0) << "between both";
  EXPECT_NEAR(range.usual->height, 1.3, 1e-9);
  EXPECT_NEAR(range.usual->impulse, 25.0, 1e-9) << "60 N, between both";
  EXPECT_TRUE(ExtrapolationWarnings(model, fitted).empty());
  PendulumRecording far = fitted[0];
  far.id = "far";
  far.scene.people[1].start.q[1] = 1.0;
  far.scene.people[1].body.mass = 120.0;
  const auto warnings = ExtrapolationWarnings(model, {far});
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0],
            "the mass of a person of far is 120 kg; the model was fitted to 60 to 80 kg: an "
            "extrapolation");
  EXPECT_EQ(warnings[1],
            "the distance to the nearest person of far is 1 m; the model was fitted to 0.5 to 0.5 "
            "m: an extrapolation");
}

// Rows of a net push are all forces, and so hold a lean; a formation's push does the same.
TEST(PushRange, ANetPushHoldsThePosture) {
  PendulumRecording leaning = PushedPerson("n", PushKind::kNet, 6, 0.0);
  leaning.scene.people[0].start.q[2] = 0.06;
  leaning.scene.pushes.clear();
  AddHipPush(0, {1e-6, 0.0, 0.1, 0.0, 0.8, PushKind::kNet}, &leaning.scene);
  const ScenePush& push = leaning.scene.pushes[0];
  const ScenePerson& person = leaning.scene.people[0];
  PendulumState<double> state = person.start;
  EXPECT_LT(Acceleration<double>(person.body, state, push.force[2]).norm(), 1e-4) << "nobody falls";
  leaning.scene.pushes.clear();
  AddHipPush(0, {20.0, 0.0, 0.1, 0.0, 0.8, PushKind::kNet}, &leaning.scene);
  EXPECT_NEAR(FittedPushRange(Model(), {leaning}).usual->height, 0.8, 1e-6);
}

TEST(PushRange, AUnitsOwnTailCounts) {
  IdentifiedModel model = Model();
  model.pool_by = kConditionLabel;
  model.by_unit["m"] = model.parameters;
  model.by_unit["m"][kTailTime] *= 4.0;
  PendulumRecording of_m = PushedPerson("m", PushKind::kNet, 6, 200.0), plain = of_m;
  of_m.labels.Set(kConditionLabel, "m");
  const double longer = FittedPushRange(model, {of_m}).impulse_per_mass.upper;
  EXPECT_GT(longer, 2.0 * FittedPushRange(model, {plain}).impulse_per_mass.upper);
}

}  // namespace
}  // namespace pushid
