// The trainer of MRT: it learns, repeats itself, goes on where it was broken off, and what it
// returns is the network that LibTorch trained.
#include "models/peers/mrt_trainer.h"

#include <gtest/gtest.h>

#include "tests/models/mrt_samples.h"

namespace pushid {
namespace {

std::vector<MrtGroup> WalkingGroups() {
  return {{WalkingGroup(2, 60), 1.0}, {WalkingGroup(3, 50), 0.5}, {WalkingGroup(1, 45), 1.0}};
}

MrtOptions QuickMrt() {
  MrtOptions options;
  options.epochs = 4;
  options.windows = 24;
  options.batch = 4;
  return options;
}

TEST(MrtTrainerTest, LearnsAndReportsWhatItsWeightsDo) {
  MrtOptions options = QuickMrt();
  options.epochs = 12;
  MrtTrainer trainer(WalkingGroups(), WalkingGroups(), options);
  const TrainingPoint first = trainer.RunRound();
  double best = first.validation_loss;
  while (!trainer.Done()) best = std::min(best, trainer.RunRound().validation_loss);
  EXPECT_LT(best, 0.7 * first.validation_loss);
  const MrtPeer peer(trainer.Best());
  double error = 0.0;
  for (const MrtGroup& group : WalkingGroups()) {
    const int frames = static_cast<int>(group.people[0].size());
    const std::vector<BodyMotion> said = peer.Continue(group.people, frames);
    double of_group = 0.0;
    for (size_t n = 0; n < group.people.size(); ++n) {
      for (int t = 20; t < frames; ++t) {
        for (int j = 0; j < kBodyJoints; ++j) {
          of_group += (said[n][t].col(j) - group.people[n][t].col(j)).norm();
        }
      }
    }
    error += of_group / static_cast<double>(group.people.size() * (frames - 20) * 22) / 3.0;
  }
  EXPECT_NEAR(error, best, 1e-9);
}

TEST(MrtTrainerTest, TheNetworkWithoutLibTorchIsTheTrainedOne) {
  for (const MrtSize size : {MrtSize::kSmall, MrtSize::kPublished}) {
    MrtOptions options = QuickMrt();
    options.size = size;
    options.windows = 4;
    MrtTrainer trainer(WalkingGroups(), WalkingGroups(), options);
    trainer.RunRound();
    const MrtView view = MrtViewOf(WalkingGroup(3, 20), 19, 1);
    const Eigen::MatrixXf ways = PredictedWays(trainer.Best(), view);
    EXPECT_GT(ways.norm(), 0.1);
    EXPECT_LT((ways - trainer.LibTorchWays(view)).cwiseAbs().maxCoeff(), 1e-5f) << NameOf(size);
  }
}

TEST(MrtTrainerTest, ParametersAreAsManyAsTheirMatricesHave) {
  for (const MrtSize size : {MrtSize::kSmall, MrtSize::kPublished}) {
    MrtOptions options = QuickMrt();
    options.size = size;
    const MrtTrainer trainer(WalkingGroups(), WalkingGroups(), options);
    TensorList tensors;
    AddTensors(trainer.Best(), &tensors);
    Eigen::Index count = 0;
    for (const NamedTensor& tensor : tensors) {
      if (tensor.name.rfind("scaling", 0) != 0) count += tensor.values.size();
    }
    EXPECT_EQ(trainer.NumParameters(), count);
    EXPECT_EQ(count, size == MrtSize::kSmall ? 305320 : 4956200) << NameOf(size);
  }
}

TEST(MrtTrainerTest, RepeatsItselfAndResumesToTheLastBit) {
  const auto trained = [](MrtTrainer* trainer) {
    while (!trainer->Done()) trainer->RunRound();
    TensorList tensors;
    AddTensors(trainer->Best(), &tensors);
    return tensors;
  };
  MrtTrainer whole(WalkingGroups(), WalkingGroups(), QuickMrt());
  const TensorList one = trained(&whole);
  MrtTrainer broken(WalkingGroups(), WalkingGroups(), QuickMrt());
  for (int i = 0; i < 2; ++i) broken.RunRound();
  const std::string state = broken.State();  // before another trainer sows the draws
  MrtTrainer resumed(WalkingGroups(), WalkingGroups(), QuickMrt());
  ASSERT_TRUE(resumed.Resume(state));
  const TensorList other = trained(&resumed);
  MrtTrainer repeated(WalkingGroups(), WalkingGroups(), QuickMrt());
  const TensorList same = trained(&repeated);
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_TRUE(one[i].values == other[i].values) << one[i].name;
    EXPECT_TRUE(one[i].values == same[i].values) << one[i].name;
  }
  EXPECT_FALSE(resumed.Resume("no state"));
}

// Short groups are left out, and the rest is learned from.
TEST(MrtTrainerTest, TakesTheGroupsThatAreLongEnough) {
  EXPECT_TRUE(HasWindow({WalkingGroup(1, 40)}));
  EXPECT_FALSE(HasWindow({WalkingGroup(1, 39)}));
  EXPECT_TRUE(HasFrameAfter({WalkingGroup(1, 21)}));
  EXPECT_FALSE(HasFrameAfter({WalkingGroup(1, 20)}));
  std::vector<MrtGroup> groups = WalkingGroups(), held = WalkingGroups();
  groups.push_back({WalkingGroup(2, 30)}), held.push_back({WalkingGroup(2, 20)});
  const auto first_loss = [](const std::vector<MrtGroup>& training,
                             const std::vector<MrtGroup>& judged) {
    return MrtTrainer(training, judged, QuickMrt()).RunRound().validation_loss;
  };
  EXPECT_EQ(first_loss(groups, held), first_loss(WalkingGroups(), WalkingGroups()));
}

}  // namespace
}  // namespace pushid
