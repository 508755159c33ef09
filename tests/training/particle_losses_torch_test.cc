// The losses of particles: SDE's Eq. 10 and 11 worked by hand, and the gradient of every loss (Eq.
// 6 in both readings, 10, 11, 12) against central finite differences in double precision.
#include <gtest/gtest.h>

#include <functional>

#include "models/generators/particle_module_torch.h"
#include "tests/models/generators/generator_samples.h"

namespace pushid {
namespace {

constexpr int kObserved = 2, kPredicted = 3;

ParticleTrainingOptions Weighing(double distance, double squared, double bones) {
  ParticleTrainingOptions options;
  options.observed = kObserved, options.predicted = kPredicted;
  options.even_frames = true;
  options.distance = distance, options.squared = squared, options.bones = bones;
  return options;
}

torch::Tensor Random(std::vector<int64_t> shape) { return torch::randn(shape, torch::kFloat64); }

// One window of four particles.
torch::Tensor Window(const torch::Tensor& pose) {
  return pose.repeat({1, kObserved + kPredicted, 1});
}

torch::Tensor Standing() {
  return ToTensor(SwayingMotion(1, 0.0f)).unsqueeze(0).to(torch::kFloat64);
}

// The spine (weight 2 of 5) is 0.3 and 0.4 m off in the first frame, an arm (weight 1) 2 m in the
// second: 0.25 * 2 / 5 = 0.1 and 4 / 5 = 0.8 m^2, and nothing in the third.
TEST(ParticleLossesTest, Equation10ByHand) {
  const torch::Tensor window = Window(Standing());
  torch::Tensor forecast = window.narrow(1, kObserved, kPredicted).clone();
  forecast[0][0][0] += 0.3, forecast[0][0][1] += 0.4;
  forecast[0][1][8] += 2.0;
  ParticleTrainingOptions options = Weighing(0.0, 10.0, 0.0);
  const auto loss = [&] {
    return ParticleLosses(FourParticles(), options)(forecast, window).item<double>();
  };
  EXPECT_NEAR(loss(), 10.0 * (0.1 + 0.8) / 3.0, 1e-6);
  options.even_frames = false;  // weights 1, 1/2, 1/3
  EXPECT_NEAR(loss(), 10.0 * (0.1 + 0.8 / 2.0) / (1.0 + 1.0 / 2.0 + 1.0 / 3.0), 1e-6);
  options.even_frames = true;
  options.squared = 0.0, options.distance = 1.0;  // distances instead of their squares
  EXPECT_NEAR(loss(), (0.5 * 2.0 / 5.0 + 2.0 / 5.0) / 3.0, 1e-5);
}

// Head and both arms, which hang on it, move up by 0.1 m: of four bones only the head's, 0.3 m long
// and upright, changes, by 0.1 m.
TEST(ParticleLossesTest, Equation11ByHand) {
  torch::Tensor window = Window(torch::zeros({1, 1, 12}, torch::kFloat64));
  window.select(2, 4) += 0.3;
  window.narrow(2, 6, 6) += torch::tensor({0.3, 0.3, 0.0, -0.3, 0.3, 0.0}, torch::kFloat64);
  torch::Tensor forecast = window.narrow(1, kObserved, kPredicted).clone();
  for (int coordinate : {4, 7, 10}) forecast[0][0][coordinate] += 0.1;
  const ParticleLosses losses(FourParticles(), Weighing(0.0, 0.0, 2.0));
  EXPECT_NEAR(losses(forecast, window).item<double>(), 2.0 * 0.1 / 4.0 / 3.0, 1e-6);
}

// loss: repeats its random draws; of values in double precision, which require gradients.
void ExpectCorrectGradient(const std::vector<torch::Tensor>& values,
                           const std::function<torch::Tensor()>& loss) {
  constexpr double kStep = 1e-6;
  const std::vector<torch::Tensor> gradients = torch::autograd::grad({loss()}, values);
  double largest = 0.0;
  for (size_t v = 0; v < values.size(); ++v) {
    torch::Tensor flat = values[v].detach().view({-1});
    for (int64_t i = 0; i < flat.numel(); i += 1 + flat.numel() / 10) {
      const double at = flat[i].item<double>();
      flat[i] = at + kStep;
      const double above = loss().item<double>();
      flat[i] = at - kStep;
      const double below = loss().item<double>();
      flat[i] = at;
      const double gradient = gradients[v].reshape({-1})[i].item<double>();
      EXPECT_NEAR(gradient, (above - below) / (2.0 * kStep), 1e-7 + 1e-5 * std::abs(gradient))
          << "tensor " << v << ", entry " << i;
      largest = std::max(largest, std::abs(gradient));
    }
  }
  EXPECT_GT(largest, 1e-4) << "a loss that depends on nothing";
}

class LossGradients : public testing::Test {
 protected:
  void SetUp() override { torch::manual_seed(1); }
};

TEST_F(LossGradients, DistancesSquaresAndBones) {
  const torch::Tensor window = Window(Standing());
  const torch::Tensor forecast =
      (window.narrow(1, kObserved, kPredicted) + 0.1 * Random({1, kPredicted, 12}))
          .requires_grad_(true);
  for (const ParticleTrainingOptions& options :
       {Weighing(1.0, 0.0, 0.0), Weighing(0.0, 10.0, 0.0), Weighing(0.0, 0.0, 1.0)}) {
    const ParticleLosses losses(FourParticles(), options);
    ExpectCorrectGradient({forecast}, [&] { return losses(forecast, window); });
  }
}

TEST_F(LossGradients, Equation6InEveryReading) {
  const torch::Tensor misses = Random({2, 3, 4}).requires_grad_(true);
  const torch::Tensor log_noise = (0.3 * Random({2, 3, 4})).requires_grad_(true);
  for (NoiseLoss reading : {NoiseLoss::kLikelihood, NoiseLoss::kDrawn}) {
    ExpectCorrectGradient({misses, log_noise}, [&] {
      torch::manual_seed(7);  // the same w
      return TransitionLoss(reading, misses, log_noise).mean();
    });
  }
}

// Both sides of Eq. 12: what the critic learns by, with its penalty of slopes, and what it says to
// the forecast.
TEST_F(LossGradients, Equation12AndItsPenalty) {
  ParticleCritic critic(kPredicted * 12, torch::full({12}, 0.1, torch::kFloat64));
  critic.to(torch::kFloat64);
  const torch::Tensor last = Random({4, 1, 12});
  const torch::Tensor forecast = (last + 0.3 * Random({4, kPredicted, 12})).requires_grad_(true);
  const torch::Tensor truth = critic.Features(last + 0.3 * Random({4, kPredicted, 12}), last);
  ExpectCorrectGradient({forecast}, [&] { return -critic.Score(critic.Features(forecast, last)); });
  const torch::Tensor made = critic.Features(forecast, last).detach();
  ExpectCorrectGradient(critic.parameters(), [&] {
    torch::manual_seed(7);  // the same points in between
    return critic.Loss(made, truth);
  });
}

}  // namespace
}  // namespace pushid
