// Trainers: they learn, repeat themselves, go on where they were broken off, and what they return
// is the network that LibTorch trained, to single precision.
#include <gtest/gtest.h>

#include "models/restoration/cvae_restoration.h"
#include "models/restoration/cvae_trainer.h"
#include "models/restoration/trainer.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

// y = a bent function of x.
RegressionSamples Samples(int count, uint64_t seed) {
  Random random(seed);
  RegressionSamples samples;
  samples.inputs = RandomMatrix(3, count, 1.0, &random);
  samples.targets.resize(2, count);
  samples.targets.row(0) = samples.inputs.row(0).array().square();
  samples.targets.row(1) = samples.inputs.row(1) - samples.inputs.row(2);
  samples.weights = Eigen::VectorXf::Ones(count);
  return samples;
}

RegressionOptions QuickRegression() {
  RegressionOptions options;
  options.hidden = 32;
  options.dropout = 0.1;
  options.input_noise = 0.01;
  options.epochs = 12;
  options.batch = 64;
  return options;
}

DenseNetwork TrainedInOneGo() {
  RegressionTrainer trainer(Samples(1000, 1), Samples(200, 2), QuickRegression());
  while (!trainer.Done()) trainer.RunRound();
  return trainer.Best();
}

TEST(RegressionTrainerTest, LearnsAndReportsWhatItsWeightsDo) {
  const RegressionSamples held = Samples(200, 2);
  RegressionTrainer trainer(Samples(1000, 1), held, QuickRegression());
  const TrainingPoint first = trainer.RunRound();
  double best = first.validation_loss;
  while (!trainer.Done()) best = std::min(best, trainer.RunRound().validation_loss);
  EXPECT_LT(best, 0.5 * first.validation_loss);
  const double error = (trainer.Best().Evaluate(held.inputs) - held.targets).cwiseAbs().mean();
  EXPECT_NEAR(error, best, 1e-5);
}

TEST(RegressionTrainerTest, RepeatsItselfAndResumesToTheLastBit) {
  const DenseNetwork one = TrainedInOneGo(), again = TrainedInOneGo();
  RegressionTrainer broken(Samples(1000, 1), Samples(200, 2), QuickRegression());
  for (int i = 0; i < 5; ++i) broken.RunRound();
  const std::string state = broken.State();
  RegressionTrainer resumed(Samples(1000, 1), Samples(200, 2), QuickRegression());
  ASSERT_TRUE(resumed.Resume(state));
  while (!resumed.Done()) resumed.RunRound();
  for (size_t i = 0; i < one.layers.size(); ++i) {
    EXPECT_EQ(one.layers[i].weights, again.layers[i].weights);
    EXPECT_EQ(one.layers[i].weights, resumed.Best().layers[i].weights);
  }
  EXPECT_FALSE(resumed.Resume("no state"));
}

TEST(RegressionTrainerTest, StopsEarlyWhereNothingGetsBetter) {
  RegressionSamples noise = Samples(64, 1), held = Samples(64, 2);
  Random random(8);
  noise.targets = RandomMatrix(2, 64, 1.0, &random);
  held.targets = RandomMatrix(2, 64, 1.0, &random);
  RegressionOptions options = QuickRegression();
  options.epochs = 400;
  options.patience = 5;
  RegressionTrainer trainer(noise, held, options);
  int epochs = 0;
  while (!trainer.Done()) trainer.RunRound(), ++epochs;
  EXPECT_LT(epochs, 200);
}

std::vector<CvaeSequence> Sequences(int count, CvaeWeights* scalings,
                                    const CvaeLayout& layout = {}) {
  std::vector<CvaeSequence> sequences;
  for (int i = 0; i < count; ++i) {
    const RestorationInput person = MovingPerson(StandingPose(), 60.0 + 5 * i, 30);
    const BodyMotion motion = RigidRestoration().Restore({person})[0];
    BodyFrames frames = FramesOf(person, motion, layout);
    sequences.push_back({frames.lower, frames.upper, PendulumFrames(person, layout)});
  }
  scalings->layout = layout;
  scalings->lower = UnitScaling(layout.LowerFrame());
  scalings->upper = UnitScaling(layout.UpperFrame());
  scalings->pendulum = UnitScaling(layout.PendulumFrame());
  return sequences;
}

CvaeOptions QuickCvae() {
  CvaeOptions options;
  options.steps = {24, 16, 24, 16};
  options.round = 8;
  options.batch = 8;
  return options;
}

