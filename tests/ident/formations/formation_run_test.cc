// A push through a formation: forces that are those of the rollout, onsets in order, outcomes.
#include "ident/formations/formation_run.h"

#include <gtest/gtest.h>

#include "ident/formations/formation_files.h"
#include "tests/ident/formation_samples.h"

namespace pushid {
namespace {

constexpr int kRunFrames = 300;

// Not Contains of test_support.h, which would print the whole picture.
bool Has(const std::string& svg, const std::string& part) {
  return svg.find(part) != std::string::npos;
}

FormationRun RunShape(FormationShape shape, int people, const std::vector<int>& pushed) {
  return RunFormation(ContactModel(), SampleFormation(shape, people, pushed), kRunFrames);
}

TEST(FormationRun, ForcesAreThoseThatMovePeople) {
  const FormationRun run = RunShape(FormationShape::kDiamond, 13, {0, 1, 3});
  ASSERT_TRUE(run.prediction.status.ok);
  const double dt = run.recording.scene.dt;
  for (int n = 0; n < run.num_people(); ++n) {
    for (int t = 0; t + 1 < kRunFrames; ++t) {
      const PendulumState<double>& state = run.prediction.path.At(t, n);
      const Vector4<double> qdd = (run.prediction.path.At(t + 1, n).qd - state.qd) / dt;
      const Vector4<double> needed =
          InverseDynamics(run.recording.scene.people[n].body, state, qdd);
      ASSERT_LT((needed - run.Force(n, t).Total()).norm(), 1e-8) << "person " << n << ", " << t;
    }
  }
}

TEST(FormationRun, ContactPassesMomentumOnAndMakesNone) {
  const FormationRun run = RunShape(FormationShape::kGrid, 6, {0, 1});
  double passed = 0.0;
  for (int t = 0; t < kRunFrames; ++t) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int n = 0; n < run.num_people(); ++n)
      sum += run.Force(n, t)[ForcePart::kInteraction].head<2>();
    EXPECT_LT(sum.norm(), 1e-9);
    passed += run.Force(4, t)[ForcePart::kInteraction][0] * run.recording.scene.dt;
  }
  EXPECT_GT(passed, 1.0);  // N s
}

TEST(FormationRun, ALineStartsToMoveOneAfterAnother) {
  const FormationRun run = RunShape(FormationShape::kLine, 6, {0});
  for (int n = 0; n < 6; ++n) {
    const PersonSummary& person = run.summaries[n];
    ASSERT_GE(person.onset_frame, 0) << n;
    EXPECT_GT(person.peak_speed, 0.02) << n;
    const int before = n > 0 ? run.summaries[n - 1].onset_frame : 0;
    EXPECT_GT(person.onset_frame, before) << n;
    EXPECT_NE(person.outcome, Outcome::kFell) << n;
  }
  // No person moves before the push could have arrived.
  EXPECT_EQ(HipSpeed(run, 5, run.summaries[0].onset_frame), 0.0);
  // The person who is pushed goes forwards, and back after bumping into the next one.
  EXPECT_GT(HipSpeed(run, 0, run.summaries[0].onset_frame), 0.0);
}

TEST(FormationRun, ADiamondMovesAlikeOnBothSides) {
  const FormationRun run = RunShape(FormationShape::kDiamond, 13, {0, 1, 3});
  for (const auto& [right, left] : {std::pair(1, 3), {4, 8}, {5, 7}, {9, 11}}) {
    const Vector3<double>& a = run.prediction.hip[right].back();
    const Vector3<double>& b = run.prediction.hip[left].back();
    EXPECT_NEAR(a.x(), b.x(), 1e-9);
    EXPECT_NEAR(a.y(), -b.y(), 1e-9);
    EXPECT_EQ(run.summaries[right].onset_frame, run.summaries[left].onset_frame);
  }
}

TEST(FormationRun, SuccessivePushesActOneByOne) {
  const Scene scene = SampleFormation(FormationShape::kLine, 4, {0},
                                      {{40.0, 0.0, 0.2}, {40.0, 1.0, 0.2}, {40.0, 2.0, 0.2}});
  const FormationRun run = RunFormation(ContactModel(), scene, kRunFrames);
  for (int t = 0; t < kRunFrames; ++t) {
    const bool pushed = t % 60 < 12 && t < 180;
    EXPECT_EQ(run.Force(0, t)[ForcePart::kPush][0] > 0.0, pushed) << t;
    EXPECT_EQ(run.Force(1, t)[ForcePart::kPush].norm(), 0.0);
  }
  EXPECT_EQ(run.summaries[0].outcome, Outcome::kSettled);
}

