// Training by the adjoint gradient: a planted network is recovered in what it predicts, and the
// same start gives the same bits.
#include "ident/large_networks/large_network_fit.h"

#include <utility>

#include "ident/fit/fit.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/presets.h"
#include "ident/solver/solver.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr NetworkShape kShape{NetworkKind::kMlp, 48};

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

  // Recordings whose number modulo 6 lies in [first, last).
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

// By passes over a few recordings at a time; it repeats to the bit.
TEST(LargeNetworkFit, RecoversWhatAPlantedNetworkDoes) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(1);
  fit.training = planted.Some(0, 5);
  fit.options.weight_sigma = 100.0;
  fit.options.rate = 1e-2, fit.options.last_rate = 1e-4;
  fit.options.passes = 150;
  const LargeNetworkSolution s = Unwrapped(FitLargeNetwork(fit));
  EXPECT_EQ(s.passes.size(), 151u);
  EXPECT_NEAR(s.passes.front().cost, CostOf(fit, fit.training, fit.model.learned->weights),
              1e-3 * s.passes.front().cost);
  const std::vector<AdjointRecording> unseen = planted.Some(5, 6);
  EXPECT_LT(CostOf(fit, unseen, s.weights), 0.1 * CostOf(fit, unseen, fit.model.learned->weights));
  EXPECT_EQ(s.Network({kShape, {}})->weights, s.weights);
  fit.options.passes = 3;
  EXPECT_EQ(FitLargeNetwork(fit).value().weights, FitLargeNetwork(fit).value().weights);
  fit.options.seed = 2;
  EXPECT_NE(FitLargeNetwork(fit).value().weights, s.weights);
}

// Adam's first step is the rate times the gradient's sign, g / sqrt(g^2): with 4 recordings, one
// batch, one pass moves LDP's weights by 3e-4, as published; other networks end at 1e-5.
TEST(LargeNetworkFit, LdpsNetworksLearnAtThePublishedRate) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(1);
  fit.training = planted.Some(0, 1);
  for (const auto& [kind, rate] :
       {std::pair(NetworkKind::kLdp, 3e-4), std::pair(NetworkKind::kMlp, 1e-5)}) {
    fit.model.learned = InitialNetwork({kind, 16, kind == NetworkKind::kLdp ? 8 : 0}, 1);
    fit.options = OptionsFor(*fit.model.learned);
    fit.options.passes = 1;
    const std::vector<double> moved = Unwrapped(FitLargeNetwork(fit)).weights;
    double most = 0.0;
    for (size_t i = 0; i < moved.size(); ++i) {
      most = std::max(most, std::abs(moved[i] - fit.model.learned->weights[i]));
    }
    EXPECT_NEAR(most, rate, 1e-3 * rate);
  }
}

// The caller may end it, and has the point of that moment.
TEST(LargeNetworkFit, EndsWhenItsCallerSaysSo) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(3);
  fit.training = planted.Some(0, 2);
  const auto solution = FitLargeNetwork(fit, [](const LargeNetworkPass& p) { return p.pass < 5; });
  ASSERT_TRUE(solution.ok());
  EXPECT_EQ(solution.value().passes.size(), 6u);
  EXPECT_LT(solution.value().passes.back().cost, solution.value().passes.front().cost);
}

// What continues a push, from half the truth, with the planted network's own weights: what is
// minimized is least where the data and the priors say.
TEST(LargeNetworkFit, FitsSharedParametersToo) {
  const Planted planted;
  LargeNetworkFit fit = planted.Fit(1);
  fit.model = planted.study.model;
  fit.training = planted.Some(0, 6);
  std::vector<double> truth;
  for (const Parameter id : {kTailGain, kTailTime}) {
    fit.map.fitted.push_back({id, Transform::kLog});
    truth.push_back(std::log(planted.study.parameters[id]));
    fit.shared.push_back(truth.back() - std::log(2.0));
    fit.shared_prior.push_back({truth.back(), 0.3, 1.0});
  }
  fit.options.weight_sigma = 0.0;
  fit.options.rate = 3e-3, fit.options.last_rate = 3e-6;
  fit.options.passes = 1000;
  const LargeNetworkSolution s = Unwrapped(FitLargeNetwork(fit));
  EXPECT_LT(s.passes.back().cost, 1e-3 * s.passes.front().cost);
  for (size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(s.shared[i], truth[i], 0.3 * std::log(2.0)) << i;
  }
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
  fit.options.passes = 10;
  const auto solution = Unwrapped(FitLargeNetwork(fit));
  ASSERT_EQ(solution.shortened.size(), 1u);
  EXPECT_EQ(solution.shortened[0].recording, 1);
  EXPECT_GT(solution.shortened[0].status.frame, 1);
  EXPECT_LT(solution.passes.back().cost, solution.passes.front().cost);
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
  const auto without = TrainLargeNetwork({}, {}, nullptr);
  hook = linked;
  ASSERT_FALSE(without.ok());
  EXPECT_TRUE(Contains(without.error().ToString(), "pushid_large_networks"));
}

}  // namespace
}  // namespace pushid
