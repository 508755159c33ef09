// Training by the adjoint gradient: a planted network is recovered in what it predicts, the best
// point is kept, and the same start gives the same bits.
#include "ident/large_networks/large_network_fit.h"

#include <utility>

#include "ident/fit/fit.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/presets.h"
#include "ident/solver/network_training.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr NetworkShape kShape{NetworkKind::kLstm, 16, 8};

// 24 recordings of people under the published parameters and a network that pushes with up to about
// 60 N and 60 N m.
struct Planted {
  SyntheticOptions study = SmallStudy();
  std::vector<PendulumRecording> recordings;

  explicit Planted(double noise = 0.0) {
    std::vector<double> weights = InitialWeights(kShape, 5);
    Random random(6);
    for (int i = kShape.output_at(); i < kShape.num_weights(); ++i) {
      weights[i] = random.Uniform(-0.5, 0.5);
    }
    study.model.learned =
        std::make_shared<const LearnedTerms>(LearnedTerms{kShape, std::move(weights)});
    study.joint_noise_m = noise;
    recordings = MakePendulums(study);
  }

  // Those whose number modulo 6 lies in [first, last).
  std::vector<AdjointRecording> Some(int first, int last) const {
    std::vector<AdjointRecording> some;
    for (size_t i = 0; i < recordings.size(); ++i) {
      const int rest = static_cast<int>(i % 6);
      if (rest < first || rest >= last) continue;
      some.push_back({&recordings[i], 1.0 / std::sqrt(recordings[i].num_frames() - 1.0)});
    }
    return some;
  }

  LargeNetworkFit Fit(uint64_t seed) const {
    LargeNetworkFit fit;
    fit.model = study.model;
    fit.model.learned = InitialNetwork(kShape, seed);
    fit.map.values = study.parameters;
    return fit;
  }
};

double CostOf(const LargeNetworkFit& fit, const std::vector<AdjointRecording>& recordings,
              const std::vector<double>& weights) {
  auto adjoint = Unwrapped(AdjointGradient::Create(recordings, fit.model, fit.map, fit.sigmas));
  const AdjointCost cost = adjoint.Evaluate(fit.shared.data(), weights.data(), nullptr, nullptr);
  EXPECT_TRUE(cost.ok());
  return cost.cost;
}

TEST(LargeNetworkFit, RecoversWhatAPlantedNetworkDoes) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(1);
  fit.training = planted.Some(0, 4);
  fit.held_out = planted.Some(4, 5);
  fit.options.weight_sigma = 100.0;
  fit.options.max_iterations = 300;
  const LargeNetworkSolution s = Unwrapped(FitLargeNetwork(fit));
  const std::vector<AdjointRecording> unseen = planted.Some(5, 6);
  const double without = CostOf(fit, unseen, fit.model.learned->weights);
  const double with = CostOf(fit, unseen, s.weights);
  // 1500 and 900 times less when this was written.
  EXPECT_LT(s.final_cost, 0.01 * s.initial_cost);
  EXPECT_LT(with, 0.01 * without);
  EXPECT_EQ(s.trace.front().cost, s.initial_cost);
  EXPECT_LT(s.final_training_cost, s.final_cost);
  EXPECT_NEAR(s.final_training_cost, CostOf(fit, fit.training, s.weights), 1e-12 * s.initial_cost);
  EXPECT_EQ(s.trace.front().iteration, 0);
}

