// A training run to its end, its checkpoints, and its curve: stages apart, the best point marked.
#include <gtest/gtest.h>

#include <filesystem>

#include "ident/training/restoration_training.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Counts to three.
struct CountingTrainer : Trainer {
  bool Done() const override { return rounds == 3; }
  TrainingPoint RunRound() override { return {++rounds, 1.0 / rounds, 1.0 / rounds}; }
  double ShareDone() const override { return rounds / 3.0; }
  std::string State() override { return std::to_string(rounds); }
  bool Resume(const std::string& state) override {
    rounds = std::stoi(state);
    return true;
  }
  int rounds = 0;
};

class TrainingRunTest : public TempDirTest {
 protected:
  MaybeError Run(const CheckpointOptions& options) {
    CountingTrainer trainer;
    course_ = {};
    return RunToEnd(
        &trainer, "counting", options, [](TrainingPoint*) {}, &course_);
  }

  TrainingCourse course_;
};

// A folder that is a file cannot take a checkpoint: that breaks a training off at its first round.
TEST_F(TrainingRunTest, ACheckpointThatCannotBeWrittenIsTold) {
  EXPECT_TRUE(Run({WriteText("file", "") + "/checkpoint.bin"}));
}

TEST_F(TrainingRunTest, StatesAreKeptAndTrainingsGoOn) {
  const std::string file = Path("checkpoint.bin");
  ASSERT_FALSE(Run({file}));
  EXPECT_FALSE(course_.resumed);
  ASSERT_TRUE(std::filesystem::exists(file)) << "of the first round";
  ASSERT_FALSE(Run({file, true}));
  EXPECT_TRUE(course_.resumed);
  EXPECT_EQ(course_.curve.size(), 3u);
  ASSERT_FALSE(Run({file}));  // of a training that is done
  EXPECT_TRUE(course_.resumed);
  EXPECT_EQ(course_.curve.size(), 3u);
}

TEST(CurveSvgTest, StagesHavePanelsAndTheBestPointIsNamed) {
  std::vector<TrainingPoint> curve;
  for (int i = 1; i <= 6; ++i) {
    curve.push_back({i, 1.0 / i, i == 5 ? 0.02 : 0.1, i <= 3 ? "first" : "second"});
  }
  const std::string svg = TrainingCurveSvg(curve, "a & b");
  EXPECT_TRUE(Contains(svg, ">first<"));
  EXPECT_TRUE(Contains(svg, ">second<"));
  EXPECT_TRUE(Contains(svg, "best 0.02 at 5"));
  EXPECT_TRUE(Contains(svg, "a &amp; b"));
  size_t lines = 0;
  const std::string look = "fill:none;stroke-width:2;";  // of losses, and of nothing else
  for (size_t at = 0; (at = svg.find(look, at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 4u);
}

}  // namespace
}  // namespace pushid
