// The losses of the networks that LibTorch trains. LDP's chain: its losses by hand, and the
// foot-skate error of the lower sampler by hand in both coordinates, as the metric has it, and its
// gradient in three regimes. Particles: SDE's Eq. 10 and 11 worked by hand; values of Eq. 6 and 12,
// and the gradients of Eq. 6, against the numbers of sde_numbers.py.
#include <gtest/gtest.h>

#include <cmath>

#include "ident/bodies/body_evaluation.h"
#include "models/generators/particle_module_torch.h"
#include "models/restoration/cvae_module_torch.h"
#include "tests/models/body_samples.h"
#include "tests/models/generators/generator_samples.h"

namespace pushid {
namespace {

// LDP's chain.

constexpr double kH = 0.025;
constexpr int kRight = 3 + 3 * 3;  // the right ankle's row in a lower frame: hip, hip, knee, ankle
constexpr int kHip = 3;

Tensor RowsOf(const Eigen::MatrixXd& columns) {
  return torch::from_blob(const_cast<double*>(columns.data()), {columns.cols(), columns.rows()},
                          torch::kFloat64)
      .clone();
}

// One sample of two latent variables. mu = (1, 2), mu_e = (0, 4): 1 + 4 = 5. Log-variances 0 and
// 2 ln 3, so sigma = (1, 3), and sigma_e = (1, 1): 0 + 4. Eq. 7 is their sum, 9. Ours has means,
// 5 / 2, and log-variances, (2 ln 3)^2 / 2 = 2.4139.
TEST(CvaeLossTest, OfTheSamplerByHand) {
  const Gaussian sampled = {RowsOf(Eigen::Vector2d(1.0, 2.0)),
                            RowsOf(Eigen::Vector2d(0.0, 2.0 * std::log(3.0)))};
  const Gaussian encoded = {RowsOf(Eigen::Vector2d(0.0, 4.0)), RowsOf(Eigen::Vector2d(0.0, 0.0))};
  const auto loss = [&](CvaeTraining training) {
    return SamplerLossOf(training, sampled, encoded).item<double>();
  };
  EXPECT_NEAR(loss(CvaeTraining::kPublished), 9.0, 1e-12);
  EXPECT_NEAR(loss(CvaeTraining::kOwn), 2.5 + 2.4139, 1e-4);
}

// Errors 1 and 3: a mean square of 5. KL of N(1, 1) is 0.5, of N(0, 4) -0.5 (1 + ln 4 - 4) =
// 0.80685: a mean of 0.653426, times 0.005.
TEST(CvaeLossTest, OfTheAutoencoderByHand) {
  const Gaussian encoded = {RowsOf(Eigen::Vector2d(1.0, 0.0)),
                            RowsOf(Eigen::Vector2d(0.0, std::log(4.0)))};
  const Tensor output = RowsOf(Eigen::Vector2d(2.0, 1.0)),
               frame = RowsOf(Eigen::Vector2d(1.0, 4.0));
  EXPECT_NEAR(AutoencoderLossOf({}, encoded, output, frame).item<double>(), 5.0 + 0.005 * 0.653426,
              1e-8);
}

// Half of the way from 1e-4 to 1e-7 is 5.005e-5.
TEST(CvaeLossTest, PublishedRatesByHand) {
  CvaeOptions options;
  options.training = CvaeTraining::kPublished;
  for (const auto& [done, rate] :
       {std::pair(0.0, 1e-4), std::pair(0.5, 5.005e-5), std::pair(1.0, 1e-7)}) {
    EXPECT_NEAR(CvaeLearningRate(options, false, done), rate, 1e-15);
    EXPECT_EQ(CvaeLearningRate(options, true, done), 1e-4);
  }
}

// Not scaled, a column per sample.
struct CvaeSkateFrames {
  Eigen::MatrixXd output, before, first;     // of the lower body: output, started from, frame 0
  Eigen::MatrixXd pendulum, first_pendulum;  // of the output's frame and of frame 0
};

// by_output: the gradient, of the shape of `output`.
double CvaeFootSkate(const CvaeLayout& layout, const CvaeSkateFrames& frames,
                     Eigen::MatrixXd* by_output) {
  SkateTensors rows = {RowsOf(frames.output), RowsOf(frames.before), RowsOf(frames.first),
                       RowsOf(frames.pendulum), RowsOf(frames.first_pendulum)};
  rows.output.set_requires_grad(true);
  const Tensor skate = FootSkateOf(layout, rows);
  skate.sum().backward();
  const Tensor gradient = rows.output.grad().contiguous();
  *by_output = Eigen::Map<const Eigen::MatrixXd>(gradient.data_ptr<double>(), frames.output.rows(),
                                                 frames.output.cols());
  return skate.item<double>();
}

// Frames 0, t and t + 1 of a motion and its pendulum; the last is the network's output.
CvaeSkateFrames FramesAt(const RestorationInput& person, const BodyMotion& motion, int t,
                         const CvaeLayout& layout) {
  const Eigen::MatrixXd body = FramesOf(person, motion, layout)[kLowerHalf].cast<double>();
  const Eigen::MatrixXd pendulum = PendulumFrames(person, layout).cast<double>();
  return {body.col(t + 1), body.col(t), body.col(0), pendulum.col(t + 1), pendulum.col(0)};
}

double Skate(const CvaeLayout& layout, const CvaeSkateFrames& frames) {
  Eigen::MatrixXd unused;
  return CvaeFootSkate(layout, frames, &unused);
}

// The hip goes on and sinks; the right ankle moves `slide` m a frame, `height` m above its first
// height; the left ankle is in the air.
BodyMotion OneAnkle(const RestorationInput& person, double slide, double height) {
  BodyMotion motion;
  for (size_t t = 0; t < person.q.size(); ++t) {
    Pose pose = person.first_pose;
    pose.col(kBodyHip) = TipAt(person, static_cast<int>(t));
    pose(0, kRightAnkle) += slide * static_cast<double>(t);
    if (t > 0) pose(2, kRightAnkle) += height;
    if (t > 0) pose(2, kLeftAnkle) += 0.1;
    motion.push_back(pose);
  }
  return motion;
}

TEST(CvaeSkateTest, OneAnkleByHandInBothCoordinates) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20);
  ASSERT_GT((TipAt(person, 11) - TipAt(person, 10)).norm(), 1e-3) << "the hip moves";
  for (const CvaeCoordinates coordinates : {CvaeCoordinates::kTip, CvaeCoordinates::kLdp}) {
    const CvaeLayout layout = {coordinates};
    const auto skate = [&](double slide, double height) {
      return Skate(layout, FramesAt(person, OneAnkle(person, slide, height), 10, layout));
    };
    EXPECT_NEAR(skate(0.0, 0.0), 0.0, 2e-5) << NameOf(coordinates);
    EXPECT_NEAR(skate(0.01, 0.0), 1.0, 1e-4) << NameOf(coordinates);
    EXPECT_NEAR(skate(0.01, kH / 2), 2.0 - std::sqrt(2.0), 1e-4) << NameOf(coordinates);
    EXPECT_NEAR(skate(0.01, -0.01), 1.0, 1e-4) << "weights of low ankles are 1";
    EXPECT_EQ(skate(0.01, kH + 0.001), 0.0) << NameOf(coordinates);
  }
}