// With noise and few recordings a network learns them by heart: the training goes on to bring their
// cost down, and what is kept is the point before that.
TEST(LargeNetworkFit, EarlyStoppingKeepsTheBestPoint) {
  const Planted planted(0.02);
  LargeNetworkFit fit = planted.Fit(2);
  fit.training = planted.Some(0, 1);
  fit.held_out = planted.Some(1, 6);
  fit.options.weight_sigma = 0.0;
  fit.options.patience = 12;
  int calls = 0;
  const auto solution = FitLargeNetwork(fit, [&](const LargeNetworkIteration& now) {
    EXPECT_EQ(now.iteration, calls++);
    return true;
  });
  ASSERT_TRUE(solution.ok()) << solution.error().ToString();
  const LargeNetworkSolution& s = solution.value();
  EXPECT_TRUE(s.stopped_early);
  EXPECT_EQ(calls, static_cast<int>(s.trace.size()));
  EXPECT_EQ(s.trace.back().iteration, s.best_iteration + fit.options.patience);
  EXPECT_LT(s.trace.back().cost, s.final_cost);
  for (const LargeNetworkIteration& now : s.trace) {
    if (now.held_out_failures == s.held_out_failures) {
      EXPECT_GE(now.held_out_cost, s.best_held_out_cost);
    } else {
      EXPECT_GT(now.held_out_failures, s.held_out_failures);
    }
  }
  EXPECT_LT(s.best_held_out_cost, s.initial_held_out_cost);
  EXPECT_EQ(CostOf(fit, fit.held_out, s.weights), s.best_held_out_cost);
  EXPECT_EQ(CostOf(fit, fit.training, s.weights), s.final_cost);
  EXPECT_EQ(s.Network({kShape, {}})->weights, s.weights);
}

// Adam finds it too, by passes over a few recordings at a time, and repeats to the bit.
TEST(LargeNetworkFit, AdamRecoversWhatAPlantedNetworkDoes) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(1);
  fit.training = planted.Some(0, 5);
  fit.options.weight_sigma = 100.0;
  fit.options.optimizer = NetworkOptimizer::kAdam;
  fit.options.rate = 1e-2;
  fit.options.max_iterations = 150;
  const LargeNetworkSolution s = Unwrapped(FitLargeNetwork(fit));
  EXPECT_EQ(s.trace.size(), 151u);
  EXPECT_EQ(s.gradients, 151 * 3) << "twenty recordings, eight at a time";
  EXPECT_NEAR(s.trace.front().training_cost, CostOf(fit, fit.training, fit.model.learned->weights),
              1e-9 * s.initial_cost);
  const std::vector<AdjointRecording> unseen = planted.Some(5, 6);
  EXPECT_LT(CostOf(fit, unseen, s.weights), 0.1 * CostOf(fit, unseen, fit.model.learned->weights));
  fit.options.max_iterations = 3;
  EXPECT_EQ(FitLargeNetwork(fit).value().weights, FitLargeNetwork(fit).value().weights);
}

TEST(LargeNetworkFit, TheSameStartGivesTheSameBits) {
  const Planted planted(0.005);
  LargeNetworkFit fit = planted.Fit(3);
  fit.training = planted.Some(0, 3);
  fit.held_out = planted.Some(3, 4);
  fit.options.max_iterations = 15;
  const auto one = FitLargeNetwork(fit), two = FitLargeNetwork(fit);
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_EQ(one.value().weights, two.value().weights);
  EXPECT_EQ(one.value().final_cost, two.value().final_cost);
  fit.model.learned = InitialNetwork(kShape, 4);
  EXPECT_NE(FitLargeNetwork(fit).value().weights, one.value().weights);
}

// The caller may end it, and has the point of that moment.
TEST(LargeNetworkFit, EndsWhenItsCallerSaysSo) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(3);
  fit.training = planted.Some(0, 2);
  const auto solution =
      FitLargeNetwork(fit, [](const LargeNetworkIteration& now) { return now.iteration < 5; });
  ASSERT_TRUE(solution.ok());
  EXPECT_EQ(solution.value().best_iteration, 5);
  EXPECT_FALSE(solution.value().stopped_early);
  EXPECT_LT(solution.value().final_cost, solution.value().initial_cost);
}