TEST(FormationRun, OutcomesAreNamed) {
  const Scene gentle = SampleFormation(FormationShape::kLine, 1, {0}, {{8.0, 0.0, 0.2}});
  EXPECT_EQ(RunFormation(ContactModel(), gentle, 60).summaries[0].outcome, Outcome::kNotJudged);
  EXPECT_EQ(RunFormation(ContactModel(), gentle, 200).summaries[0].outcome, Outcome::kSettled);
  const Scene violent = SampleFormation(FormationShape::kLine, 2, {0}, {{2000.0, 0.0, 0.2}});
  const FormationRun left = RunFormation(ContactModel(), violent, kRunFrames);
  EXPECT_FALSE(left.prediction.status.ok);
  EXPECT_TRUE(left.summaries.empty());
}

TEST(FormationRun, WithoutInteractionNobodyElseMoves) {
  IdentifiedModel model = ContactModel();
  model.options.interaction = {};
  const FormationRun run =
      RunFormation(model, SampleFormation(FormationShape::kLine, 3, {0}), kRunFrames);
  EXPECT_EQ(run.summaries[1].onset_frame, -1);
  EXPECT_EQ(run.summaries[1].outcome, Outcome::kUnmoved);
  for (ForcePart part : ActingParts(run)) EXPECT_NE(part, ForcePart::kInteraction);
}

TEST(FormationPictures, ShowEverybody) {
  const FormationRun run = RunShape(FormationShape::kDiamond, 13, {0, 1, 3});
  const std::string wave = WaveSvg(run, "a < b");
  for (const char* part : {"a &lt; b", ">12  (1.68, 0)<", "colour: speed of the hip"}) {
    EXPECT_TRUE(Has(wave, part)) << part;
  }
  EXPECT_FALSE(Has(wave, "nan"));
  EXPECT_FALSE(Has(wave, "inf"));
}

TEST(FormationPictures, ColoursSayWhenTheySaturate) {
  FormationRun run = RunShape(FormationShape::kLine, 2, {0});
  EXPECT_TRUE(Has(WaveSvg(run, "line"), ">full colour: "));
  run.summaries[0].peak_speed = 6.0;  // falls
  EXPECT_TRUE(Has(WaveSvg(run, "line"), ">saturated from 2.5 on; fastest 6<"));
}

TEST(FormationPictures, OnsetsHaveBandsWhereTheModelKnowsItsErrors) {
  const FormationRun run = RunShape(FormationShape::kLine, 2, {0});
  EXPECT_TRUE(BandsOfWave(FittedModel(), "", run).onsets.empty()) << "no covariance, no bootstrap";
  EXPECT_FALSE(Has(WaveSvg(run, "line"), "uncertainty of the parameters"));
  const std::string banded = WaveSvg(run, "line", {{0.1, 0.2, 1.0}, {0.0, 0.0, 0.0}});
  EXPECT_TRUE(Has(banded, "uncertainty of the parameters"));
}

TEST(FormationPictures, NobodyPushedNobodyMoves) {
  const FormationRun run =
      RunFormation(ContactModel(), SampleFormation(FormationShape::kLine, 1, {}), 10);
  EXPECT_FALSE(Has(WaveSvg(run, "still"), "nan"));
}

TEST(FormationPictures, RecoilIsNotDrawnAsTheWave) {
  // The pushed one of a line comes back; alone with as much friction no person does.
  const std::string line = WaveSvg(RunShape(FormationShape::kLine, 3, {0}), "line");
  EXPECT_TRUE(Has(line, " m/s back<"));
  EXPECT_TRUE(Has(line, " m/s forward or aside<"));
  const FormationRun run = RunShape(FormationShape::kLine, 3, {0});
  bool recoils = false;
  for (int t = 1; t < run.num_frames(); ++t) {
    recoils = recoils || run.prediction.hip[0][t].x() < run.prediction.hip[0][t - 1].x();
  }
  EXPECT_TRUE(recoils);
}

}  // namespace
}  // namespace pushid