TEST(CvaeSkateTest, AStandingAnkleHasNoGradientThatIsNoNumber) {
  const CvaeLayout layout = {CvaeCoordinates::kLdp};
  CvaeSkateFrames frames;
  frames.output = frames.before = frames.first = Eigen::MatrixXd::Zero(layout.Frame(kLowerHalf), 2);
  frames.pendulum = frames.first_pendulum = Eigen::MatrixXd::Zero(kPendulumFrame, 2);
  Eigen::MatrixXd gradient;
  EXPECT_EQ(CvaeFootSkate(layout, frames, &gradient), 0.0);
  EXPECT_TRUE(gradient.allFinite());
}

// Over a motion it is the metric: its contacts, frame by frame.
TEST(CvaeSkateTest, IsTheMetricOfAMotion) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20);
  Random random(4);
  BodyMotion motion;
  for (int t = 0; t < 20; ++t) {
    Pose pose = person.first_pose.colwise() + (TipAt(person, t) - person.first_pose.col(0));
    for (int ankle : {kRightAnkle, kLeftAnkle}) {
      if (t > 0)
        pose.col(ankle) = person.first_pose.col(ankle) +
                          0.02 * Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal());
    }
    motion.push_back(pose);
  }
  for (const CvaeCoordinates coordinates : {CvaeCoordinates::kTip, CvaeCoordinates::kLdp}) {
    const CvaeLayout layout = {coordinates};
    const Eigen::MatrixXd body = FramesOf(person, motion, layout)[kLowerHalf].cast<double>();
    const Eigen::MatrixXd pendulum = PendulumFrames(person, layout).cast<double>();
    const CvaeSkateFrames frames = {body.rightCols(19), body.leftCols(19),
                                    body.col(0).replicate(1, 19), pendulum.rightCols(19),
                                    pendulum.col(0).replicate(1, 19)};
    EXPECT_NEAR(Skate(layout, frames), FootSkate(motion), 1e-4) << NameOf(coordinates);
  }
}

