// Motion-BIDS: a table without names and the files that say what it holds.
#include "datasets/formats/motion_bids.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr char kStem[] = "sub-1/motion/sub-1_task-push_tracksys-omc_run-1";
constexpr char kChannels[] =
    "name\tcomponent\ttype\ttracked_point\tunits\treference_frame\n"
    "hip_z\tz\tPOS\tHips\tcm\tlab\n"
    "hip_x\tx\tPOS\tHips\tcm\tlab\n"
    "hip_y\ty\tPOS\tHips\tcm\tlab\n"
    "toe_x\tx\tPOS\tToe\tcm\tlab\n"
    "rate\tx\tGYRO\tHips\trad/s\tlab\n"
    "cell\tn/a\tMISC\tpole\tN\tn/a\n";

class MotionBidsTest : public TempDirTest {
 protected:
  void SetUp() override {
    TempDirTest::SetUp();
    Write("_motion.tsv",
          "90\t1\t2\t0\t0.5\t10\n91\tn/a\tn/a\t0\t0.5\t20\n-999\t-999\t-999\t0\t0\t0\n");
    Write("_channels.tsv", kChannels);
    Write("_motion.json",
          R"({"TaskName": "push", "SamplingFrequency": 60, "MissingValues": "-999"})");
    WriteText("sub-1/motion/sub-1_task-push_tracksys-omc_channels.json",
              R"({"reference_frame": {"Levels": {"lab": {"SpatialAxes": "ASR"}}}})");
  }
  std::string Write(const std::string& end, const std::string& text) {
    return WriteText(kStem + end, text);
  }
  std::string Motion() const { return Path(std::string(kStem) + "_motion.tsv"); }
  std::string Message() const { return ProblemOf(ReadMotionBids(Motion())); }
};

TEST_F(MotionBidsTest, PointsByTheirChannels) {
  const PointMotion motion = Unwrapped(ReadMotionBids(Motion()));
  EXPECT_EQ(motion.names, std::vector<std::string>{"Hips"});  // the toe lacks y and z
  EXPECT_EQ(motion.rate_hz, 60.0);
  EXPECT_EQ(motion.unit, LengthUnit::kCentimetre);
  EXPECT_EQ(motion.up, "+y");
  EXPECT_EQ(motion.positions[0][0], Eigen::Vector3d(1, 2, 90));
  EXPECT_FALSE(motion.positions[0][1].allFinite());
  EXPECT_FALSE(motion.positions[0][2].allFinite());
}

// The nearest of the files that apply wins; one of another run does not apply.
TEST_F(MotionBidsTest, SidecarsMayStandAbove) {
  std::filesystem::remove(Path(std::string(kStem) + "_motion.json"));
  WriteText("dataset_description.json", "{}");
  WriteText("task-push_motion.json", R"({"TaskName": "push", "SamplingFrequency": 30})");
  WriteText("sub-1/motion/sub-1_task-push_tracksys-omc_run-2_motion.json",
            R"({"SamplingFrequency": 15})");
  EXPECT_EQ(ReadMotionBids(Motion()).value().rate_hz, 30.0);
  WriteText("sub-1/sub-1_motion.json", R"({"SamplingFrequency": 120})");
  EXPECT_EQ(ReadMotionBids(Motion()).value().rate_hz, 120.0);
}

TEST_F(MotionBidsTest, WhatIsRequired) {
  Write("_motion.json", R"({"SamplingFrequency": 60})");
  EXPECT_TRUE(Contains(Message(), "_motion.json: TaskName, which Motion-BIDS requires"));
  Write("_motion.json", R"({"TaskName": "push", "SamplingFrequency": "n/a"})");
  EXPECT_TRUE(Contains(Message(), "SamplingFrequency is 0; accepted are 1 to 10000"));
  Write("_motion.json", R"({"TaskName": "push", "SamplingFrequency": 60})");
  Write("_channels.tsv", "name\ttype\nhip\tPOS\n");
  EXPECT_TRUE(Contains(Message(), "_channels.tsv:1: Motion-BIDS requires the columns"));
  EXPECT_TRUE(Contains(Message(), "missing here: component, tracked_point, units"));
  Write("_channels.tsv", std::string(kChannels) + "cell\tn/a\tMISC\tpole\tN\tn/a\n");
  EXPECT_TRUE(Contains(Message(), "_channels.tsv:8: two channels are called 'cell'"));
  Write("_channels.tsv", std::string(kChannels) + "cell2\tn/a\tMISC\tpole\tN\tn/a\n");
  EXPECT_TRUE(Contains(Message(), "_motion.tsv:1: the row has 6 values, not 7"));
  std::filesystem::remove(Path(std::string(kStem) + "_channels.tsv"));
  EXPECT_TRUE(Contains(Message(), "needs sub-1_task-push_tracksys-omc_run-1_channels.tsv beside"));
  EXPECT_TRUE(Contains(ReadMotionBids(WriteText("table.tsv", "1\n")).error().ToString(),
                       "is called sub-..._task-..._tracksys-..._motion.tsv"));
}

