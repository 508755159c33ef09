// People side by side: the sums of every recording are those of its rows, at every width of
// vectors and whatever other people are there.
#include <cmath>

#include "residuals/cost_functions/condensed_rollout.h"
#include "residuals/jets/autodiff_rollout.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

ParameterSet<double> WithTailBase() {
  ParameterSet<double> p = RecoveringParameters();
  p[kTailBase] = 0.1;
  return p;
}

struct LaneRegime {
  Posture posture;
  GainScaling scaling;
  FrictionKind friction;
  PushTail tail;
  double robust;
  bool free_velocity;
};

const LaneRegime kRegimes[] = {
    {Posture::kInitial, GainScaling::kBody, FrictionKind::kIsotropic, PushTail::kExponential, 0.5,
     false},
    {Posture::kUpright, GainScaling::kNone, FrictionKind::kAnisotropic, PushTail::kNone, 0.0, true},
    {Posture::kInitial, GainScaling::kMass, FrictionKind::kAnisotropic, PushTail::kExponential, 2.0,
     true}};

// Eleven people of other lengths, steps and pushes each.
struct Crowd {
  std::vector<PendulumRecording> recordings;
  std::vector<std::shared_ptr<const RolloutProblem>> problems;
  std::vector<ParameterBlocks> blocks;
  std::vector<std::vector<const double*>> at;

  explicit Crowd(const LaneRegime& regime) : recordings(11) {
    Random random(612);
    ModelOptions options;
    options.posture = regime.posture;
    options.gain_scaling = regime.scaling;
    options.friction = regime.friction;
    options.push_tail = regime.tail;
    const ParameterMap map = EveryParameterMap({kMu, kKpTheta});
    ResidualSigmas sigmas;
    sigmas.robust = regime.robust;
    constexpr PushKind kKinds[] = {PushKind::kNet, PushKind::kExternal,
                                   PushKind::kNetWithoutFriction};
    for (size_t i = 0; i < recordings.size(); ++i) {
      Scene scene = SceneOfPeople(1, 0.1, &random);
      scene.dt = i % 2 == 0 ? 1.0 / 60.0 : 1.0 / 50.0;
      for (int k = 0; k < 1 + static_cast<int>(i) % 2; ++k) {
        scene.pushes.push_back(
            RandomPush(0, 7 * k, 4 + static_cast<int>(i) % 3, kKinds[i % 3], 90.0, &random));
      }
      recordings[i] =
          RecordRollout(scene, options, {WithTailBase()}, 24 + 3 * static_cast<int>(i % 5));
      AddNoise(0.05, &random, &recordings[i]);
      if (regime.free_velocity) recordings[i].initial_velocity = InitialVelocity::kFree;
      recordings[i].subject_ids = {"subject " + std::to_string(i)};
      problems.push_back(MakeRolloutProblem(recordings[i], options, map, sigmas, 0.5 + 0.1 * i, 0));
      blocks.push_back(RandomBlocks(map, problems[i]->layout, WithTailBase(), 0.1, 0.1, &random));
    }
    for (const ParameterBlocks& of_one : blocks) {
      at.emplace_back();
      for (const auto& block : of_one) at.back().push_back(block.data());
    }
  }

  std::vector<RolloutSums> Sums(int first, int count, const PersonLanes& lanes,
                                LaneSums wanted) const {
    std::vector<const RolloutProblem*> group;
    std::vector<double const* const*> where;
    for (int i = first; i < first + count; ++i) {
      group.push_back(problems[i].get());
      where.push_back(at[i].data());
    }
    return LaneGroup(group, lanes).Evaluate(where, wanted);
  }
};

// The oracle: row by row.
RolloutSums OfRows(const RolloutProblem& problem, double const* const* blocks) {
  const int columns = problem.layout.num_acting();
  RolloutSums sums{true, 0.0, NormalEquations(columns), NormalEquations(columns), {}};
  std::vector<double> residuals;
  RowMajorMatrix rows;
  const SensitivityInputs inputs =
      RolloutInputs(problem.recording->scene, problem.map, problem.layout, blocks);
  sums.ok = RowsByJets(problem, inputs, &residuals, &rows).ok;
  for (int t = 1; sums.ok && t < problem.horizon; ++t) {
    const int row = (t - 1) * kFrameResiduals;
    const Eigen::Map<const FrameVector<double>> r(residuals.data() + row);
    sums.squares += r.squaredNorm();
    RowMajorMatrix of_frame = rows.middleRows<kFrameResiduals>(row);
    sums.plain.Add(kFrameResiduals, of_frame.data(), r.data());
    CorrectForRobustLoss(r, problem.weight * problem.recording->Weight(0, t),
                         problem.sigmas.OfFrames(), of_frame);
    sums.robust.Add(kFrameResiduals, of_frame.data(), r.data());
  }
  return sums;
}

