// Bodies in the problem: nothing is left where model and restoration made them, the gradient is
// that of finite differences in three regimes and with a rod that moves, and each person has rows
// of their own.
#include "residuals/cost_functions/body_residual.h"

#include <gtest/gtest.h>

#include "models/learned_terms.h"
#include "models/restoration/body_tangent.h"
#include "tests/models/body_samples.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kBodyFrames = 30;

enum class BodyRegime { kStanding, kPushed, kTouching, kRod };

// Two people, whose bodies follow the very rollout that the recording holds, or are off by `noise`.
struct BodySample {
  PendulumRecording recording;
  std::shared_ptr<const RolloutProblem> problem;
  std::shared_ptr<BodyData> data = std::make_shared<BodyData>();
  ParameterBlocks truth, blocks;

  BodySample(BodyRegime regime, double robust, double noise) {
    Random random(61);
    Scene scene = SceneOfPeople(2, 0.05, &random);
    if (regime == BodyRegime::kTouching) scene.people[1].start.q[0] = 0.3;
    ModelOptions options;
    // A rod that moves, by a law of random weights.
    if (regime == BodyRegime::kRod) {
      options = WithNetwork({}, 0.5, &random, RodShape{RodKind::kLinear, {}});
    }
    options.interaction.spring = options.interaction.damping = true;
    if (regime != BodyRegime::kStanding) {
      scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, 150.0, &random)};
    }
    recording = RecordRollout(scene, options, std::vector(2, RecoveringParameters()), kBodyFrames);
    recording.id = "two";
    recording.subject_ids = {"anna", "bert"};
    ResidualSigmas sigmas;
    sigmas.robust = robust;
    std::vector<Parameter> free = {kMu, kKpTheta};
    if (regime == BodyRegime::kRod) free.push_back(kRodLift);
    ParameterMap map = EveryParameterMap(free);
    // Away from the truth the law's weights are fitted too.
    if (regime == BodyRegime::kRod && noise > 0.0) map.num_weights = options.learned->num_weights();
    problem = MakeRolloutProblem(recording, options, map, sigmas, 0.7, 0);
    truth = RandomBlocks(map, problem->layout, RecoveringParameters(), 0.0, 0.0, &random);
    blocks = RandomBlocks(map, problem->layout, RecoveringParameters(), 0.1, 0.1, &random);
    TakeBodies(options, noise, &random);
  }

  void TakeBodies(const ModelOptions& options, double noise, Random* random) {
    const WindowWeights weights = RandomWindow(8);
    data->restoration = std::make_shared<WindowTangent>(weights);
    std::vector<Pose> poses;
    for (int n = 0; n < 2; ++n) {
      const Eigen::Vector3d hip = recording.hip[n][0];
      poses.push_back(Placed(StandingPose(), 0.3 * n, {hip.x(), hip.y(), 0.0}));
    }
    std::vector<RestorationInput> people = PeopleOf(recording.scene, poses);
    for (int n = 0; n < 2; ++n) {
      for (const auto& state : recording.states[n]) {
        people[n].Follow(state, RodMoves(options), RecoveringParameters()[kRodLift]);
      }
    }
    data->motions["two"] = WindowRestoration(weights).Restore(people);
    for (size_t n = 0; n < 2; ++n) {
      BodyMotion& motion = data->motions["two"][n];
      motion[0] = poses[n];  // where a restoration begins
      for (size_t t = 1; t < motion.size(); ++t) {
        for (double& x : motion[t].reshaped()) x += noise * random->Normal();
      }
    }
  }
};

double CostAt(const BodyResidual& residual, const ParameterBlocks& blocks) {
  const CostEvaluation evaluation = EvaluateCost(residual, blocks, {});
  EXPECT_TRUE(evaluation.ok);
  return 0.5 * evaluation.residuals.squaredNorm();
}

TEST(BodyResidual, NothingIsLeftAtTheTruth) {
  for (const BodyRegime regime :
       {BodyRegime::kStanding, BodyRegime::kPushed, BodyRegime::kTouching, BodyRegime::kRod}) {
    const BodySample s(regime, 0.5, 0.0);
    const BodyResidual residual(s.problem, s.data, 2.0);
    EXPECT_EQ(residual.num_rows(), 9 * 2 * 66);
    EXPECT_LT(CostAt(residual, s.truth), 1e-8);
    // Who stands still in their own posture says nothing of gains.
    if (regime != BodyRegime::kStanding) {
      EXPECT_GT(CostAt(residual, s.blocks), 1e-6);
    }
  }
}

TEST(BodyResidual, TheGradientIsThatOfFiniteDifferences) {
  for (const BodyRegime regime :
       {BodyRegime::kStanding, BodyRegime::kPushed, BodyRegime::kTouching, BodyRegime::kRod}) {
    for (const double robust : {0.0, 0.5}) {
      const BodySample s(regime, robust, 0.05);
      const BodyResidual residual(s.problem, s.data, 2.0);
      const CostEvaluation at =
          EvaluateCost(residual, s.blocks, std::vector<bool>(s.blocks.size(), true));
      ASSERT_TRUE(at.ok);
      for (size_t b = 0; b < s.blocks.size(); ++b) {
        const Eigen::VectorXd gradient = at.jacobians[b].transpose() * at.residuals;
        for (Eigen::Index i = 0; i < gradient.size(); ++i) {
          constexpr double kStep = 1e-5;
          ParameterBlocks above = s.blocks, below = s.blocks;
          above[b][i] += kStep, below[b][i] -= kStep;
          const double expected = (CostAt(residual, above) - CostAt(residual, below)) / (2 * kStep);
          EXPECT_NEAR(gradient[i], expected, 1e-5 * (1.0 + gradient.cwiseAbs().maxCoeff()))
              << "regime " << static_cast<int>(regime) << ", robust " << robust << ", block " << b
              << ", " << i;
        }
      }
    }
  }
}

TEST(BodyResidual, PeopleHaveRowsOfTheirOwnAndTheWeightIsOnSquares) {
  const BodySample s(BodyRegime::kTouching, 0.5, 0.05);
  const BodyResidual once(s.problem, s.data, 1.0), thrice(s.problem, s.data, 3.0);
  EXPECT_NEAR(CostAt(thrice, s.blocks), 3.0 * CostAt(once, s.blocks), 1e-9);
  std::vector<const double*> pointers;
  for (const auto& block : s.blocks) pointers.push_back(block.data());
  std::vector<CondensedRows::PersonRows> people;
  ASSERT_TRUE(once.EvaluatePeople(pointers.data(), true, &people));
  ASSERT_EQ(people.size(), 2u);
  double squares = 0.0;
  for (const auto& person : people) {
    EXPECT_GT(person.residuals.norm(), 0.0);
    EXPECT_EQ(person.robust_jacobian.cols(), person.jacobian.cols());
    squares += person.residuals.squaredNorm();
  }
  EXPECT_NEAR(0.5 * squares, CostAt(once, s.blocks), 1e-9);
}

}  // namespace
}  // namespace pushid
