// Trajectories as text: round trips, files as other programs write them, bad input.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/formats/motion_formats.h"
#include "datasets/formats/point_motion.h"
#include "datasets/manifest/joint_mapping.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/simulators/table_files.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using PointFilesTest = TempDirTest;

PointMotion SamplePoints() {
  PointMotion motion;
  motion.rate_hz = 100.0;
  motion.names = SampleC3d().point_names;
  motion.positions = SampleC3d().points;
  return motion;
}

void ExpectSameTracks(const std::vector<std::vector<Eigen::Vector3d>>& a,
                      const std::vector<std::vector<Eigen::Vector3d>>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].size(), b[i].size());
    for (std::size_t t = 0; t < a[i].size(); ++t) {
      EXPECT_EQ(a[i][t].allFinite(), b[i][t].allFinite()) << i << " " << t;
      if (b[i][t].allFinite()) {
        EXPECT_EQ(a[i][t], b[i][t]) << i << " " << t;
      }
    }
  }
}

TEST_F(PointFilesTest, TrcRoundTrip) {
  ASSERT_FALSE(WriteTrc(Path("a.trc"), SamplePoints()));
  const PointMotion read = Unwrapped(ReadTrc(Path("a.trc")));
  EXPECT_EQ(read.names, SamplePoints().names);
  EXPECT_EQ(read.rate_hz, 100.0);
  EXPECT_EQ(read.unit, LengthUnit::kMillimetre);
  ExpectSameTracks(read.positions, SamplePoints().positions);
}

// A TRC file as of OpenSim and Cortex: tabs at the end of lines, no blank line, a marker that
// leaves its last cells out.
constexpr char kTrc[] =
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\t\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
    "OrigNumFrames\n"
    "60.00\t60.00\t3\t2\tm\t60.00\t1\t3\n"
    "Frame#\tTime\tL.ASIS\t\t\tR.Heel\t\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "1\t0.000\t0.1\t0.2\t0.3\t1\t2\t3\t\n"
    "2\t0.017\t0.1\t0.2\t0.3\n"
    "3\t0.033\t0.1\t0.2\t0.3\t0\t0\t0\r\n";