TEST(CvaeTrainerTest, ParametersAreLdps) {
  CvaeWeights scalings;
  const auto sequences = Sequences(2, &scalings);
  const CvaeTrainer trainer(sequences, sequences, scalings, QuickCvae());
  EXPECT_EQ(trainer.NumParameters(), (std::array<int64_t, 4>{865536, 136960, 1097904, 159232}));
}

// One sample of two latent variables. mu = (1, 2), mu_e = (0, 4): 1 + 4 = 5. Log-variances 0 and
// 2 ln 3, so sigma = (1, 3), and sigma_e = (1, 1): 0 + 4. Eq. 7 is their sum, 9. Ours has means,
// 5 / 2, and log-variances, (2 ln 3)^2 / 2 = 2.4139.
TEST(CvaeTrainerTest, LossOfTheSamplerByHand) {
  CvaeGaussian sampled{Eigen::MatrixXd(2, 1), Eigen::MatrixXd(2, 1)}, encoded = sampled;
  sampled.mean << 1.0, 2.0, sampled.log_variance << 0.0, 2.0 * std::log(3.0);
  encoded.mean << 0.0, 4.0, encoded.log_variance << 0.0, 0.0;
  EXPECT_NEAR(CvaeSamplerLoss(CvaeTraining::kPublished, sampled, encoded), 9.0, 1e-12);
  EXPECT_NEAR(CvaeSamplerLoss(CvaeTraining::kOwn, sampled, encoded), 2.5 + 2.4139, 1e-4);
}

// Errors 1 and 3: a mean square of 5. KL of N(1, 1) is 0.5, of N(0, 4) -0.5 (1 + ln 4 - 4) =
// 0.80685: a mean of 0.653426, times 0.005.
TEST(CvaeTrainerTest, LossOfTheAutoencoderByHand) {
  CvaeGaussian encoded{Eigen::MatrixXd(2, 1), Eigen::MatrixXd(2, 1)};
  encoded.mean << 1.0, 0.0, encoded.log_variance << 0.0, std::log(4.0);
  const Eigen::MatrixXd output = Eigen::Vector2d(2.0, 1.0), frame = Eigen::Vector2d(1.0, 4.0);
  EXPECT_NEAR(CvaeAutoencoderLoss({}, encoded, output, frame), 5.0 + 0.005 * 0.653426, 1e-8);
}

// Half of the way from 1e-4 to 1e-7 is 5.005e-5.
TEST(CvaeTrainerTest, PublishedRatesByHand) {
  CvaeOptions options;
  options.training = CvaeTraining::kPublished;
  for (const auto& [done, rate] :
       {std::pair(0.0, 1e-4), std::pair(0.5, 5.005e-5), std::pair(1.0, 1e-7)}) {
    EXPECT_NEAR(CvaeLearningRate(options, false, done), rate, 1e-15);
    EXPECT_EQ(CvaeLearningRate(options, true, done), 1e-4);
  }
}

TEST(CvaeTrainerTest, TheChainWithoutLibTorchIsTheTrainedOne) {
  CvaeWeights scalings;
  const auto sequences = Sequences(3, &scalings);
  CvaeOptions options = QuickCvae();
  options.steps[3] = 8;  // one round: its loss is that of the weights that are kept
  CvaeTrainer trainer(sequences, sequences, scalings, options);
  TrainingPoint last;
  while (!trainer.Done()) last = trainer.RunRound();
  EXPECT_EQ(last.stage, "upper sampler");
  const CvaeWeights weights = trainer.Best();
  double error = 0.0;
  for (const CvaeSequence& s : sequences) {
    Eigen::MatrixXf lower = s.lower.col(0), upper = s.upper.col(0);
    Eigen::MatrixXf clamped;
    double of_sequence = 0.0;
    for (Eigen::Index t = 1; t < s.lower.cols(); ++t) {
      StepLower(weights, s.pendulum.col(t), {}, &lower);
      lower = lower.cwiseMax(-kLargestScaled).cwiseMin(kLargestScaled);
      StepUpper(weights, s.pendulum.col(t), {}, lower, &upper);
      upper = upper.cwiseMax(-kLargestScaled).cwiseMin(kLargestScaled);
      for (int j = 0; j < 14; ++j) {
        of_sequence += (upper - s.upper.col(t)).block<3, 1>(3 + 3 * j, 0).norm() / 14;
      }
    }
    error += of_sequence / static_cast<double>(s.lower.cols() - 1) / 3.0;
  }
  EXPECT_NEAR(error, last.validation_loss, 1e-4 * std::max(1.0, error));
}

