// Most probable paths of people.
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
