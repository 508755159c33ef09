// Scenes side by side: the path and the derivatives of each are those of its own rollout.
#include "residuals/cost_functions/rest_residual.h"
#include "residuals/rollout_residual.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kBegin = 5, kEnd = 90;

// Eleven people, more than have room in a vector: of other bodies, pushes and starts.
std::vector<Scene> Pushed(int people) {
  Random random(77);
  std::vector<Scene> scenes;
  for (int i = 0; i < 11; ++i) {
    scenes.push_back(SettlingScene(60.0 + 4.0 * i, 10.0 + 5.0 * i, people));
    for (int k = 0; k < 4; ++k) scenes.back().people[0].start.qd[k] = random.Uniform(-0.1, 0.1);
    scenes.back().pushes.push_back(RandomPush(0, 20, 5, PushKind::kNet, 60.0, &random));
  }
  return scenes;
}

void ExpectThoseOfRollouts(const std::vector<Scene>& scenes, const ModelOptions& options) {
  const int total = static_cast<int>(scenes.size()), people = scenes[0].num_people();
  const ParameterMap map = EveryParameterMap({});
  const BlockLayout layout(map, std::vector<std::string>(people), false);
  const std::vector<double> shared = SharedBlock(map, RecoveringParameters());
  const double* const blocks[] = {shared.data()};
  SensitivityInputs inputs = RolloutInputs(scenes[0], map, layout, blocks);
  SceneRollouts rollouts(scenes, options, kBegin, kEnd);
  ASSERT_TRUE(rollouts.Roll(inputs.parameters));
  std::vector<int> frames(total, 60);
  frames[1] = 0;
  for (int i = 0; i < total; ++i) {
    RolloutPath<double> path;
    ASSERT_TRUE(Rollout<double>(scenes[i], options, inputs.parameters, InitialVelocities(scenes[i]),
                                kEnd, &path)
                    .ok);
    EXPECT_TRUE(rollouts.StaysInside(i));
    for (int t = kBegin; t < kEnd; ++t) {
      for (int n = 0; n < people; ++n) {
        const PendulumState<double> at = rollouts.At(i, t, n);
        EXPECT_LT((at.q - path.At(t, n).q).norm(), 1e-12) << i << ", " << t;
        EXPECT_LT((at.qd - path.At(t, n).qd).norm(), 1e-12) << i << ", " << t;
      }
    }
  }
  ASSERT_TRUE(rollouts.Differentiate(inputs, layout.num_acting(), frames));
  for (int i = 0; i < total; ++i) {
    inputs.initial_velocity = InitialVelocities(scenes[i]);
    RolloutPath<double> path;
    StateColumns expected;
    ASSERT_TRUE(RolloutWithSensitivities(scenes[i], options, inputs, kEnd, &path, &expected).ok);
    for (int t = kBegin; t < frames[i]; ++t) {
      for (int n = 0; n < people; ++n) {
        RowMajorMatrix at;
        rollouts.DerivativesAt(i, t, n, &at);
        const RowMajorMatrix of_one = expected.At(t, n).leftCols(layout.num_acting());
        EXPECT_LE((at.leftCols(of_one.cols()) - of_one).norm(), 1e-11 * of_one.norm())
            << i << ", " << t;
      }
    }
  }
}

TEST(SceneRollouts, AreThoseOfEachScene) {
  ModelOptions options;
  options.push_tail = PushTail::kExponential;
  ASSERT_TRUE(HasLanes(Pushed(1)[0], options));
  ExpectThoseOfRollouts(Pushed(1), options);
  ExpectThoseOfRollouts(Pushed(2), options);  // without lanes
}

// A person who falls keeps the last state within the domain, and the others their path.
TEST(SceneRollouts, WhoLeavesTheDomainStaysThere) {
  ParameterSet<double> p = RecoveringParameters();
  p[kKpTheta] = 0.0;
  for (int people : {1, 2}) {
    SCOPED_TRACE(people);
    const std::vector<Scene> scenes = {SettlingScene(80.0, 0.0, people),
                                       SettlingScene(80.0, 80.0, people)};
    SceneRollouts rollouts(scenes, {}, 0, kEnd);
    EXPECT_FALSE(rollouts.Roll({p}));
    EXPECT_TRUE(rollouts.StaysInside(0));
    EXPECT_FALSE(rollouts.StaysInside(1));
    RolloutPath<double> path;
    const RolloutStatus status =
        Rollout<double>(scenes[1], {}, {p}, InitialVelocities(scenes[1]), kEnd, &path);
    ASSERT_FALSE(status.ok);
    const Vector4<double> last = path.At(status.frame - 1, 0).q;
    EXPECT_LT((rollouts.At(1, kEnd - 1, 0).q - last).norm(), 1e-12);
    EXPECT_LT((rollouts.At(1, status.frame - 1, 0).q - last).norm(), 1e-12);
    EXPECT_EQ(rollouts.At(0, kEnd - 1, 0).q[2], 0.0);
  }
}

}  // namespace
}  // namespace pushid
