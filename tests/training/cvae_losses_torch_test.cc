// What LDP's chain is trained against: its losses by hand, and the foot-skate error of the lower
// sampler by hand in both coordinates, as the metric has it, and its gradient in three regimes.
#include <gtest/gtest.h>

#include <cmath>

#include "ident/bodies/body_evaluation.h"
#include "models/restoration/cvae_module_torch.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

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

}  // namespace
}  // namespace pushid