// The published training is another one, draws in its steps, and resumes all the same.
TEST(CvaeTrainerTest, ThePublishedTrainingKeepsSigmaAndResumes) {
  CvaeWeights scalings;
  const auto sequences = Sequences(2, &scalings);
  CvaeOptions options = QuickCvae();
  CvaeTrainer own(sequences, sequences, scalings, options);
  while (!own.Done()) own.RunRound();
  options.training = CvaeTraining::kPublished;
  CvaeTrainer published(sequences, sequences, scalings, options);
  std::string state;
  for (int round = 0; !published.Done(); ++round) {
    published.RunRound();
    if (round == 3) state = published.State();  // in the lower sampler
  }
  CvaeTrainer resumed(sequences, sequences, scalings, options);
  ASSERT_TRUE(resumed.Resume(state));
  while (!resumed.Done()) resumed.RunRound();
  const auto sigma_of = [](const CvaeTrainer& trainer) {
    return trainer.Best().lower_sampler.log_variance.weights;
  };
  EXPECT_EQ(sigma_of(published).rows(), kLatent);
  EXPECT_EQ(sigma_of(published), sigma_of(resumed));
  EXPECT_NE(sigma_of(published), sigma_of(own));
}

TEST(CvaeTrainerTest, ResumesToTheLastBitInTheMiddleOfAnyStage) {
  CvaeWeights scalings;
  const auto sequences = Sequences(2, &scalings);
  CvaeTrainer whole(sequences, sequences, scalings, QuickCvae());
  while (!whole.Done()) whole.RunRound();
  for (int rounds : {2, 4, 6, 9}) {  // 3, 2, 3 and 2 rounds a stage
    CvaeTrainer broken(sequences, sequences, scalings, QuickCvae());
    for (int i = 0; i < rounds; ++i) broken.RunRound();
    const std::string state = broken.State();
    CvaeTrainer resumed(sequences, sequences, scalings, QuickCvae());
    ASSERT_TRUE(resumed.Resume(state)) << rounds;
    while (!resumed.Done()) resumed.RunRound();
    const TensorList a = ToTensors(whole.Best()), b = ToTensors(resumed.Best());
    for (size_t i = 0; i < a.size(); ++i)
      EXPECT_EQ(a[i].values, b[i].values) << rounds << a[i].name;
  }
}

// What a chain of another layout predicts is what its trainer returned, and its stages are those of
// the layout.
TEST(CvaeTrainerTest, LayoutsOfTheAblationAreTrained) {
  struct Case {
    CvaeLayout layout;
    const char* last;  // stage
    std::array<bool, 4> stages;
  };
  const Case cases[] = {
      {{CvaeCoordinates::kTip, true, false}, "lower sampler", {true, true, false, false}},
      {{CvaeCoordinates::kTip, false, true}, "upper autoencoder", {true, false, true, false}},
      {{CvaeCoordinates::kTip, false, false}, "lower autoencoder", {true, false, false, false}},
  };
  for (const Case& c : cases) {
    CvaeWeights scalings;
    const auto sequences = Sequences(2, &scalings, c.layout);
    CvaeTrainer trainer(sequences, sequences, scalings, QuickCvae());
    for (int i = 0; i < 4; ++i) EXPECT_EQ(trainer.NumParameters()[i] > 0, c.stages[i]) << i;
    std::string state;
    TrainingPoint last;
    while (!trainer.Done()) {
      last = trainer.RunRound();
      if (state.empty()) state = trainer.State();
    }
    EXPECT_EQ(last.stage, c.last);
    CvaeTrainer resumed(sequences, sequences, scalings, QuickCvae());
    ASSERT_TRUE(resumed.Resume(state)) << c.last;
    while (!resumed.Done()) resumed.RunRound();
    const TensorList trained = ToTensors(trainer.Best()), again = ToTensors(resumed.Best());
    for (size_t i = 0; i < trained.size(); ++i) EXPECT_EQ(trained[i].values, again[i].values);
    TensorReader reader(trained);
    const CvaeWeights taken = TakeCvae(c.layout, &reader);
    EXPECT_EQ(reader.problem(), "");
    EXPECT_EQ(ToTensors(taken).size(), trained.size());
  }
}

}  // namespace
}  // namespace pushid
