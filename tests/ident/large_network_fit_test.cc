// Training by the adjoint gradient: a planted network is recovered in what it predicts, the best
// point is kept, and the same start gives the same bits.
#include "ident/large_network_fit.h"

#include "ident/self_network_io.h"
#include "tests/ident/fit_samples.h"

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
    study.model.self_network =
        std::make_shared<const SelfNetwork>(SelfNetwork{kShape, std::move(weights)});
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
    fit.model.self_network = InitialNetwork(kShape, seed);
    fit.map.values = study.parameters;
    return fit;
  }
};

double CostOf(const LargeNetworkFit& fit, const std::vector<AdjointRecording>& recordings,
              const std::vector<double>& weights) {
  auto adjoint = AdjointGradient::Create(recordings, fit.model, fit.map, fit.sigmas);
  EXPECT_TRUE(adjoint.ok());
  const AdjointCost cost =
      adjoint.value().Evaluate(fit.shared.data(), weights.data(), nullptr, nullptr);
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
  const auto solution = FitLargeNetwork(fit);
  ASSERT_TRUE(solution.ok()) << solution.error().ToString();
  const LargeNetworkSolution& s = solution.value();
  const std::vector<AdjointRecording> unseen = planted.Some(5, 6);
  const double without = CostOf(fit, unseen, fit.model.self_network->weights);
  const double with = CostOf(fit, unseen, s.weights);
  std::cout << s.initial_cost << " -> " << s.final_cost << ", held out " << s.initial_held_out_cost
            << " -> " << s.best_held_out_cost << ", unseen " << without << " -> " << with << ", "
            << s.trace.size() - 1 << " iterations, best " << s.best_iteration << ", " << s.gradients
            << " gradients, " << s.seconds << " s, " << s.message << "\n";
  EXPECT_LT(s.final_cost, 0.01 * s.initial_cost);
  EXPECT_LT(with, 0.05 * without);
}

}  // namespace
}  // namespace pushid