TEST_F(MotionBidsTest, PositionsOfTwoUnits) {
  std::string channels = kChannels;
  channels.replace(channels.find("\tcm\t"), 4, "\tmm\t");
  Write("_channels.tsv", channels);
  EXPECT_TRUE(Contains(Message(), "positions are in 'mm' and in 'cm'"));
}

PointMotion TwoPoints() {
  PointMotion motion;
  motion.rate_hz = 59.94;
  motion.names = {"a", "b"};
  for (int point = 0; point < 2; ++point) {
    motion.positions.emplace_back();
    for (int frame = 0; frame < 6; ++frame) {
      motion.positions.back().emplace_back(0.1 * frame + point, 1.0 / 3.0, -2e-7 * frame);
    }
  }
  motion.positions[1][2].setConstant(std::nan(""));
  return motion;
}

// What is written comes back to the bit, pushes in their frames.
TEST_F(MotionBidsTest, ThereAndBack) {
  const PointMotion motion = TwoPoints();
  const std::vector<TimedForce> pushes = {
      {0, {Eigen::Vector4d(1, 2, 3, 4), Eigen::Vector4d::Zero()}},
      {4, {Eigen::Vector4d(-1e-9, 1.0 / 3.0, 0, 700)}}};
  const std::string stem = Path("sub-x_task-push_tracksys-body");
  ASSERT_FALSE(WriteMotionBids(stem, "push", motion, pushes));
  const PointMotion read = Unwrapped(ReadMotionBids(stem + "_motion.tsv"));
  EXPECT_EQ(read.names, motion.names);
  EXPECT_EQ(read.rate_hz, 59.94);
  EXPECT_EQ(read.unit, LengthUnit::kMetre);
  EXPECT_EQ(read.up, "+z");
  EXPECT_EQ(read.positions[0], motion.positions[0]);
  EXPECT_FALSE(read.positions[1][2].allFinite());
  const std::vector<TimedForce> back = Unwrapped(ReadBidsPushes(stem + "_motion.tsv"));
  ASSERT_EQ(back.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(back[i].start_frame, pushes[i].start_frame);
    EXPECT_EQ(back[i].force, pushes[i].force);
  }
}

TEST_F(MotionBidsTest, PushesThatCannotBeHeldOrRead) {
  const std::string stem = Path("sub-x_task-push_tracksys-body");
  const std::vector<Eigen::Vector4d> two(2, Eigen::Vector4d::Ones());
  EXPECT_TRUE(Contains(ProblemOf(WriteMotionBids(stem, "push", TwoPoints(), {{0, two}, {1, two}})),
                       "two pushes on one person overlap"));
  EXPECT_TRUE(Contains(ReadBidsPushes(Motion()).error().ToString(),
                       "needs the channels push_fx, push_fy, push_ftheta and push_fphi"));
  ASSERT_FALSE(WriteMotionBids(stem, "push", TwoPoints(), {{0, two}}));
  std::string text = ReadText(stem + "_motion.tsv");
  text.replace(text.find("\t1\t1\t1\t1\n"), 9, "\t1\tn/a\t1\t1\n");
  WriteText("sub-x_task-push_tracksys-body_motion.tsv", text);
  EXPECT_TRUE(Contains(ReadBidsPushes(stem + "_motion.tsv").error().ToString(),
                       "_motion.tsv:1: some of the push's four channels have no value"));
  PointMotion twice = TwoPoints();
  twice.names = {"a", "a"};
  EXPECT_TRUE(Contains(WriteMotionBids(stem, "push", twice, {})->message, "the same name"));
}

}  // namespace
}  // namespace pushid
