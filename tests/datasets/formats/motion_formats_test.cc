// The table of formats, and the rates that files round.
#include "datasets/formats/motion_formats.h"

#include <gtest/gtest.h>

#include "datasets/formats/bvh.h"
#include "datasets/formats/units.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(MotionFormatsTest, ByTheFilesEnding) {
  EXPECT_EQ(MotionFormatOfFile("a/b.c3d"), MotionFormat::kC3d);
  EXPECT_EQ(MotionFormatOfFile("A.BVH"), MotionFormat::kBvh);
  EXPECT_EQ(MotionFormatOfFile("run.sto"), MotionFormat::kStorage);
  EXPECT_EQ(MotionFormatOfFile("run.mot"), MotionFormat::kStorage);
  EXPECT_FALSE(MotionFormatOfFile("bvh"));
  EXPECT_FALSE(MotionFormatOfFile("a.bvh.gz"));
}

// Every format is found by its key, which is an ending of its files, and can be read.
TEST(MotionFormatsTest, EveryRow) {
  for (const MotionFormatRow& row : kMotionFormats) {
    EXPECT_EQ(MotionFormatOfFile(std::string("a.") + row.name), row.value);
    EXPECT_EQ(RowOf(row.value).name, row.name);
    EXPECT_EQ(HasSkeleton(row.value), row.value == MotionFormat::kBvh);
  }
  EXPECT_EQ(Title(MotionFormat::kC3d), "C3D");
  EXPECT_EQ(MotionKeys(), "bvh, c3d, trc, csv, sto, txt");
  EXPECT_EQ(MotionFileEndings(), ".bvh, .c3d, .trc, .csv, .sto, .mot, .txt");
}

TEST(FrameRateTest, RoundedFrameTimesAreWholeRates) {
  for (double frame_time : {0.016667, 0.0166667, 0.01667, 1.0 / 60.0}) {
    EXPECT_EQ(WholeFrameRate(1.0 / frame_time), 60.0) << frame_time;
  }
  for (double frame_time : {0.00833, 0.0083, 0.0083333}) {
    EXPECT_EQ(WholeFrameRate(1.0 / frame_time) == 120.0, frame_time != 0.0083) << frame_time;
  }
  EXPECT_EQ(WholeFrameRate(1.0 / 0.0333), 30.0);
  EXPECT_EQ(WholeFrameRate(1.0 / 0.03333), 30.0);
  EXPECT_NE(WholeFrameRate(1.0 / 0.0334), 30.0);  // of video, 29.97
  EXPECT_EQ(WholeFrameRate(100.0), 100.0);
  // Video is 0.1 % slower than its name; others are not near enough.
  for (double rate : {60.0 / 1.001, 59.94, 30.0 / 1.001, 59.9, 60.07, 12.5, 0.2, 0.0}) {
    EXPECT_EQ(WholeFrameRate(rate), rate);
  }
}

TEST(FrameRateTest, Accepted) {
  EXPECT_EQ(FrameRateProblem(1.0), "");
  EXPECT_EQ(FrameRateProblem(10000.0), "");
  EXPECT_EQ(FrameRateProblem(0.0), "is 0; accepted are 1 to 10000 frames per second");
  EXPECT_NE(FrameRateProblem(std::numeric_limits<double>::quiet_NaN()), "");
}

using FrameRateOfFileTest = TempDirTest;

TEST_F(FrameRateOfFileTest, FromTheHead) {
  const std::string bvh = WriteText(
      "a.bvh",
      "HIERARCHY\nROOT a { OFFSET 0 0 0 CHANNELS 1 Xposition }\nMOTION\nFrames: 1\nFrame Time: "
      "0.016667\nno numbers\n");
  const double of_bvh = Unwrapped(ReadFrameRate(bvh, MotionFormat::kBvh));
  EXPECT_EQ(of_bvh, 60.0);
  const std::string timed = WriteText("a.csv", "time,h_x,h_y,h_z\n0,1,2,3\n0.01,1,2,3\n");
  EXPECT_EQ(ReadFrameRate(timed, MotionFormat::kCsv).value(), 100.0);
  const std::string timeless = WriteText("b.csv", "h_x,h_y,h_z\n1,2,3\n");
  EXPECT_EQ(ReadFrameRate(timeless, MotionFormat::kCsv).value(), 0.0);
  EXPECT_FALSE(ReadFrameRate(Path("none.trc"), MotionFormat::kTrc).ok());
}

}  // namespace
}  // namespace pushid
