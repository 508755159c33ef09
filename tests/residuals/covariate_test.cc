// Parameters that follow what is known of people: by hand, by column, and in whole rollouts.
#include <ceres/jet.h>

#include "residuals/cost_functions/likelihood_residual.h"
#include "residuals/jets/autodiff_rollout.h"
#include "residuals/parameter_map.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr Parameter kSlope = static_cast<Parameter>(kFirstOwnParameter);
constexpr Parameter Slot(int i) { return static_cast<Parameter>(kFirstOwnParameter + i); }

TEST(Shifted, IsAStepOnTheFittedScale) {
  for (Transform transform : {Transform::kIdentity, Transform::kLog, Transform::kLogit}) {
    for (double natural : {1e-3, 0.2, 0.97}) {
      EXPECT_DOUBLE_EQ(Shifted(transform, natural, 0.0), natural);
      for (double by : {-2.0, -1e-8, 0.4}) {
        EXPECT_NEAR(Shifted(transform, natural, by),
                    ToNatural(transform, ToFitted(transform, natural) + by), 1e-14);
      }
    }
  }
  EXPECT_EQ(Shifted(Transform::kLog, 0.0, 1.0), 0.0);
}

// By hand: stiffness 1500 N m/rad at 40 years, 1 % less with each year; a person of 50 years.
TEST(ParameterMap, ASlopeMovesItsTargetAndWhatFollowsIt) {
  ParameterMap map;
  map.values[kAx] = -9.0;
  map.fitted = {{kKpTheta, Transform::kLog, -1, kKpPhi}, {kSlope, Transform::kIdentity, -1}};
  map.covariates = {{"age", 40.0, "", ""}};
  map.shifts = {{kSlope, kKpTheta, Transform::kLog, 0, kKpPhi}};
  const double shared[] = {std::log(1500.0), std::log(0.99)};
  const std::vector<double> ten_years = {10.0};
  const ParameterSet<double> old = map.Apply<double>(shared, nullptr, &ten_years);
  EXPECT_NEAR(old[kKpTheta], 1500.0 * std::pow(0.99, 10.0), 1e-9);
  EXPECT_EQ(old[kKpPhi], old[kKpTheta]);
  EXPECT_EQ(old[kSlope], shared[1]);
  EXPECT_NEAR(map.Apply<double>(shared, nullptr)[kKpTheta], 1500.0, 1e-9);
  // Two columns, each by two parameters; of nobody in particular a slope moves nothing.
  const std::vector<ColumnEntry> entries = map.Entries(old, &ten_years);
  ASSERT_EQ(entries.size(), 4u);
  EXPECT_EQ(entries[2].column, 1);
  EXPECT_EQ(entries[2].parameter, kKpTheta);
  EXPECT_EQ(entries[3].parameter, kKpPhi);
  EXPECT_NEAR(entries[2].derivative, 10.0 * old[kKpTheta], 1e-9);
  EXPECT_EQ(map.Entries(old)[2].derivative, 0.0);
}

// A slope that is held, and whose target is held, still acts.
TEST(ParameterMap, AHeldSlopeActs) {
  ParameterMap map;
  map.values[kAx] = -9.0;
  map.values[kSlope] = 0.5;
  map.covariates = {{"age", 40.0, "", ""}};
  map.shifts = {{kSlope, kAx, Transform::kIdentity, 0}};
  const std::vector<double> x = {-4.0};
  EXPECT_EQ(map.Apply<double>(nullptr, nullptr, &x)[kAx], -11.0);
}

TEST(CovariatesOf, AreCentredNumbersAndHalvesOfLabels) {
  PendulumRecording recording;
  recording.labels.Set("eyes", "open");
  recording.scene.people.resize(3);
  recording.scene.people[0].body = {70.0, 0.9, 0.1};
  recording.known = {{{{"age", 30.0}}, {{"group", "patients"}}},
                     {{{"age", 44.0}}, {{"group", "controls"}}},
                     {{}, {}}};
  const std::vector<Covariate> covariates = {{"age", 40.0, "", ""},
                                             {"group", 0.0, "controls", "patients"},
                                             {"eyes", 0.0, "closed", "open"}};
  using Rows = std::vector<std::vector<double>>;
  EXPECT_EQ(CovariatesOf(recording, covariates),
            (Rows{{-10.0, 0.5, 0.5}, {4.0, -0.5, 0.5}, {0.0, 0.0, 0.5}}));
  EXPECT_EQ(NumberOf(recording, 0, "mass"), 70.0);
  EXPECT_EQ(NumberOf(recording, 0, "rod"), 0.9);
  EXPECT_EQ(NumberOf(recording, 2, "age"), std::nullopt);
  EXPECT_TRUE(CovariatesOf(recording, {}).empty());
}

