// Most probable paths of people, and recordings smoothed.
#include "ident/forecasts/most_probable_path.h"

#include <gtest/gtest.h>

#include "models/rollout.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

IdentifiedModel NoisyModel() {
  IdentifiedModel model;
  model.source = "model.json";
  model.table = BaseTable();
  model.parameters = PublishedTailParameters();
  model.options.process_noise = ProcessNoise::kDiagonal;
  model.parameters[kSigmaX] = 15.0, model.parameters[kSigmaY] = 12.0;
  model.parameters[kSigmaTheta] = 8.0, model.parameters[kSigmaPhi] = 6.0;
  model.parameters[kMeasuredCart] = model.parameters[kMeasuredHip] = 0.002;
  return model;
}

PathEnd EndAt(const std::string& text) { return ParsePathEnd("--to", text, true).value(); }

// Where the model itself goes costs next to nothing; further away costs more and more.
TEST(PathBetween, WhereTheModelGoesIsMostProbable) {
  const IdentifiedModel model = NoisyModel();
  const Body body{80.0, 0.95, 0.0};
  Scene scene;
  scene.people.push_back({body, {}});
  constexpr int kFrames = 60;
  const PathEnd from = EndAt("xd=0.4,theta=0.03");
  scene.people[0].start = from.state;
  RolloutPath<double> path;
  ModelOptions upright = model.options;
  upright.posture = Posture::kUpright;  // as the path's people stand
  ASSERT_TRUE(
      Rollout<double>(scene, upright, {model.parameters}, {from.state.qd}, kFrames, &path).ok);
  PathEnd to;
  to.state = path.At(kFrames - 1, 0);
  double before = -HUGE_VAL;
  for (double further : {0.0, 0.2, 0.4}) {
    PathEnd end = to;
    end.state.q[0] += further;
    const auto found = Unwrapped(PathBetween(model, body, 60.0, from, end, kFrames));
    if (further == 0.0) {
      EXPECT_LT(found.noise_action, 1.0);
    }
    if (further == 0.4) {
      EXPECT_GT(found.noise_action, 1.0);
    }
    EXPECT_GT(found.action(), before);
    before = found.action();
    EXPECT_EQ(found.states.At(0, 0).q, from.state.q);
    EXPECT_EQ(found.states.At(kFrames - 1, 0).q, end.state.q);
  }
}

TEST(PathBetween, AVelocityThatIsNotNamedIsFree) {
  const IdentifiedModel model = NoisyModel();
  const Body body{80.0, 0.95, 0.0};
  const auto free = ParsePathEnd("--to", "x=0.5", false),
             held = ParsePathEnd("--to", "x=0.5,xd=0", false);
  ASSERT_TRUE(free.ok() && held.ok());
  EXPECT_FALSE(free.value().rates_held);
  EXPECT_TRUE(held.value().rates_held);
  const auto one = PathBetween(model, body, 60.0, EndAt(""), free.value(), 40);
  const auto other = PathBetween(model, body, 60.0, EndAt(""), held.value(), 40);
  ASSERT_TRUE(one.ok() && other.ok());
  EXPECT_LT(one.value().action(), other.value().action());
}

// A gap is filled nearer to the truth than a straight line does, and noise becomes less.
TEST(SmoothPath, FillsGapsAndTakesNoiseAway) {
  SyntheticOptions study = TinyStudy();
  study.joint_noise_m = 0.004;
  study.noise_at_first_frame = false;
  const auto made = Unwrapped(MakeSyntheticRecordings(study));
  PendulumRecording recording = MakePendulumRecording(made[0].recording);
  const RolloutPath<double>& truth = made[0].path;
  constexpr int kFirst = 18, kLast = 30;
  recording.weight = {std::vector<double>(recording.num_frames(), 1.0)};
  for (int t = kFirst; t < kLast; ++t) recording.weight[0][t] = 0.0;
  IdentifiedModel model = NoisyModel();
  for (int id = 0; id < kFirstNoiseParameter; ++id) model.parameters[id] = study.parameters[id];
  for (int id = kSigmaX; id <= kSigmaPhi; ++id) model.parameters[id] = 0.5;
  model.options = study.model;
  model.options.process_noise = ProcessNoise::kDiagonal;
  model.parameters[kMeasuredCart] = 0.003, model.parameters[kMeasuredHip] = 0.004;
  const auto smoothed = Unwrapped(SmoothPath(model, recording));
  double found = 0.0, line = 0.0, kept = 0.0, measured = 0.0;
  const Vector4<double>& a = recording.states[0][kFirst - 1].q;
  const Vector4<double>& b = recording.states[0][kLast].q;
  for (int t = 1; t < recording.num_frames(); ++t) {
    const Vector4<double> apart = smoothed.states.At(t, 0).q - truth.At(t, 0).q;
    if (recording.Weight(0, t) > 0.0) {
      kept += apart.squaredNorm();
      measured += (recording.states[0][t].q - truth.At(t, 0).q).squaredNorm();
    } else {
      const double share = (t - kFirst + 1.0) / (kLast - kFirst + 1.0);
      found += apart.squaredNorm();
      line += ((1.0 - share) * a + share * b - truth.At(t, 0).q).squaredNorm();
    }
  }
  EXPECT_LT(found, 0.3 * line);
  EXPECT_LT(kept, 0.5 * measured);
}

TEST(PathBetween, BadEndsAndModels) {
  const IdentifiedModel model = NoisyModel();
  const Body body{80.0, 0.95, 0.0};
  const auto says = [&](const IdentifiedModel& m, const PathEnd& to, int frames,
                        const std::string& what) {
    const std::string path = ProblemOf(PathBetween(m, body, 60.0, EndAt(""), to, frames));
    EXPECT_TRUE(Contains(path, what));
  };
  says(model, EndAt("theta=1.5"), 30, "theta");
  says(model, EndAt("x=0.1"), 4, "--frames");
  IdentifiedModel other = model;
  other.options.process_noise = ProcessNoise::kNone;
  says(other, EndAt("x=0.1"), 30, "no process noise");
  other = model;
  other.parameters[kSigmaY] = 0.0;
  says(other, EndAt("x=0.1"), 30, "sigma_y");
  EXPECT_FALSE(ParsePathEnd("--to", "z=1", false).ok());
}

}  // namespace
}  // namespace pushid