TEST_F(PointFilesTest, TrcOfOtherPrograms) {
  const PointMotion read = Unwrapped(ReadTrc(WriteText("a.trc", kTrc)));
  EXPECT_EQ(read.names, (std::vector<std::string>{"L.ASIS", "R.Heel"}));
  EXPECT_EQ(read.unit, LengthUnit::kMetre);
  EXPECT_EQ(read.positions[1][0], Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(read.positions[1][1].allFinite());
  EXPECT_FALSE(read.positions[1][2].allFinite());  // zeros are no place of a marker
}

TEST_F(PointFilesTest, TrcKeepsOnlyWhatIsChosen) {
  PointReadOptions options;
  options.choose = [](const PointMotion& file) {
    return std::vector<int>{static_cast<int>(file.names.size()) - 1};
  };
  const PointMotion read = Unwrapped(ReadTrc(WriteText("a.trc", kTrc), options));
  EXPECT_EQ(read.chosen, std::vector<int>{1});
  ASSERT_EQ(read.positions.size(), 1u);
  EXPECT_EQ(read.positions[0][0].x(), 1.0);
}

TEST_F(PointFilesTest, BadTrc) {
  struct Case {
    std::string from, to, says;
  };
  const std::vector<Case> cases = {
      {"PathFileType", "BVH", ":1: a TRC file starts with PathFileType"},
      {"60.00\t60.00\t3", "x\t60.00\t3", ":3: DataRate must be"},
      {"60.00\t60.00\t3", "60.00 60.00 3", "tabs separate cells"},
      {"1\t0.000\t0.1\t0.2\t0.3\t1\t2\t3\t", "1 0.000 0.1 0.2 0.3 1 2 3",
       ":6: the row has 1 cells, not 8, separated by tabs"},
      {"60.00\t60.00\t3\t2", "60.00\t60.00\t4\t2", ":8: wrong frame count: NumFrames is 4"},
      {"60.00\t60.00\t3\t2", "60.00\t60.00\t2\t2", ":8: wrong frame count: NumFrames is 2"},
      {"60.00\t60.00\t3\t2", "60.00\t60.00\t3\t5", ":4: NumMarkers is 5, but 2 markers"},
      {"Frame#", "What", ":4: Frame#, Time and the names"},
      {"1\t0.000\t0.1", "1\t0.000\tabc", ":6: L.ASIS: 'abc' is not a number"},
      {"1\t0.000\t0.1", "1\tnow\t0.1", ":6: Time: 'now' is not a number"},
      {"3\t\n", "3\t4\n", ":6: the row has 9 cells, not 8"},
      {"60.00\t60.00\t3", "30.00\t60.00\t3",
       ":8: Time grows by 0.0165 s a row, 60.6061 rows a second, but DataRate is 30"},
      {"0.2\t0.3\n", "0.2\n", ":7: L.ASIS: 1 of its 3 cells is missing"},
      {"0.2\t0.3\n", "0.2\t0.3\t1\n", ":7: R.Heel: 2 of its 3 cells are missing"},
      {"0.1\t0.2\t0.3\t1", "\t0.2\tnan\t1", ":6: L.ASIS: 2 of its 3 cells are missing"},
  };
  for (const Case& one : cases) {
    std::string text = kTrc;
    text.replace(text.find(one.from), one.from.size(), one.to);
    EXPECT_TRUE(Contains(ProblemOf(ReadTrc(WriteText("bad.trc", text))), one.says));
  }
  EXPECT_TRUE(Contains(ReadTrc(WriteText("e.trc", "")).error().ToString(), "truncated"));
}

// Told where it is, not at the end of the file.
TEST_F(PointFilesTest, ATrcWithoutOneOfItsRows) {
  std::string text = kTrc;
  const std::size_t second = text.find("\n2\t") + 1;
  text.erase(second, text.find('\n', second) + 1 - second);
  EXPECT_TRUE(Contains(ProblemOf(ReadTrc(WriteText("bad.trc", text))),
                       "bad.trc:7: rows are missing before this one: Frame# goes from 1 to 3"));
}

// Frame# and Time of a file whose NumFrames is that of its rows.
TEST_F(PointFilesTest, TrcWhoseRowsDoNotFollowEachOther) {
  const struct {
    double rate;
    std::vector<std::pair<std::string, std::string>> rows;
    const char* says;
  } cases[] = {
      {100, {{"1", "0"}, {"2", "0.01"}, {"3", "0.02"}, {"8", "0.07"}}, "Frame# goes from 3 to 8"},
      {100, {{"1", "0"}, {"2", "0.01"}, {"4", "0.02"}}, "Frame# goes from 2 to 4"},
      {100, {{"1", "0"}, {"2", "0.01"}, {"3", "0.03"}}, "Time goes from 0.01 to 0.03 s"},
      {100, {{"1", "0"}, {"3", "0.02"}, {"4", "0.03"}}, "Frame# goes from 1 to 3"},
      {100,
       {{"1", "0"}, {"2", "0.01"}, {"2", "0.01"}},
       "in another order here: Frame# goes from 2"},
      {100, {{"1", "0"}, {"3", "0.02"}, {"2", "0.01"}}, "rows are missing before this one"},
      {100,
       {{"2", "0.01"}, {"1", "0"}, {"3", "0.02"}},
       "in another order here: Frame# goes from 2"},
      {100, {{"0", "0"}, {"0", "0.01"}, {"0", "0.03"}}, "Time goes from 0.01 to 0.03 s"},
      {1000, {{"1", "0"}, {"2", "0.001"}, {"4", "0.003"}}, "Frame# goes from 2 to 4"},
      {100, {{"99999999999999999999", "0"}, {"2", "0.01"}}, "Frame# goes from 1e+20 to 2"},
      // Every fifth frame; from another number; no numbers; times in ms of fast cameras.
      {20, {{"1", "0"}, {"6", "0.05"}, {"11", "0.1"}}, "no error"},
      {100, {{"200", "2"}, {"201", "2.01"}, {"202", "2.02"}}, "no error"},
      {100, {{"0", "0"}, {"0", "0.01"}, {"0", "0.02"}}, "no error"},
      {2000, {{"1", "0"}, {"2", "0"}, {"3", "0.001"}, {"4", "0.001"}}, "no error"},
      {240, {{"1", "0"}, {"2", "0.004"}, {"3", "0.008"}, {"4", "0.013"}}, "no error"},
      {60, {{"1.0", "0.0"}, {"2.0", "0.016666"}, {"3.0", "0.033333"}}, "no error"},
  };
  for (const auto& one : cases) {
    std::string text = "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tNumFrames\tNumMarkers\tUnits\n" +
                       std::to_string(one.rate) + "\t" + std::to_string(one.rows.size()) +
                       "\t1\tmm\nFrame#\tTime\tHip\n\t\tX1\tY1\tZ1\n";
    for (const auto& [frame, time] : one.rows) text += frame + "\t" + time + "\t1\t2\t3\n";
    EXPECT_TRUE(Contains(ProblemOf(ReadTrc(WriteText("a.trc", text))), one.says)) << text;
  }
}

// Wherever a file is cut, the last row shows it, up to its last number.
TEST_F(PointFilesTest, CutTrc) {
  const std::string text = kTrc;
  const std::size_t last_number = text.size() - 3;
  for (std::size_t size = 0; size <= last_number; ++size) {
    EXPECT_TRUE(
        Contains(ProblemOf(ReadTrc(WriteText("cut.trc", text.substr(0, size)))), "cut.trc:"))
        << size;
  }
  const std::string between = text.substr(0, text.rfind("\t0\t0\t0"));
  EXPECT_TRUE(
      Contains(ReadTrc(WriteText("cut.trc", between)).error().ToString(),
               ":8: the file ends after 5 of the 8 cells of its last row, without a newline"));
  // A last row without its newline is whole when all its cells are there, or all their tabs.
  for (const std::string end : {"\t0\t0\t0", "\t1\t2\t3", "\t\t\t", "\n", "\t1\t2\t3\t"}) {
    const PointMotion read = Unwrapped(ReadTrc(WriteText("whole.trc", between + end)));
    EXPECT_EQ(read.positions[1][2].allFinite(), end[1] == '1');
  }
}

TEST(PointsOfTest, ColumnsThatBelongTogether) {
  const std::vector<TablePoint> points =
      PointsOf({"time", "hip_x", "hip_y", "hip_z", "L.X", "L.Y", "L.Z", "max", "x", "y", "z",
                "ground_force_vx", "ground_force_vy", "ground_force_vz", "half_x", "half_y"});
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].name, "hip");
  EXPECT_EQ(points[1].name, "L");
  EXPECT_EQ(points[1].columns[2], 6);
  EXPECT_EQ(points[2].name, "ground_force_v");
}

