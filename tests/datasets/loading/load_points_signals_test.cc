// Recordings whose motion is a file of points: units, gaps, rates, preparation.
#include <gtest/gtest.h>

#include "datasets/loading/load_recordings.h"
#include "tests/datasets/points_folder.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using LoadPointSignalsTest = PointsFolderTest;

TEST_F(LoadPointSignalsTest, UnitsOfTheFile) {
  motion_.unit = LengthUnit::kMetre;
  for (auto& track : motion_.positions) {
    for (Eigen::Vector3d& p : track) p *= 1e-3;
  }
  Use("a.trc", MotionFormat::kTrc);
  ExpectTheWalker();  // TRC says m
  manifest_.length.length_unit = LengthUnit::kMillimetre;
  EXPECT_TRUE(Contains(Message(), "looks like m, pass --length_unit=m"));
  EXPECT_TRUE(Contains(warnings_[0].text, "gives lengths in m; they are read as mm"));
}

TEST_F(LoadPointSignalsTest, UnitsInOtherSpellings) {
  const std::string trc = ReadText(Path("a.trc"));
  const auto with_unit = [&](const std::string& unit) {
    std::string text = trc;
    WriteText("a.trc", text.replace(text.find("\tmm\t"), 4, "\t" + unit + "\t"));
  };
  for (const char* unit : {"MM", "millimeters", "Millimetre"}) {
    with_unit(unit);
    ExpectTheWalker();
  }
  EXPECT_EQ(FromName<LengthUnit>("CENTIMETERS"), LengthUnit::kCentimetre);
  EXPECT_EQ(FromName<LengthUnit>("M"), LengthUnit::kMetre);
  EXPECT_EQ(FromName<LengthUnit>("metres"), LengthUnit::kMetre);
  with_unit("inch");
  EXPECT_TRUE(Contains(Message(), "a.trc: recording 'a': gives lengths in 'inch'"));
  entry().length.length_unit = LengthUnit::kMillimetre;
  ExpectTheWalker();
}

TEST_F(LoadPointSignalsTest, ShortGapsAreFilledLongOnesLeftOut) {
  for (int t : {4, 5}) motion_.positions[0][t] = kHidden;
  for (int t = 9; t < 17; ++t) motion_.positions[4][t] = kHidden;
  Use("a.c3d", MotionFormat::kC3d);
  const auto loaded = Unwrapped(Load());
  const RecordedPerson& person = loaded[0].people[0];
  ASSERT_EQ(person.weight.size(), 20u);
  for (int t = 0; t < 20; ++t) {
    // Two of the twelve that are left are interpolated: more than a tenth.
    const double interpolated = t == 4 || t == 5 ? 10.0 / 12.0 : 1.0;
    EXPECT_DOUBLE_EQ(person.weight[t], t >= 9 && t < 17 ? 0.0 : interpolated) << t;
  }
  EXPECT_LT((person.hip[5] - Eigen::Vector3d(0.05, 0.0, 0.95)).norm(), 1e-5);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_TRUE(Contains(warnings_[0].text, "has 2 gaps in hip and ankles"));
  EXPECT_TRUE(Contains(warnings_[0].text, "8 of 20 frames are left out"));
  LoadOptions options;
  options.preparation.max_gap_s = 0.2;
  const auto patient = Unwrapped(Load(options));
  for (double weight : patient[0].people[0].weight) EXPECT_GT(weight, 0.0);
}

TEST_F(LoadPointSignalsTest, TheFirstFrameMustBeSeen) {
  for (int t = 0; t < 3; ++t) motion_.positions[5][t] = kHidden;
  Use("a.trc", MotionFormat::kTrc);
  EXPECT_TRUE(Contains(Message(),
                       "at frame 0, where the fit starts, hip or ankles are missing; set "
                       "first_frame to 3 or later"));
  entry().first_frame = 3;
  entry().end_frame = 18;
  const auto loaded = Unwrapped(Load());
  EXPECT_EQ(loaded[0].num_frames(), 15);
  EXPECT_NEAR(loaded[0].people[0].hip[0].x(), 0.03, 1e-9);
  entry().end_frame = 21;
  EXPECT_TRUE(
      Contains(Message(), "the file has 20 frames, too few for first_frame 3 and end_frame 21"));
  entry().end_frame.reset();
  motion_.positions[5].assign(20, kHidden);
  Use("a.trc", MotionFormat::kTrc);
  EXPECT_TRUE(Contains(Message(), "S1:RANK is never seen"));
}

TEST_F(LoadPointSignalsTest, RatesThatDiffer) {
  entry().fps = 50.0;
  ASSERT_TRUE(Load().ok());
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_TRUE(Contains(warnings_[0].text, "(60 frames per second), the manifest gives 50"));
}

// From TRC and C3D heads, a column of times, a mapping; without all of those there is none.
TEST_F(LoadPointSignalsTest, TheFileSaysTheRateWhereTheManifestDoesNot) {
  entry().fps = 0.0;
  const auto rate = [this] { return Unwrapped(Load())[0].fps; };
  for (double fps : {60.0, 59.94}) {
    motion_.rate_hz = fps;
    Use("a.trc", MotionFormat::kTrc);
    EXPECT_NEAR(rate(), fps, 1e-9);
    Use("a.c3d", MotionFormat::kC3d);
    EXPECT_NEAR(rate(), fps, 1e-5);  // C3D keeps 32 bits
  }
  UseTable("motion.csv", MotionFormat::kCsv);
  EXPECT_EQ(rate(), 60.0);

  std::string text = ReadText(Path("motion.csv"));
  text.replace(text.find("time"), 4, "tick");
  WriteText("motion.csv", text);
  EXPECT_TRUE(Contains(Message(), Path("motion.csv") + ": recording 'a': neither the file nor the "
                                                       "manifest gives the frame rate; give fps"));
  WriteText("map.json", "{\"frame_rate\": 60}");
  entry().mapping = "map.json";
  EXPECT_EQ(rate(), 60.0);
}

TEST_F(LoadPointSignalsTest, FilterAndResampling) {
  LoadOptions options;
  options.preparation.lowpass_hz = 10.0;
  options.preparation.resample_fps = 30.0;
  const auto loaded = Unwrapped(Load(options));
  EXPECT_EQ(loaded[0].fps, 30.0);
  EXPECT_EQ(loaded[0].num_frames(), 10);
  EXPECT_EQ(loaded[0].pushes[0].force.size(), 3u);  // five rows at 60 are 2.5 at 30
  options.preparation.lowpass_hz = 0.0;
  EXPECT_TRUE(Contains(Message(options), "recording 'a': --resample_fps=30 is below its 60"));
}

}  // namespace
}  // namespace pushid
