// A recording's likelihood: its Jacobian against numeric differentiation, its rows against the
// densities, people apart against people together.
#include "residuals/cost_functions/likelihood_residual.h"

#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kLikelihoodFrames = 12;

ParameterSet<double> NoisyParameters(Random* random, double spread) {
  ParameterSet<double> p = RandomRecoveringParameters(random, spread);
  p[kSigmaX] = 20.0, p[kSigmaY] = 15.0, p[kSigmaTheta] = 12.0, p[kSigmaPhi] = 9.0;
  p[kMeasuredCart] = 0.003, p[kMeasuredHip] = 0.004;
  return p;
}

// What a likelihood can fit, the noise included.
ParameterMap LikelihoodMap(const std::vector<Parameter>& pooled) {
  ParameterMap all = EveryParameterMap(pooled), map = all;
  map.fitted.clear();
  for (FittedParameter f : all.fitted) {
    const bool own = f.parameter >= kFirstOwnParameter;
    if (IsNoiseParameter(f.parameter)) f.transform = Transform::kLog;
    if (!own && f.parameter != kKdX && f.parameter != kKdY) map.fitted.push_back(f);
  }
  return map;
}

PendulumRecording Measured(int people, const ModelOptions& options, double push, double noise,
                           Random* random) {
  Scene scene = SceneOfPeople(people, 0.05, random);
  for (int n = 0; n < people; ++n) scene.people[n].start.q[0] = 0.45 * n;
  scene.pushes = {RandomPush(0, 0, 3, PushKind::kNet, push, random),
                  RandomPush(people - 1, 2, 5, PushKind::kExternal, push, random)};
  PendulumRecording recording =
      RecordRollout(scene, options, std::vector(people, RecoveringParameters()), kLikelihoodFrames);
  AddNoise(noise, random, &recording);
  return recording;
}

ModelOptions ModelOf(bool contact) {
  ModelOptions options;
  options.interaction.spring = options.interaction.damping = contact;
  options.process_noise = ProcessNoise::kDiagonal;
  return options;
}

struct LikelihoodRegime {
  std::string name;
  double push, noise, spread, deviation;
};
std::ostream& operator<<(std::ostream& out, const LikelihoodRegime& regime) {
  return out << regime.name;
}

class LikelihoodTwins : public testing::TestWithParam<LikelihoodRegime> {};