TEST(PointsOfTest, NumbersThatOpenSimGivesThem) {
  const std::vector<TablePoint> points = PointsOf(
      {"time", "LASI_1", "LASI_2", "LASI_3", "q_1", "q_2", "q_3", "q_4", "a1", "a2", "a3", "b_1"});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].name, "LASI");
  EXPECT_EQ(points[0].columns[2], 3);
}

TEST(PointsOfTest, WithoutWhatPlatformsMeasure) {
  PointMotion motion;
  motion.names = {"left_v", "left_p", "left_m",         "f",  "p",    "m",
                  "hip",    "r_p",    "ground_force_v", "Lp", "clav", "ground_moment_m"};
  motion.positions.resize(motion.names.size());
  EXPECT_EQ(WithoutForces(motion).names, (std::vector<std::string>{"hip", "r_p", "Lp", "clav"}));
}

TEST_F(PointFilesTest, CsvPointsAndTheirRate) {
  const std::string path = WriteText("a.csv",
                                     "time,hip_x,hip_y,hip_z\n0.000,1,2,3\n0.008,,,\n0.017,0,0,0\n"
                                     "0.025,4,5,6\n");
  const PointMotion motion = Unwrapped(ReadPointMotion(path, MotionFormat::kCsv));
  EXPECT_NEAR(motion.rate_hz, 120.0, 1e-9);
  EXPECT_FALSE(motion.positions[0][1].allFinite());
  EXPECT_FALSE(motion.positions[0][2].allFinite());
  EXPECT_EQ(motion.positions[0][3], Eigen::Vector3d(4, 5, 6));
  const std::string uneven =
      WriteText("b.csv", "time,h_x,h_y,h_z\n0,1,2,3\n0.01,1,2,3\n0.05,1,2,3\n");
  EXPECT_TRUE(Contains(ReadPointMotion(uneven, MotionFormat::kCsv).error().ToString(),
                       "b.csv:3: the times do not ascend in even steps"));
  const std::string none = WriteText("c.csv", "time,hip\n0,1\n0.01,1\n");
  EXPECT_TRUE(Contains(ReadPointMotion(none, MotionFormat::kCsv).error().ToString(), "no points"));
}

