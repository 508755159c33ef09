// The most probable path to a pose, against its closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "ident/forecasts/most_probable_path.h"
#include "tests/models/generators/generator_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr int kPathFrames = 6;
constexpr float kLogNoise = -1.0f, kDrift = 0.4f;

ParticleStructure NoSkip() {
  ParticleStructure structure;
  structure.skip = false;
  return structure;
}

// Whatever was seen, every displacement is N(drift, noise^2) in units of step_spread.
ParticleGenerator Steady() {
  ParticleNetwork network = RandomParticles(3, NoSkip());
  for (DenseLayer* layer : {&network.drift, &network.noise}) layer->weights.setZero();
  network.drift.bias.setConstant(kDrift);
  network.noise.bias.setConstant(kLogNoise);
  ParticleGeneratorOptions options;
  options.ridge_share = options.simlpe_share = 0.0;
  options.project_bones = false;
  return ParticleGenerator(FourParticles(), {network}, {}, options);
}

// Of independent steps that must add up to an end, all are moved alike.
TEST(PathToPose, OfIndependentStepsIsStraight) {
  const ParticleGenerator generator = Steady();
  const ObservedMotion seen = {SwayingMotion(25, 0.3f)};
  const Eigen::VectorXf last = seen.frames.rightCols(1);
  const float by_drift = kDrift * 0.01f * kPathFrames;
  const Eigen::VectorXf target = (last.array() + by_drift + 0.03f).matrix();
  const auto path = PathToPose(generator, seen, kPathFrames, target);
  ASSERT_TRUE(path.ok()) << path.error().message;
  const MinimizedPath& found = path.value();
  // The end is held as by a spring of 5 mm; noise moves it by this much.
  const double reach = kPathFrames * std::pow(0.01 * std::exp(kLogNoise), 2);
  const double moved = 0.03 * reach / (reach + 0.005 * 0.005);
  for (int t = 0; t < kPathFrames; ++t) {
    const double share = (t + 1.0) / kPathFrames;
    for (int i = 0; i < last.size(); ++i) {
      ASSERT_NEAR(found.motion(i, t) - last[i], share * (by_drift + moved), 2e-5) << t << " " << i;
    }
  }
  const double action = 0.5 * static_cast<double>(last.size()) * moved * moved / reach;
  EXPECT_NEAR(found.of_forecast - found.log_likelihood, action, 0.01 * action);
}

// What was learned of noise that changes with the path changes the path: no other one near it is
// more probable.
TEST(PathToPose, IsAnOptimum) {
  ParticleNetwork network = RandomParticles(4);
  ParticleGeneratorOptions options;
  options.ridge_share = options.simlpe_share = 0.0;
  const ParticleGenerator generator(FourParticles(), {network}, {}, options);
  const ObservedMotion seen = {SwayingMotion(25, 0.3f)};
  const Eigen::VectorXf target = SwayingMotion(40, 0.35f).col(25 + kPathFrames);
  const auto path = PathToPose(generator, seen, kPathFrames, target);
  ASSERT_TRUE(path.ok()) << path.error().message;
  const Trajectories forecast = generator.Forecast({seen}, kPathFrames).front();
  const double before = MeanDistance(forecast.rightCols(1), target, FourParticles())(0);
  EXPECT_LT(path.value().distance, 0.3 * before);
  Random random(5);
  int nearer_and_likelier = 0;
  const auto sampled =
      generator.Sample({seen}, kPathFrames, 200, [&random] { return random.Normal(); });
  for (const SampledFuture& other : sampled.front()) {
    const double away = MeanDistance(other.motion.rightCols(1), target, FourParticles())(0);
    nearer_and_likelier +=
        away <= path.value().distance && other.log_likelihood > path.value().log_likelihood;
  }
  EXPECT_EQ(nearer_and_likelier, 0);
}

TEST(PathToPose, NeedsTransitions) {
  class Statue : public MotionGenerator {
   public:
    const ParticleLayout& layout() const override { return layout_; }
    std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>&, int) const override {
      return {};
    }
    std::vector<std::vector<SampledFuture>> Sample(const std::vector<ObservedMotion>&, int, int,
                                                   const NormalSource&) const override {
      return {};
    }

   private:
    ParticleLayout layout_ = FourParticles();
  };
  EXPECT_TRUE(Contains(ProblemOf(PathToPose(Statue(), {SwayingMotion(25, 0.0f)}, kPathFrames,
                                            Eigen::VectorXf::Zero(12))),
                       "no transition probabilities"));
}

}  // namespace
}  // namespace pushid
