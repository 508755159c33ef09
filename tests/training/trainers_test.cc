// Trainers: they learn, repeat themselves, go on where they were broken off, and what they return
// is the network that LibTorch trained, to single precision.
#include <gtest/gtest.h>

#include "models/restoration/cvae_restoration.h"
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
  const auto trainer = MakeRegressionTrainer(Samples(1000, 1), Samples(200, 2), QuickRegression());
  while (!trainer->Done()) trainer->RunRound();
  return trainer->Network();
}

TEST(RegressionTrainerTest, LearnsAndReportsWhatItsWeightsDo) {
  const RegressionSamples held = Samples(200, 2);
  const auto trainer = MakeRegressionTrainer(Samples(1000, 1), held, QuickRegression());
  const TrainingPoint first = trainer->RunRound();
  double best = first.validation_loss;
  while (!trainer->Done()) best = std::min(best, trainer->RunRound().validation_loss);
  EXPECT_LT(best, 0.5 * first.validation_loss);
  const double error = (trainer->Network().Evaluate(held.inputs) - held.targets).cwiseAbs().mean();
  EXPECT_NEAR(error, best, 1e-5);
}

TEST(RegressionTrainerTest, RepeatsItselfToTheLastBit) {
  const DenseNetwork one = TrainedInOneGo(), again = TrainedInOneGo();
  for (size_t i = 0; i < one.layers.size(); ++i) {
    EXPECT_EQ(one.layers[i].weights, again.layers[i].weights);
  }
}

TEST(RegressionTrainerTest, StopsEarlyWhereNothingGetsBetter) {
  RegressionSamples noise = Samples(64, 1), held = Samples(64, 2);
  Random random(8);
  noise.targets = RandomMatrix(2, 64, 1.0, &random);
  held.targets = RandomMatrix(2, 64, 1.0, &random);
  RegressionOptions options = QuickRegression();
  options.epochs = 400;
  options.patience = 5;
  const auto trainer = MakeRegressionTrainer(noise, held, options);
  int epochs = 0;
  while (!trainer->Done()) trainer->RunRound(), ++epochs;
  EXPECT_LT(epochs, 200);
}

TensorList TensorsOf(const CvaeWeights& weights) {
  TensorList tensors;
  AddTensors("", weights, &tensors);
  return tensors;
}

std::vector<CvaeSequence> Sequences(int count, CvaeWeights* scalings,
                                    const CvaeLayout& layout = {}) {
  std::vector<CvaeSequence> sequences;
  for (int i = 0; i < count; ++i) {
    const RestorationInput person = MovingPerson(StandingPose(), 60.0 + 5 * i, 30);
    const BodyMotion motion = RigidRestoration().Restore({person})[0];
    BodyFrames frames = FramesOf(person, motion, layout);
    sequences.push_back({frames, PendulumFrames(person, layout)});
  }
  scalings->layout = layout;
  for (int half = 0; half < layout.num_halves(); ++half) {
    scalings->halves[half].scaling = UnitScaling(layout.Frame(half));
  }
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
  const auto trainer = CvaeTrainer::Make(sequences, sequences, scalings, QuickCvae());
  EXPECT_EQ(trainer->NumParameters(), (std::array<int64_t, 4>{865536, 136960, 1097904, 159232}));
}

TEST(CvaeTrainerTest, TheChainWithoutLibTorchIsTheTrainedOne) {
  CvaeWeights scalings;
  const auto sequences = Sequences(3, &scalings);
  CvaeOptions options = QuickCvae();
  options.steps[3] = 8;  // one round: its loss is that of the weights that are kept
  const auto trainer = CvaeTrainer::Make(sequences, sequences, scalings, options);
  TrainingPoint last;
  while (!trainer->Done()) last = trainer->RunRound();
  EXPECT_EQ(last.stage, "upper sampler");
  const CvaeWeights weights = trainer->Network();
  double error = 0.0;
  for (const CvaeSequence& s : sequences) {
    Eigen::MatrixXf lower = s.body[0].col(0), upper = s.body[1].col(0);
    Eigen::MatrixXf clamped;
    double of_sequence = 0.0;
    for (Eigen::Index t = 1; t < s.body[0].cols(); ++t) {
      Step(weights, kLowerHalf, s.pendulum.col(t), {}, {}, &lower);
      lower = lower.cwiseMax(-kLargestScaled).cwiseMin(kLargestScaled);
      Step(weights, kUpperHalf, s.pendulum.col(t), {}, lower, &upper);
      upper = upper.cwiseMax(-kLargestScaled).cwiseMin(kLargestScaled);
      for (int j = 0; j < 14; ++j) {
        of_sequence += (upper - s.body[1].col(t)).block<3, 1>(3 + 3 * j, 0).norm() / 14;
      }
    }
    error += of_sequence / static_cast<double>(s.body[0].cols() - 1) / 3.0;
  }
  EXPECT_NEAR(error, last.validation_loss, 1e-4 * std::max(1.0, error));
}

// The published training is another one, and draws in its steps.
TEST(CvaeTrainerTest, ThePublishedTrainingKeepsSigmaAndRepeatsItself) {
  CvaeWeights scalings;
  const auto sequences = Sequences(2, &scalings);
  const auto sigma_of = [&](CvaeTraining training) {
    CvaeOptions options = QuickCvae();
    options.training = training;
    const auto trainer = CvaeTrainer::Make(sequences, sequences, scalings, options);
    while (!trainer->Done()) trainer->RunRound();
    return trainer->Network().halves[kLowerHalf].sampler.log_variance.weights;
  };
  const Eigen::MatrixXf published = sigma_of(CvaeTraining::kPublished);
  EXPECT_EQ(published.rows(), kLatent);
  EXPECT_EQ(published, sigma_of(CvaeTraining::kPublished));
  EXPECT_NE(published, sigma_of(CvaeTraining::kOwn));
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
    const auto trainer = CvaeTrainer::Make(sequences, sequences, scalings, QuickCvae());
    for (int i = 0; i < 4; ++i) EXPECT_EQ(trainer->NumParameters()[i] > 0, c.stages[i]) << i;
    TrainingPoint last;
    while (!trainer->Done()) last = trainer->RunRound();
    EXPECT_EQ(last.stage, c.last);
    const TensorList trained = TensorsOf(trainer->Network());
    TensorFields reader(trained);
    const CvaeWeights taken = TakeTensors("", CvaeWeights{c.layout, {}, {}}, &reader);
    EXPECT_EQ(reader.problem(), "");
    EXPECT_EQ(TensorsOf(taken).size(), trained.size());
  }
}

}  // namespace
}  // namespace pushid