// Jacobians of transitions are exact, those of filters differences.
TEST_P(LikelihoodTwins, JacobiansEqualNumericDifferentiation) {
  const LikelihoodRegime& regime = GetParam();
  Random random(7);
  const ParameterMap map = LikelihoodMap({kMu, kKpTheta, kSigmaX});
  for (Likelihood likelihood : {Likelihood::kTransition, Likelihood::kInnovation}) {
    for (int people : {1, 2}) {
      SCOPED_TRACE(NameOf(likelihood) + ", " + std::to_string(people));
      const ModelOptions options = ModelOf(people > 1);
      const PendulumRecording recording =
          Measured(people, options, regime.push, regime.noise, &random);
      const LikelihoodProblem problem =
          MakeLikelihoodProblem(likelihood, recording, options, map, 0.7);
      const ParameterBlocks blocks =
          RandomBlocks(map, problem.layout, NoisyParameters(&random, regime.spread),
                       regime.deviation, 0.0, &random);
      std::vector<const double*> at;
      for (const std::vector<double>& block : blocks) at.push_back(block.data());
      const LikelihoodResidual residual(problem, at.data());
      ASSERT_TRUE(residual.status().ok);
      const bool exact = likelihood == Likelihood::kTransition;
      ExpectCorrectJacobian(residual, blocks, {exact ? 2e-7 : 5e-4, exact ? 2e-8 : 1e-6, 1e-13});
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ThreeRegimes, LikelihoodTwins,
                         testing::Values(LikelihoodRegime{"at_rest", 0.0, 0.0, 0.0, 0.0},
                                         LikelihoodRegime{"tiny", 1e-4, 1e-6, 0.1, 0.01},
                                         LikelihoodRegime{"large", 120.0, 0.004, 0.3, 0.1}),
                         [](const auto& test) { return test.param.name; });

// Sideways as forwards: values that follow a fitted one move with it, and so do the rows.
TEST(LikelihoodResidual, KnowsWhatFollowsAFittedValue) {
  Random random(13);
  ParameterMap map = LikelihoodMap({});
  map.values = NoisyParameters(&random, 0.1);
  map.fitted = {{kMu, Transform::kIdentity},
                {kKpTheta, Transform::kLog, -1, kKpPhi},
                {kSigmaX, Transform::kLog, -1, kSigmaY}};
  const ModelOptions options = ModelOf(false);
  const PendulumRecording recording = Measured(1, options, 80.0, 0.003, &random);
  for (Likelihood likelihood : {Likelihood::kTransition, Likelihood::kInnovation}) {
    const LikelihoodProblem problem =
        MakeLikelihoodProblem(likelihood, recording, options, map, 1.0);
    const ParameterBlocks blocks = {SharedBlock(map, map.values)};
    const double* const at[] = {blocks[0].data()};
    const bool exact = likelihood == Likelihood::kTransition;
    ExpectCorrectJacobian(LikelihoodResidual(problem, at), blocks,
                          {exact ? 2e-7 : 5e-4, exact ? 2e-8 : 1e-6, 1e-13});
  }
}

TEST(LikelihoodResidual, HalfItsSquaresAreTheNegativeLogLikelihood) {
  Random random(8);
  const ParameterMap map = LikelihoodMap({});
  const ModelOptions options = ModelOf(false);
  PendulumRecording recording = Measured(1, options, 80.0, 0.003, &random);
  recording.weight = {std::vector<double>(kLikelihoodFrames, 1.0)};
  recording.weight[0][5] = 0.0;  // a gap
  for (Likelihood likelihood : {Likelihood::kTransition, Likelihood::kInnovation}) {
    const LikelihoodProblem problem =
        MakeLikelihoodProblem(likelihood, recording, options, map, 1.0);
    const ParameterSet<double> p = NoisyParameters(&random, 0.1);
    const std::vector<double> block = SharedBlock(map, p);
    const double* const blocks[] = {block.data()};
    const LikelihoodResidual residual(problem, blocks);
    std::vector<double> rows(residual.num_residuals());
    ASSERT_TRUE(residual.Evaluate(blocks, rows.data(), nullptr));
    double half = 0.0;
    for (double row : rows) half += 0.5 * row * row;
    const Deviance deviance = DevianceOf(problem, {p});
    EXPECT_NEAR(half - residual.offset(), 0.5 * deviance.value, 1e-8 * std::abs(deviance.value));
    const int gaps = likelihood == Likelihood::kTransition ? 2 : 1;
    constexpr int kUnderNetPush = 3;  // which was made from the motion
    EXPECT_EQ(deviance.measured, 4 * (kLikelihoodFrames - 1 - gaps - kUnderNetPush));
  }
}

TEST(LikelihoodResidual, PeopleWhoDoNotTouchAddUp) {
  Random random(10);
  const ParameterMap map = LikelihoodMap({});
  const ModelOptions options = ModelOf(false);
  const PendulumRecording both = Measured(2, options, 80.0, 0.003, &random);
  const ParameterSet<double> p = NoisyParameters(&random, 0.1);
  double sum = 0.0;
  for (int n = 0; n < 2; ++n) {
    PendulumRecording one = both;
    one.subject_ids = {both.subject_ids[n]};
    one.scene.people = {both.scene.people[n]};
    one.states = {both.states[n]}, one.hip = {both.hip[n]}, one.rod_length = {both.rod_length[n]};
    one.scene.pushes.clear();
    for (ScenePush push : both.scene.pushes) {
      if (push.person != n) continue;
      push.person = 0;
      one.scene.pushes.push_back(push);
    }
    sum += DevianceOf(MakeLikelihoodProblem(Likelihood::kInnovation, one, options, map, 1.0), {p})
               .value;
  }
  const LikelihoodProblem problem =
      MakeLikelihoodProblem(Likelihood::kInnovation, both, options, map, 1.0);
  EXPECT_NEAR(DevianceOf(problem, {p, p}).value, sum, 1e-9 * std::abs(sum));
}

}  // namespace
}  // namespace pushid