TEST_F(PointFilesTest, MappedColumns) {
  const std::string path = WriteText("a.csv", "clock,a,b,c\n1,1,2,3\n2,4,5,6\n");
  PointReadOptions options;
  options.columns = {{"waist", "c", "a", "b"}};
  options.time_column = "clock";
  const PointMotion motion = Unwrapped(ReadPointMotion(path, MotionFormat::kCsv, options));
  EXPECT_EQ(motion.names, std::vector<std::string>{"waist"});
  EXPECT_EQ(motion.positions[0][1], Eigen::Vector3d(6, 4, 5));
  EXPECT_EQ(motion.rate_hz, 1.0);
  options.columns = {{"waist", "c", "a", "d"}};
  EXPECT_TRUE(Contains(ReadPointMotion(path, MotionFormat::kCsv, options).error().ToString(),
                       "there is no column 'd'; it has clock, a, b, c"));
}

TEST_F(PointFilesTest, MappingFiles) {
  const char* good =
      "{\"columns\": {\"waist\": [\"wx\", \"wy\", \"wz\"]}, \"joints\": {\"hip\": [\"waist\", "
      "3]},\n"
      " \"time\": \"t\", \"frame_rate\": 100, \"length_unit\": \"cm\", \"up\": \"y\", \"forward\": "
      "\"z\"}";
  const ColumnMapping mapping = Unwrapped(ReadColumnMapping(WriteText("m.json", good)));
  EXPECT_EQ(mapping.columns[0].y, "wy");
  EXPECT_EQ(mapping.joints.Of(kBodyHip)->mean_of[1].index, 3);
  EXPECT_EQ(mapping.frame_rate, 100.0);
  EXPECT_EQ(mapping.length.length_unit, LengthUnit::kCentimetre);
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"{\"colums\": {}}", "colums is not known"},
      {"{\"columns\": {\"a\": [\"x\", \"y\"]}}", "columns of 'a' must be three column names"},
      {"{\"columns\": []}", "columns must be an object"},
      {"{\"frame_rate\": 0}", "frame_rate is 0; accepted are 1 to 10000"},
      {"{\"length_unit\": \"inch\"}", "length_unit is 'inch'"},
      {"{\"up\": \"y\"}", "give up and forward"},
      {"{\"up\": \"y\", \"forward\": \"-y\"}", "lie along the same axis"},
      {"{\"joints\": {\"hip\": []}}", "hip must be a joint's name or its index"},
      {"{\"joints\": {\"hip\": [\"a\", true]}}", "hip must be a joint's name or its index"},
      {"[]", "must be an object"},
  };
  for (const auto& [text, says] : bad) {
    EXPECT_TRUE(Contains(ProblemOf(ReadColumnMapping(WriteText("m.json", text))), says));
  }
}

}  // namespace
}  // namespace pushid