// J'J, J'r and r'r, each on the scale of its columns.
void ExpectSame(const NormalEquations& actual, const NormalEquations& expected) {
  const RowMajorMatrix a = actual.Factor(), e = expected.Factor();
  const RowMajorMatrix of_a = a.transpose() * a, of_e = e.transpose() * e;
  ASSERT_EQ(of_a.rows(), of_e.rows());
  for (Eigen::Index i = 0; i < of_e.rows(); ++i) {
    for (Eigen::Index j = 0; j < of_e.cols(); ++j) {
      const double scale = std::sqrt(of_e(i, i) * of_e(j, j));
      EXPECT_NEAR(of_a(i, j), of_e(i, j), 1e-12 * scale) << i << ", " << j;
    }
  }
}

// J'r, on the scales of J's columns and of r.
TEST(LaneGroup, SumsUpTheRowsOfEveryRecording) {
  for (const LaneRegime& regime : kRegimes) {
    const Crowd crowd(regime);
    for (const PersonLanes* lanes : Supported<PersonLanes>()) {
      SCOPED_TRACE(lanes->bits);
      for (int first = 0; first < 11; first += lanes->lanes) {
        const int count = std::min(lanes->lanes, 11 - first);
        const auto sums = crowd.Sums(first, count, *lanes, LaneSums::kRobust);
        const auto squares = crowd.Sums(first, count, *lanes, LaneSums::kSquares);
        for (int k = 0; k < count; ++k) {
          SCOPED_TRACE(first + k);
          ASSERT_TRUE(HasLanes(*crowd.problems[first + k]));
          const RolloutSums rows = OfRows(*crowd.problems[first + k], crowd.at[first + k].data());
          ASSERT_TRUE(rows.ok);
          ASSERT_TRUE(sums[k].ok);
          EXPECT_NEAR(squares[k].squares, rows.squares, 1e-12 * rows.squares);
          EXPECT_EQ(squares[k].squares, sums[k].squares);
          ExpectSame(sums[k].plain, rows.plain);
          ExpectSame(sums[k].robust, rows.robust);
        }
      }
    }
  }
}

TEST(LaneGroup, TellsResidualsWithoutTheRobustWeight) {
  for (const LaneRegime& regime : kRegimes) {
    const Crowd crowd(regime);
    for (const PersonLanes* lanes : Supported<PersonLanes>()) {
      SCOPED_TRACE(lanes->bits);
      const int count = lanes->lanes;
      const auto told = crowd.Sums(0, count, *lanes, LaneSums::kNone);
      for (int k = 0; k < count; ++k) {
        RolloutProblem plain = *crowd.problems[k];
        plain.sigmas.robust = 0.0;
        std::vector<double> expected(plain.num_residuals());
        ASSERT_TRUE(RolloutResiduals(plain, crowd.at[k].data(), expected.data()));
        ASSERT_EQ(told[k].residuals.size(), expected.size());
        for (size_t i = 0; i < expected.size(); ++i) {
          EXPECT_NEAR(told[k].residuals[i], expected[i], 1e-11) << k << ", " << i;
        }
      }
    }
  }
}

TEST(LaneGroup, WhoElseIsThereChangesNoBit) {
  const Crowd crowd(kRegimes[0]);
  const int most = Widest<PersonLanes>().lanes;
  const auto together = crowd.Sums(0, most, Widest<PersonLanes>(), LaneSums::kPlain);
  for (int i = 0; i < most; ++i) {
    const RolloutSums alone = crowd.Sums(i, 1, Widest<PersonLanes>(), LaneSums::kPlain)[0];
    EXPECT_EQ(alone.squares, together[i].squares);
    EXPECT_EQ(alone.plain.Factor(), together[i].plain.Factor());
  }
}

TEST(LaneGroup, NamesWhoLeavesTheDomainAndKeepsTheOthers) {
  Crowd crowd(kRegimes[0]);
  const auto before = crowd.Sums(0, 2, Widest<PersonLanes>(), LaneSums::kPlain);
  // No balance left, and pushed the other way by the lean.
  for (double& value : crowd.blocks[0][0]) value *= -3.0;
  crowd.blocks[0][0][kKpTheta] = -20.0;
  ASSERT_FALSE(OfRows(*crowd.problems[0], crowd.at[0].data()).ok);
  const auto after = crowd.Sums(0, 2, Widest<PersonLanes>(), LaneSums::kPlain);
  EXPECT_FALSE(after[0].ok);
  ASSERT_TRUE(after[1].ok);
  EXPECT_EQ(after[1].plain.Factor(), before[1].plain.Factor());
}

TEST(LaneGroup, HasNoPlaceForWhatItsLoopsDoNotKnow) {
  const Crowd crowd(kRegimes[0]);
  RolloutProblem problem = *crowd.problems[0];
  EXPECT_TRUE(HasLanes(problem));
  problem.options.stance = Stance::kSteps;
  EXPECT_FALSE(HasLanes(problem));
  problem = *crowd.problems[0];
  problem.options.cart_derivative = CartDerivative::kBackward;
  EXPECT_FALSE(HasLanes(problem));
  problem = *crowd.problems[0];
  problem.sigmas = kLdpSigmas;
  EXPECT_FALSE(HasLanes(problem));
  problem = *crowd.problems[0];
  PendulumRecording two = crowd.recordings[0];
  two.scene.people.push_back(two.scene.people[0]);
  problem.recording = &two;
  EXPECT_FALSE(HasLanes(problem));
}

}  // namespace
}  // namespace pushid
