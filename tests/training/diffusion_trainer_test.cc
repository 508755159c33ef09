// The trainer of the diffusion network: it learns, repeats itself, goes on where it was broken off,
// and what it returns is the network that LibTorch trained, to 1e-5.
#include <gtest/gtest.h>

#include "models/generators/generator_trainers.h"
#include "tests/models/generators/diffusion_samples.h"

namespace pushid {
namespace {

std::vector<ObservedGroup> PushedGroups() {
  std::vector<ObservedGroup> groups;
  for (int i = 0; i < 6; ++i) {
    groups.push_back(PushedGroup(2 + i % 2, 36 + i, 2.0f + static_cast<float>(i)));
  }
  groups.push_back(PushedGroup(1, 40));
  return groups;
}

DiffusionTrainingOptions QuickDiffusion(int steps) {
  DiffusionTrainingOptions options;
  options.steps = steps;
  options.groups = 2;
  options.people_alone = 2;
  options.warm_up = 5;
  return options;
}

void ExpectSameTensors(const DiffusionNetwork& a, const DiffusionNetwork& b) {
  TensorList of_a, of_b;
  AddTensors("n", a, &of_a);
  AddTensors("n", b, &of_b);
  ASSERT_EQ(of_a.size(), of_b.size());
  for (size_t i = 0; i < of_a.size(); ++i) {
    EXPECT_TRUE(of_a[i].values == of_b[i].values) << of_a[i].name;
  }
}

TEST(DiffusionTrainerTest, Learns) {
  const auto trainer = DiffusionTrainer::Make(PushedGroups(), PushedGroups(), QuickDiffusion(100));
  const TrainingPoint first = trainer->RunRound();
  TrainingPoint last = first;
  while (!trainer->Done()) last = trainer->RunRound();
  EXPECT_EQ(last.epoch, 100);
  EXPECT_LT(last.validation_loss, 0.9 * first.validation_loss);
}

TEST(DiffusionTrainerTest, RepeatsItselfToTheLastBit) {
  const auto trained = [] {
    const auto trainer =
        DiffusionTrainer::Make(PushedGroups(), PushedGroups(), QuickDiffusion(2 * kStepsOfRound));
    while (!trainer->Done()) trainer->RunRound();
    return trainer->Network();
  };
  ExpectSameTensors(trained(), trained());
}

void ExpectEigenIsLibTorch(const DiffusionStructure& structure, const std::string& name) {
  DiffusionTrainingOptions options = QuickDiffusion(10);
  options.structure = structure;
  if (structure.frame == MotionFrame::kOwn) options.joint_weight = 0.0;
  const std::vector<ObservedGroup> groups = PushedGroups();
  const auto trainer = DiffusionTrainer::Make(groups, {}, options);
  while (!trainer->Done()) trainer->RunRound();
  const DiffusionNetwork network = trainer->Network();
  const GroupFeatures features = FeaturesOf(groups[1], network.scales, 3, 37, options.dt);
  Random random(2);
  const Eigen::MatrixXf noisy =
      RandomMatrix(structure.NumMotion(), 37 * features.people, 1.0, &random);
  const Eigen::MatrixXf torch = trainer->Estimate(features, noisy, 440.0);
  const Eigen::MatrixXf eigen = GroupDenoiser(network, features).Estimate(noisy, 440.0);
  EXPECT_LT((torch - eigen).cwiseAbs().maxCoeff(), 1e-5f) << name;
}

TEST(DiffusionTrainerTest, EigenEstimatesWhatLibTorchDoes) {
  for (const auto& row : Names(SocialPooling{})) {
    for (const auto& join : Names(SocialJoin{})) {
      const std::string name = std::string(row.name) + " " + join.name;
      ExpectEigenIsLibTorch({row.value, join.value}, name);
      ExpectEigenIsLibTorch({row.value, join.value, MotionFrame::kOwn}, name + ", own");
    }
  }
}

// Eq. 4 of SDM by hand, with the network that has not learned: it estimates x_0 = 0. Of two people
// of three frames one moves 0.1 m a frame. The hip's scale is sqrt((0.1^2 + 0.2^2) / 3 / 6) =
// 0.0527046 m, and the only rows that are not 0 are 0.1 and 0.2 m over it: 5.69210 in all, of
// 2 x 3 x 66 rows. Where frame 0, which is shown, weighs 0.1, there are 4.2 frames instead of 6.
TEST(DiffusionTrainerTest, Equation4ByHand) {
  ObservedGroup group(2);
  for (ObservedMotion& person : group) person.frames = Trajectories::Zero(3 * kBodyJoints, 3);
  group[1].place = {1.0f, 0.0f};
  for (int j = 0; j < kBodyJoints; ++j) group[0].frames.row(3 * j) << 0.0f, 0.1f, 0.2f;
  DiffusionTrainingOptions options = QuickDiffusion(0);
  options.joint_weight = options.difference_weight = 0.0;
  const auto loss = [&] {
    return DiffusionTrainer::Make({group}, {group}, options)->RunRound().validation_loss;
  };
  options.observed_weight = 1.0;
  EXPECT_NEAR(loss(), 5.69210 / (6 * 66), 1e-6);
  options.observed_weight = 0.1;
  EXPECT_NEAR(loss(), 5.69210 / (4.2 * 66), 1e-6);
  options.difference_weight = 2.0;  // pushid's other terms add to it
  EXPECT_GT(loss(), 5.69210 / (4.2 * 66) + 1e-3);
}

}  // namespace
}  // namespace pushid