// Heights of the right ankle: under its first one, where its weight changes, and in the air.
TEST(CvaeSkateTest, TheGradientIsThatOfDifferences) {
  constexpr double kStep = 1e-6;
  for (const double height : {-0.01, 0.6 * kH, 2.0 * kH}) {
    for (const CvaeCoordinates coordinates : {CvaeCoordinates::kTip, CvaeCoordinates::kLdp}) {
      const CvaeLayout layout = {coordinates};
      const RestorationInput person = MovingPerson(StandingPose(), 80, 20);
      const CvaeSkateFrames frames = FramesAt(person, OneAnkle(person, 0.02, height), 10, layout);
      Eigen::MatrixXd gradient;
      CvaeFootSkate(layout, frames, &gradient);
      for (int row = 0; row < layout.Frame(kLowerHalf); ++row) {
        CvaeSkateFrames up = frames, down = frames;
        up.output(row, 0) += kStep, down.output(row, 0) -= kStep;
        const double slope = (Skate(layout, up) - Skate(layout, down)) / (2.0 * kStep);
        EXPECT_NEAR(gradient(row, 0), slope, 1e-5 * std::max(1.0, std::abs(slope)))
            << "height " << height << ", " << NameOf(coordinates) << ", row " << row;
      }
      EXPECT_EQ(gradient(kHip, 0), 0.0) << "only ankles count";
      EXPECT_EQ(gradient(kRight, 0) != 0.0, height < kH);
      EXPECT_EQ(gradient(kRight + 2, 0) != 0.0, height > 0.0 && height < kH);
    }
  }
}

// Particles.

constexpr int kObserved = 2, kPredicted = 3;

ParticleTrainingOptions Weighing(double distance, double squared, double bones) {
  ParticleTrainingOptions options;
  options.observed = kObserved, options.predicted = kPredicted;
  options.even_frames = true;
  options.distance = distance, options.squared = squared, options.bones = bones;
  return options;
}

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

torch::Tensor Doubles(std::vector<double> values, std::vector<int64_t> shape) {
  return torch::tensor(values, torch::kFloat64).reshape(shape);
}

