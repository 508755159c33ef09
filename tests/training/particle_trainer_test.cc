// The trainer of particles: it learns, repeats itself, goes on where it was broken off, and what it
// returns is the network that LibTorch trained, to 1e-5 m. Likewise siMLPe.
#include <gtest/gtest.h>

#include "models/generators/generator_trainers.h"
#include "tests/models/generators/generator_samples.h"

namespace pushid {
namespace {

std::vector<LearntParticles> Motions(int count, float phase) {
  std::vector<LearntParticles> motions;
  for (int i = 0; i < count; ++i) {
    motions.push_back({i % 2, SwayingMotion(60, phase + 0.7f * static_cast<float>(i))});
  }
  return motions;
}

ParticleTrainingOptions QuickParticles() {
  ParticleTrainingOptions options;
  options.observed = 12;
  options.predicted = 8;
  options.steps = 60;
  options.noise_steps = 30;
  options.batch = 16;
  options.warm_up = 10;
  options.jitter = 0.1;
  return options;
}

ParticleNetwork Trained(const ParticleTrainingOptions& options) {
  const auto trainer =
      ParticleTrainer::Make(FourParticles(), Motions(6, 0.0f), Motions(2, 0.3f), options);
  while (!trainer->Done()) trainer->RunRound();
  return trainer->Network();
}

void ExpectSame(const ParticleNetwork& a, const ParticleNetwork& b) {
  EXPECT_EQ(a.input.weights, b.input.weights);
  EXPECT_EQ(a.recurrent.weights, b.recurrent.weights);
  EXPECT_EQ(a.drift.weights, b.drift.weights);
  EXPECT_EQ(a.noise.weights, b.noise.weights);
  EXPECT_EQ(a.noise_mix, b.noise_mix);
  EXPECT_EQ(a.skip, b.skip);
}

TEST(ParticleTrainerTest, LearnsBeyondConstantVelocity) {
  ParticleTrainingOptions options = QuickParticles();
  options.steps = 300;
  options.noise_steps = 0;
  const auto trainer =
      ParticleTrainer::Make(FourParticles(), Motions(6, 0.0f), Motions(2, 0.3f), options);
  const TrainingPoint first = trainer->RunRound();
  TrainingPoint last = first;
  while (!trainer->Done()) last = trainer->RunRound();
  EXPECT_LT(last.validation_loss, 0.5 * first.validation_loss);
  EXPECT_EQ(last.epoch, 300);
  EXPECT_EQ(last.stage, "drift");
}

TEST(ParticleTrainerTest, RepeatsItselfToTheLastBit) {
  ParticleTrainingOptions options = QuickParticles();
  options.critic = 0.01;
  ExpectSame(Trained(options), Trained(options));
}

TEST(ParticleTrainerTest, EigenForecastsWhatLibTorchDoes) {
  std::vector<ParticleStructure> structures(7);
  structures[1].skip = false;
  structures[2].particles = structures[2].summed = false;
  structures[3].corrected_frames = 5;  // of eight: later ones keep the last correction
  structures[4].poses = structures[4].skip = false;
  structures[5].lstm = true;
  structures[6] = structures[4];
  structures[6].summed = false;
  for (size_t i = 0; i < structures.size(); ++i) {
    ParticleTrainingOptions options = QuickParticles();
    options.structure = structures[i];
    options.steps = 30;
    options.noise_steps = 0;
    const auto trainer = ParticleTrainer::Make(FourParticles(), Motions(6, 0.0f), {}, options);
    while (!trainer->Done()) trainer->RunRound();
    const std::vector<ObservedMotion> people = {{SwayingMotion(12, 0.5f)}};
    const ParticleNetwork network = trainer->Network();
    ParticleRollout rollout(network, people);
    const Trajectories torch = trainer->Forecast(people[0], 8);
    for (int t = 0; t < 8; ++t) {
      EXPECT_LT((rollout.Step() - torch.col(t)).cwiseAbs().maxCoeff(), 1e-5f) << i << " " << t;
    }
  }
}

// A random walk of 1 cm a frame: in units of its displacements the best drift is f = 0 and the best
// noise g = 1, so log g = 0; the second coordinate goes with the first, g^10 = 0.8. Trained by Eq.
// 6 alone, in both readings: as printed, with w drawn, |p - f - g w|^2 = 1 + g^2 in the mean is
// least without noise.
TEST(ParticleTrainerTest, Equation6TrainsDriftAndNoiseTogether) {
  std::vector<LearntParticles> motions;
  Random random(6);
  for (int i = 0; i < 60; ++i) {  // too many to be learned by heart
    LearntParticles walk = {0, Trajectories::Zero(12, 80)};
    for (int t = 1; t < 80; ++t) {
      walk.motion.col(t) = walk.motion.col(t - 1);
      for (float& x : walk.motion.col(t)) x += static_cast<float>(0.01 * random.Normal());
      const float first = walk.motion(0, t) - walk.motion(0, t - 1);
      float& second = walk.motion(1, t);
      second = walk.motion(1, t - 1) + 0.8f * first + 0.6f * (second - walk.motion(1, t - 1));
    }
    motions.push_back(walk);
  }
  ParticleTrainingOptions options = QuickParticles();
  options.structure.poses = options.structure.skip = false;
  options.structure.noisy_input = true;
  options.together = options.constant_rate = true;
  options.distance = options.mirrored = options.jitter = 0.0;
  options.transitions = 1.0;
  options.steps = 100;
  options.learning_rate = 1e-2;
  const auto trained = [&](NoiseLoss loss) {
    options.noise_loss = loss;
    const auto trainer = ParticleTrainer::Make(FourParticles(), motions, {}, options);
    TrainingPoint point;
    while (!trainer->Done()) point = trainer->RunRound();
    EXPECT_EQ(point.stage, "drift and noise");
    EXPECT_EQ(point.epoch, options.steps);
    return trainer->Network();
  };
  const auto log_noise = [&](const ParticleNetwork& network) {
    const std::vector<ObservedMotion> people = {{motions[7].motion.middleCols(20, 12)}};
    const Eigen::MatrixXf none = Eigen::MatrixXf::Zero(12, 1);
    ParticleRollout rollout(network, people);
    rollout.Step(&none);  // log N(f; f, g^2) = -sum (log g + log(2 pi) / 2)
    return -rollout.log_likelihood()(0) / 12.0f - 0.5f * std::log(2.0f * static_cast<float>(M_PI));
  };
  const ParticleNetwork likely = trained(NoiseLoss::kLikelihood);
  EXPECT_NEAR(log_noise(likely), 0.0f, 0.15f);
  EXPECT_GT(likely.drift.weights.cwiseAbs().maxCoeff(), 0.0f) << "f is trained too";
  EXPECT_EQ(likely.noise_mix.size(), 0);
  EXPECT_GT(likely.noise_below.bias(12), 0.1f) << "row 1, column 0";
  EXPECT_LT(std::abs(likely.noise_below.bias(24)), 0.15f) << "row 2, column 0";
  EXPECT_EQ(likely.noise_below.bias(1), 0.0f) << "nothing above the diagonal";
  EXPECT_LT(log_noise(trained(NoiseLoss::kDrawn)), -1.2f);
}

// Otherwise Eq. 6 trains g alone: whatever it costs, the drift stays as it was.
TEST(ParticleTrainerTest, OtherwiseItTrainsTheNoiseAlone) {
  ParticleTrainingOptions options = QuickParticles();
  options.steps = 0;
  const ParticleNetwork network = Trained(options);
  EXPECT_EQ(network.drift.weights.cwiseAbs().maxCoeff(), 0.0f);
  EXPECT_GT(network.noise.weights.cwiseAbs().maxCoeff(), 0.0f);
}

// Head and spine are shaken together, with a correlation of 0.8 along every axis.
TEST(ParticleTrainerTest, FindsTheCorrelationsOfTheNoise) {
  std::vector<LearntParticles> motions;
  Random random(4);
  for (int i = 0; i < 6; ++i) {
    LearntParticles walk = {0, SwayingMotion(80, static_cast<float>(i))};
    Eigen::VectorXf moved = Eigen::VectorXf::Zero(12);
    for (int t = 0; t < 80; ++t) {
      Eigen::VectorXf step(12);
      for (float& x : step) x = static_cast<float>(0.01 * random.Normal());
      step.segment<3>(3) = 0.8f * step.head<3>() + 0.6f * step.segment<3>(3);
      moved += step;
      walk.motion.col(t) += moved;
    }
    motions.push_back(walk);
  }
  const auto trainer = ParticleTrainer::Make(FourParticles(), motions, {}, QuickParticles());
  while (!trainer->Done()) trainer->RunRound();
  const Eigen::MatrixXf mix = trainer->Network().noise_mix;
  EXPECT_TRUE(mix.isLowerTriangular());
  const Eigen::MatrixXf correlations = mix * mix.transpose();
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(correlations(k, 3 + k), 0.8f, 0.1f) << k;
    EXPECT_NEAR(correlations(k, 6 + k), 0.0f, 0.15f) << k;
  }
  EXPECT_LT((correlations.diagonal().array() - 1.0f).abs().maxCoeff(), 1e-5f);
}

// An arm that swings at random: the mean of where it may be is nearer to the shoulder than the arm
// is long. Charged for bones, the forecast stays about as long.
TEST(ParticleTrainerTest, BonesCanBeLearntToo) {
  std::vector<LearntParticles> motions;
  Random random(5);
  for (int i = 0; i < 6; ++i) {
    LearntParticles swing = {0, SwayingMotion(60, 0.0f, 0.0f)};
    double angle = random.Normal();
    for (int t = 0; t < 60; ++t) {
      angle += 0.4 * random.Normal();
      for (int k = 0; k < 3; ++k) swing.motion(6 + k, t) = swing.motion(3 + k, t);
      swing.motion(6, t) += static_cast<float>(0.3 * std::cos(angle));
      swing.motion(7, t) += static_cast<float>(0.3 * std::sin(angle));
    }
    motions.push_back(swing);
  }
  ParticleTrainingOptions options = QuickParticles();
  options.steps = 100;
  options.noise_steps = 0;
  options.mirrored = 0.0;
  const auto arm_error = [&](double weight) {
    options.bones = weight;
    const auto trainer = ParticleTrainer::Make(FourParticles(), motions, {}, options);
    while (!trainer->Done()) trainer->RunRound();
    const ParticleNetwork network = trainer->Network();
    double error = 0.0;
    for (int start : {0, 10, 20, 30}) {
      const std::vector<ObservedMotion> people = {{motions[0].motion.middleCols(start, 12)}};
      ParticleRollout rollout(network, people);
      for (int t = 0; t < 8; ++t) {
        error += std::abs(BoneLengths(rollout.Step(), FourParticles())(2, 0) - 0.3) / 32.0;
      }
    }
    return error;
  };
  EXPECT_LT(arm_error(10.0), 0.7 * arm_error(0.0));
}

SimlpeTrainingOptions QuickSimlpe() {
  SimlpeTrainingOptions options;
  options.observed = options.predicted = 12;
  options.steps = 150;
  options.batch = 16;
  options.warm_up = 10;
  options.blocks = 3;
  return options;
}

TEST(SimlpeTrainerTest, EigenForecastsWhatLibTorchDoesAndItLearns) {
  const SimlpeTrainingOptions options = QuickSimlpe();
  const auto trainer =
      SimlpeTrainer::Make(FourParticles(), Motions(6, 0.0f), Motions(2, 0.3f), options);
  const TrainingPoint first = trainer->RunRound();
  TrainingPoint last = first;
  while (!trainer->Done()) last = trainer->RunRound();
  EXPECT_LT(last.validation_loss, 0.7 * first.validation_loss);
  const Trajectories seen = SwayingMotion(12, 0.5f);
  const Trajectories torch = trainer->Forecast(seen);
  EXPECT_LT((trainer->Network().Forecast(seen, 12) - torch).cwiseAbs().maxCoeff(), 1e-5f);
  EXPECT_GT((torch.colwise() - seen.col(11)).cwiseAbs().maxCoeff(), 0.01f);
}

}  // namespace
}  // namespace pushid
