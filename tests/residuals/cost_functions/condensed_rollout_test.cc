// A rollout in few rows: J'J, J'r and cost are those of all rows, by jets.
#include "residuals/cost_functions/condensed_rollout.h"

#include <Eigen/Core>

#include "residuals/jets/autodiff_rollout.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kCondensedFrames = 30;

// Two people of two subjects, who differ in two parameters.
struct CondensedSample {
  PendulumRecording recording;
  std::shared_ptr<const RolloutProblem> problem;
  ParameterBlocks blocks;

  explicit CondensedSample(double robust) {
    Random random(46);
    Scene scene = SceneOfPeople(2, 0.1, &random);
    scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, 150.0, &random),
                    RandomPush(1, 2, 5, PushKind::kExternal, 100.0, &random)};
    ModelOptions options;
    options.interaction.spring = options.interaction.damping = true;
    recording =
        RecordRollout(scene, options, std::vector(2, RecoveringParameters()), kCondensedFrames);
    AddNoise(0.05, &random, &recording);
    recording.initial_velocity = InitialVelocity::kFree;
    recording.subject_ids = {"anna", "bert"};
    ParameterMap map = EveryParameterMap({kMu, kKpTheta});
    ResidualSigmas sigmas;
    sigmas.robust = robust;
    problem = MakeRolloutProblem(recording, options, map, sigmas, 0.7, 0);
    blocks = RandomBlocks(map, problem->layout, RecoveringParameters(), 0.1, 0.1, &random);
  }
};

// All blocks side by side.
Eigen::MatrixXd AllBlocks(const CostEvaluation& evaluation) {
  Eigen::MatrixXd all(evaluation.residuals.size(), 0);
  for (const auto& block : evaluation.jacobians) {
    all.conservativeResize(Eigen::NoChange, all.cols() + block.cols());
    all.rightCols(block.cols()) = block;
  }
  return all;
}

void ExpectClose(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                 const Eigen::VectorXd& row_scale, const Eigen::VectorXd& column_scale) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      EXPECT_NEAR(a(i, j), b(i, j), 1e-12 * row_scale[i] * column_scale[j]) << i << ", " << j;
    }
  }
}

void ExpectSameEquations(const Eigen::MatrixXd& j, const Eigen::VectorXd& r,
                         const Eigen::MatrixXd& jc, const Eigen::VectorXd& rc) {
  const Eigen::VectorXd length = j.colwise().norm().transpose();
  ExpectClose(jc.transpose() * jc, j.transpose() * j, length, length);
  const Eigen::VectorXd size = Eigen::VectorXd::Constant(1, r.norm());
  ExpectClose(jc.transpose() * rc, j.transpose() * r, length, size);
  EXPECT_NEAR(rc.norm(), r.norm(), 1e-12 * r.norm());
}

TEST(CondensedRollout, HasTheEquationsOfAllRows) {
  for (double robust : {0.0, 0.5}) {
    const CondensedSample s(robust);
    const std::vector<bool> all(s.blocks.size(), true);
    const CostEvaluation rows = EvaluateCost(AutoDiffRollout(s.problem), s.blocks, all);
    ASSERT_TRUE(rows.ok);
    const CostEvaluation condensed = EvaluateCost(CondensedRollout(s.problem), s.blocks, all);
    ASSERT_TRUE(condensed.ok);
    EXPECT_EQ(condensed.residuals.size(), s.problem->layout.num_acting() + 1);
    ExpectSameEquations(AllBlocks(rows), rows.residuals, AllBlocks(condensed), condensed.residuals);
  }
}

TEST(CondensedRollout, KeepsTheCostWithoutDerivatives) {
  const CondensedSample s(0.5);
  const CostEvaluation rows = EvaluateCost(AutoDiffRollout(s.problem), s.blocks, {});
  const CostEvaluation condensed = EvaluateCost(CondensedRollout(s.problem), s.blocks, {});
  ASSERT_TRUE(rows.ok && condensed.ok);
  EXPECT_NEAR(condensed.residuals.norm(), rows.residuals.norm(), 1e-13 * rows.residuals.norm());
}

// The rows of each person, taken from all rows; those of the robust loss corrected frame by frame.
TEST(CondensedRollout, PeopleKeepTheirOwnEquations) {
  CondensedSample s(0.5);
  const CostEvaluation rows =
      EvaluateCost(AutoDiffRollout(s.problem), s.blocks, std::vector<bool>(s.blocks.size(), true));
  const Eigen::MatrixXd jacobian = AllBlocks(rows);
  std::vector<double*> blocks;
  for (auto& block : s.blocks) blocks.push_back(block.data());
  const auto sums = SumUp({}, {{s.problem, blocks}}, LaneSums::kRobust, true);
  const std::vector<PersonRows> people = CondensedRollout(s.problem).RowsOf(sums[0]);
  ASSERT_EQ(people.size(), 2u);
  for (int n = 0; n < 2; ++n) {
    const Eigen::Index own = (kCondensedFrames - 1) * kFrameResiduals;
    Eigen::MatrixXd j(own, jacobian.cols()), corrected(own, jacobian.cols());
    Eigen::VectorXd r(own);
    for (int t = 0; t + 1 < kCondensedFrames; ++t) {
      const Eigen::Index to = t * kFrameResiduals, from = (2 * t + n) * kFrameResiduals;
      j.middleRows<kFrameResiduals>(to) = jacobian.middleRows<kFrameResiduals>(from);
      r.segment<kFrameResiduals>(to) = rows.residuals.segment<kFrameResiduals>(from);
      corrected.middleRows<kFrameResiduals>(to) = j.middleRows<kFrameResiduals>(to);
      CorrectForRobustLoss(r.segment<kFrameResiduals>(to),
                           s.problem->weight * s.recording.Weight(n, t + 1), 0.5,
                           corrected.middleRows<kFrameResiduals>(to));
    }
    ExpectSameEquations(j, r, people[n].jacobian, people[n].residuals);
    const Eigen::VectorXd length = j.colwise().norm().transpose();
    ExpectClose(people[n].robust_jacobian.transpose() * people[n].robust_jacobian,
                corrected.transpose() * corrected, length, length);
  }
}

}  // namespace
}  // namespace pushid