// Two transitions of three coordinates. Of `below` all that is not below the diagonal is 9, which
// nothing may depend on.
TEST(ParticleLossesTest, Equation6IsThatOfTheScript) {
  const auto of_frames = [](std::vector<double> values) {
    return Doubles(std::move(values), {2, 3}).requires_grad_(true);
  };
  const torch::Tensor misses = of_frames({0.5, -1.0, 0.25, -0.75, 0.5, 1.5});
  const torch::Tensor log_noise = of_frames({0.1, -0.4, 0.3, -0.2, 0.0, -0.5});
  const torch::Tensor below = Doubles({9, 9, 9, 0.2, 9, 9, -0.3, 0.4, 9,   //
                                       9, 9, 9, 0.6, 9, 9, 0.1, -0.5, 9},  //
                                      {2, 3, 3})
                                  .requires_grad_(true);
  const torch::Tensor w = Doubles({1.0, -0.5, 2.0, 0.3, -1.2, -0.7}, {2, 3});
  const auto expect = [&](NoiseLoss reading, double value, std::vector<double> by_misses,
                          std::vector<double> by_log_noise, std::vector<double> by_below) {
    const torch::Tensor loss = TransitionLoss(reading, misses, log_noise, below, w).mean();
    EXPECT_NEAR(loss.item<double>(), value, 1e-11);
    const auto found = torch::autograd::grad({loss}, {misses, log_noise, below});
    for (int t = 0; t < 2; ++t) {
      const torch::Tensor g = found[2][t];
      const torch::Tensor lower = torch::stack({g[1][0], g[2][0], g[2][1]});
      EXPECT_NEAR((g.abs().sum() - lower.abs().sum()).item<double>(), 0.0, 1e-12);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(found[0][t][i].item<double>(), by_misses[3 * t + i], 1e-11) << t << " " << i;
        EXPECT_NEAR(found[1][t][i].item<double>(), by_log_noise[3 * t + i], 1e-11) << t << " " << i;
        EXPECT_NEAR(lower[i].item<double>(), by_below[3 * t + i], 1e-11) << t << " " << i;
      }
    }
  };
  expect(NoiseLoss::kDrawn, 1.648858619573,
         {-0.201723639359, -0.288279992327, -0.649905871717, -0.331873075308, 0.506666666667,
          0.431523820600},
         {0.222939099707, -0.096619928864, 1.754562330066, 0.081514407862, 0.608000000000,
          0.183212699313},
         {0.288279992327, 0.649905871717, -0.324952935859, -0.152000000000, -0.129457146180,
          0.517828584720});
  expect(NoiseLoss::kLikelihood, 1.346454193846,
         {0.177398282765, -0.461057590631, 0.094802622442, -0.783131310163, 0.654357563247,
          0.958838046104},
         {0.077967525284, -0.336109139951, 0.068408503420, -0.420681815956, -0.520167474615,
          -1.862638144258},
         {0.208591079936, -0.042890480057, 0.154225909048, 0.599425599430, 0.878345575605,
          -1.006426368415});
  // Without what is below it g is diagonal: the first coordinate alone feels no difference.
  const torch::Tensor diagonal = TransitionLoss(NoiseLoss::kLikelihood, misses, log_noise, {}, {});
  const torch::Tensor full = TransitionLoss(NoiseLoss::kLikelihood, misses, log_noise, below, {});
  EXPECT_NEAR(diagonal[0][0].item<double>(), full[0][0].item<double>(), 1e-12);
  EXPECT_GT(std::abs((diagonal - full)[0][1].item<double>()), 0.01);
}

// A critic of the script's weights: weight (i, j) of layer l is 2 sin(1 + i + 3 j + l) /
// sqrt(inputs), bias 0.1 cos(i + l). That it takes them shows how many layers it has.
TEST(ParticleLossesTest, Equation12IsThatOfTheScript) {
  ParticleCritic critic(6, torch::ones({6}, torch::kFloat64));
  critic.to(torch::kFloat64);
  const auto parameters = critic.parameters();
  ASSERT_EQ(parameters.size(), 6u) << "three layers";
  {
    torch::NoGradGuard no_grad;
    for (int l = 0; l < 3; ++l) {
      const int64_t outputs = parameters[2 * l].size(0), inputs = parameters[2 * l].size(1);
      EXPECT_EQ(outputs, l < 2 ? 256 : 1);
      const torch::Tensor i = torch::arange(outputs, torch::kFloat64).unsqueeze(1);
      const torch::Tensor j = torch::arange(inputs, torch::kFloat64);
      parameters[2 * l].copy_((1 + i + 3 * j + l).sin() * 2.0 / std::sqrt(inputs));
      parameters[2 * l + 1].copy_(0.1 * (i.squeeze(1) + l).cos());
    }
  }
  const torch::Tensor made =
      Doubles({0.3, -0.2, 0.5, 0.1, -0.4, 0.6, -0.5, 0.2, 0.1, 0.7, 0.3, -0.1}, {2, 6});
  const torch::Tensor real =
      Doubles({0.1, 0.4, -0.3, 0.2, 0.2, 0.5, 0.6, -0.6, 0.2, -0.2, 0.4, 0.3}, {2, 6});
  EXPECT_NEAR(critic.Score(made).item<double>(), -0.028164865, 1e-8);
  EXPECT_NEAR(critic.Score(real).item<double>(), 0.076286115, 1e-8);
  EXPECT_NEAR(critic.Loss(made, real, Doubles({0.25, 0.7}, {2, 1})).item<double>(), 6.6191003,
              1e-5);
}

}  // namespace
}  // namespace pushid