// Friction and a cross term from half the truth, with the planted network's own
// weights: what is minimized is least where the data and the priors say.
TEST(LargeNetworkFit, FitsSharedParametersToo) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(1);
  fit.model = planted.study.model;
  fit.map.fitted = {{kMu, Transform::kLog}, {kAx, Transform::kIdentity}};
  fit.training = planted.Some(0, 6);
  const double mu = planted.study.parameters[kMu], ax = planted.study.parameters[kAx];
  fit.shared = {std::log(mu / 2.0), 0.5 * ax};
  fit.shared_prior = {{std::log(mu), 1.0, 1.0}, {ax, 10.0, 5.0}};
  fit.options.weight_sigma = 0.0;
  fit.options.fit_shared = true;
  fit.options.max_iterations = 300;
  fit.options.function_tolerance = 1e-10;
  const LargeNetworkSolution s = Unwrapped(FitLargeNetwork(fit));
  EXPECT_LT(s.final_cost, 1e-3 * s.initial_cost);
  EXPECT_NEAR(s.shared[0], std::log(mu), 0.3 * std::log(2.0));
  EXPECT_NEAR(s.shared[1], ax, 0.3 * std::abs(ax));

  fit.options.fit_shared = false;
  fit.options.max_iterations = 3;
  EXPECT_EQ(FitLargeNetwork(fit).value().shared, fit.shared);
}

TEST(LargeNetworkFit, PriorsOfTheTable) {
  ParameterTable table = MakePreset("tail").value().table;
  table[kMu].transform = Transform::kLog;
  table[kMu].prior = Prior{20.0, 5.0};
  table[kAx].prior.reset();
  const ParameterMap map = table.Map();
  const std::vector<SharedPrior> priors = SharedPriors(table, map);
  ASSERT_EQ(priors.size(), map.fitted.size());
  for (size_t i = 0; i < priors.size(); ++i) {
    if (map.fitted[i].parameter == kMu) {
      EXPECT_DOUBLE_EQ(priors[i].mean, std::log(20.0));
      EXPECT_DOUBLE_EQ(priors[i].sigma, 0.25);
    } else if (map.fitted[i].parameter == kAx) {
      EXPECT_TRUE(std::isinf(priors[i].sigma));
      EXPECT_EQ(priors[i].unit, table[kAx].scale);
    }
  }
}

// One that falls at the start is held to the frames before, and named.
TEST(LargeNetworkFit, HoldsAFallToTheFramesBefore) {
  Planted planted;
  planted.recordings[6].scene = ScalePushes(planted.recordings[6].scene, 200.0);
  LargeNetworkFit fit = planted.Fit(1);
  fit.training = planted.Some(0, 1);
  fit.options.max_iterations = 10;
  const auto solution = Unwrapped(FitLargeNetwork(fit));
  ASSERT_EQ(solution.shortened.size(), 1u);
  EXPECT_EQ(solution.shortened[0].training, 1);
  EXPECT_GT(solution.shortened[0].status.frame, 1);
  EXPECT_LT(solution.final_cost, solution.initial_cost);
}

TEST(LargeNetworkFit, SaysWhatIsMissing) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(1);
  const auto complaint = [&] {
    const auto solution = FitLargeNetwork(fit);
    return solution.ok() ? "" : solution.error().ToString();
  };
  EXPECT_TRUE(Contains(complaint(), "no recordings"));
  fit.training = planted.Some(0, 1);
  fit.map.fitted = {{kMu, Transform::kLog}};
  EXPECT_TRUE(Contains(complaint(), "each of 1 shared"));
  fit.map.fitted.clear();
  fit.model.learned =
      std::make_shared<const LearnedTerms>(LearnedTerms{kShape, std::vector<double>(3)});
  EXPECT_TRUE(Contains(complaint(), "but 3 are given"));
  fit.model.learned = nullptr;
  EXPECT_TRUE(Contains(complaint(), "no network"));
}

// The core calls what a program links, and says so where it links nothing.
TEST(LargeNetworkFit, IsLinkedByProgramsThatNeedIt) {
  LargeNetworkTrainer& hook = LargeNetworkTraining();
  ASSERT_NE(hook, nullptr) << "ident_tests links pushid_large_networks";
  const LargeNetworkTrainer linked = std::exchange(hook, nullptr);
  const auto without = TrainLargeNetwork({}, {}, {}, nullptr);
  hook = linked;
  ASSERT_FALSE(without.ok());
  EXPECT_TRUE(Contains(without.error().ToString(), "pushid_large_networks"));
}

}  // namespace
}  // namespace pushid