// Every parameter fitted, some by subject, and slopes of every transform.
ParameterMap MapWithSlopes() {
  ParameterMap map = EveryParameterMap({kMu, kKpTheta, kTailTorque});
  map.covariates = {{"age", 40.0, "", ""}, {"group", 0.0, "controls", "patients"}};
  map.shifts = {{Slot(0), kKpTheta, Transform::kLog, 0},
                {Slot(1), kAx, Transform::kIdentity, 0},
                {Slot(2), kTailTorque, Transform::kLogit, 1},
                {Slot(3), kKpTheta, Transform::kLog, 1},
                {Slot(4), kMuY, Transform::kLog, 1}};
  return map;
}

PendulumRecording TwoPeople(const ModelOptions& options, int frames, Random* random) {
  Scene scene = SceneOfPeople(2, 0.05, random);
  scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, 120.0, random),
                  RandomPush(1, 2, 5, PushKind::kExternal, 120.0, random)};
  PendulumRecording recording =
      RecordRollout(scene, options, std::vector(2, RecoveringParameters()), frames);
  AddNoise(0.01, random, &recording);
  recording.known = {{{{"age", 40.7}}, {{"group", "patients"}}},
                     {{{"age", 38.9}}, {{"group", "controls"}}}};
  return recording;
}

ParameterSet<double> WithSlopes(ParameterSet<double> p, Random* random) {
  for (int i = 0; i < 5; ++i) p[Slot(i)] = random->Uniform(-0.2, 0.2);
  return p;
}

TEST(Covariates, ForwardSensitivitiesEqualJets) {
  Random random(5);
  const ParameterMap map = MapWithSlopes();
  ModelOptions group;
  group.interaction.spring = group.interaction.damping = true;
  ModelOptions holds;
  holds.stance = Stance::kSteps;
  for (const ModelOptions& options : {ModelOptions{}, group, holds}) {
    SCOPED_TRACE(Describe(options));
    PendulumRecording recording = TwoPeople(options, 30, &random);
    recording.initial_velocity = InitialVelocity::kFree;
    const auto problem = MakeRolloutProblem(recording, options, map, {}, 0.7, 0);
    ExpectDirectionalDerivatives(
        AutoDiffRollout(problem),
        RandomBlocks(map, problem->layout, WithSlopes(RecoveringParameters(), &random), 0.1, 0.2,
                     &random));
  }
}

TEST(Covariates, LikelihoodsAgreeWithNumericDifferentiation) {
  Random random(6);
  ParameterMap map;
  map.values = RecoveringParameters();
  map.values[kSigmaX] = map.values[kSigmaY] = 20.0;
  map.values[kSigmaTheta] = map.values[kSigmaPhi] = 12.0;
  map.values[kMeasuredCart] = map.values[kMeasuredHip] = 0.003;
  map.fitted = {{kKpTheta, Transform::kLog, -1}, {Slot(0), Transform::kIdentity, -1}};
  map.covariates = {{"age", 40.0, "", ""}};
  map.shifts = {{Slot(0), kKpTheta, Transform::kLog, 0}};
  ModelOptions options;
  options.process_noise = ProcessNoise::kDiagonal;
  const PendulumRecording recording = TwoPeople(options, 12, &random);
  for (Likelihood likelihood : {Likelihood::kTransition, Likelihood::kInnovation}) {
    const LikelihoodProblem problem =
        MakeLikelihoodProblem(likelihood, recording, options, map, 1.0);
    const ParameterBlocks blocks = {{std::log(1500.0), 0.1}};
    const double* const at[] = {blocks[0].data()};
    ExpectCorrectJacobian(LikelihoodResidual(problem, at), blocks,
                          // Innovations take differences themselves, of 3e-5.
                          {likelihood == Likelihood::kInnovation ? 1e-3 : 1e-6, 1e-6, 1e-12});
  }
}

}  // namespace
}  // namespace pushid
