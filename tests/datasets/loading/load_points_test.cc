// Recordings whose motion is C3D, TRC, CSV or STO: mapping, units, gaps, cuts, several people.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "datasets/files/numeric_table.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/trc.h"
#include "datasets/loading/foot_support.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/manifest/joint_choice.h"
#include "tests/datasets/recording_folder.h"

namespace pushid {
namespace {

const Eigen::Vector3d kHidden = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

// The recording of the folder as markers instead of joints: the pelvis as four of them around the
// hip, ankles as LANK and RANK; 20 frames, mm.
class LoadPointsTest : public RecordingFolderTest {
 protected:
  void SetUp() override {
    RecordingFolderTest::SetUp();
    motion_.rate_hz = 60.0;
    motion_.unit = LengthUnit::kMillimetre;
    motion_.names = {"S1:LASI", "S1:RASI", "S1:LPSI", "S1:RPSI", "S1:LANK", "S1:RANK"};
    motion_.positions.resize(6);
    for (int t = 0; t < 20; ++t) {
      const Eigen::Vector3d hip(10.0 * t, 0.0, 950.0);
      const Eigen::Vector3d offsets[4] = {{80, 120, 0}, {80, -120, 0}, {-80, 50, 0}, {-80, -50, 0}};
      for (int i = 0; i < 4; ++i) motion_.positions[i].push_back(hip + offsets[i]);
      motion_.positions[4].push_back({0.0, 100.0, 80.0});
      motion_.positions[5].push_back({0.0, -100.0, 80.0});
    }
    Use("a.trc", MotionFormat::kTrc);
  }

  void Use(const std::string& file, MotionFormat format) {
    entry().motion_format = format;
    entry().motion = {file};
    entry().json.clear();
    if (format == MotionFormat::kTrc) {
      ASSERT_FALSE(WriteTrc(Path(file), motion_));
    }
    if (format != MotionFormat::kC3d) return;
    C3dFile c3d;
    c3d.point_rate_hz = motion_.rate_hz;
    c3d.point_unit = Name(*motion_.unit);
    c3d.point_names = motion_.names;
    c3d.points = motion_.positions;
    ASSERT_FALSE(WriteC3d(Path(file), c3d));
  }

  void UseTable(const std::string& file, MotionFormat format, double first_time = 0.0) {
    NumericTable table;
    table.names = {"time"};
    table.data.resize(1);
    for (int t = 0; t < 20; ++t) table.data[0].push_back(first_time + t / 60.0);
    for (std::size_t i = 0; i < motion_.names.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        table.names.push_back(motion_.names[i] + "_" + "xyz"[axis]);
        table.data.emplace_back();
        for (const auto& p : motion_.positions[i]) table.data.back().push_back(p[axis]);
      }
    }
    for (std::size_t i = 0; i < table.names.size(); ++i) table.chosen.push_back(i);
    ASSERT_FALSE(WriteNumericTable(
        Path(file), format == MotionFormat::kCsv ? TableFormat::kCsv : TableFormat::kStorage,
        table));
    Use(file, format);
  }

  void ExpectTheWalker() {
    const auto loaded = Load();
    ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
    EXPECT_TRUE(warnings_.empty()) << warnings_[0];
    const RecordedPerson& person = loaded.value()[0].people[0];
    ASSERT_EQ(person.hip.size(), 20u);
    EXPECT_LT((person.hip[7] - Eigen::Vector3d(0.07, 0.0, 0.95)).norm(), 1e-5);
    EXPECT_LT((person.left_ankle[7] - Eigen::Vector3d(0.0, 0.1, 0.08)).norm(), 1e-5);
    EXPECT_LT((person.right_ankle[7] - Eigen::Vector3d(0.0, -0.1, 0.08)).norm(), 1e-5);
    EXPECT_TRUE(person.weight.empty());
  }

  PointMotion motion_;
};

TEST_F(LoadPointsTest, EveryFormatWithDefaultMarkers) {
  ExpectTheWalker();
  Use("a.c3d", MotionFormat::kC3d);
  ExpectTheWalker();
  UseTable("motion.csv", MotionFormat::kCsv);
  ExpectTheWalker();
  UseTable("motion.sto", MotionFormat::kStorage);
  ExpectTheWalker();
}

// For forces recorded in the same file.
TEST_F(LoadPointsTest, TheFilesClockAtFrameZero) {
  const auto clock = [this] {
    const auto loaded = Load();
    EXPECT_TRUE(loaded.ok()) << loaded.error().ToString();
    return loaded.ok() ? loaded.value()[0].people[0].file_clock_s : -1.0;
  };
  Use("a.c3d", MotionFormat::kC3d);
  entry().first_frame = 6;
  entry().end_frame = 20;
  EXPECT_NEAR(clock(), 0.1, 1e-12);
  UseTable("motion.sto", MotionFormat::kStorage, 2.5);
  EXPECT_NEAR(clock(), 2.6, 1e-9);
}

TEST_F(LoadPointsTest, ManifestRoundTrip) {
  entry().joints.hip = JointReference{"", -1, {{"LASI"}, {"", 1}}};
  entry().subjects[0].joints.left_ankle = JointReference{"LANK"};
  entry().mapping = "map.json";
  entry().first_frame = 2;
  entry().end_frame = 9;
  ASSERT_FALSE(WriteManifest(Path("manifest.json"), manifest_));
  const Result<Manifest> read = ReadManifest(Path("manifest.json"));
  ASSERT_TRUE(read.ok()) << read.error().ToString();
  const ManifestRecording& again = read.value().recordings[0];
  EXPECT_EQ(again.motion_format, MotionFormat::kTrc);
  EXPECT_EQ(again.motion, std::vector<std::string>{"a.trc"});
  ASSERT_EQ(again.joints.hip->mean_of.size(), 2u);
  EXPECT_EQ(again.joints.hip->mean_of[0].name, "LASI");
  EXPECT_EQ(again.joints.hip->mean_of[1].index, 1);
  EXPECT_EQ(again.subjects[0].joints.left_ankle->name, "LANK");
  EXPECT_EQ(again.mapping, "map.json");
  EXPECT_EQ(again.first_frame, 2);
  EXPECT_EQ(again.end_frame, 9);
}

TEST_F(LoadPointsTest, BadManifestsOfPoints) {
  const auto message = [this](const std::string& from, const std::string& to) {
    EXPECT_FALSE(WriteManifest(Path("manifest.json"), manifest_));
    std::string text = ReadText(Path("manifest.json"));
    text.replace(text.find(from), from.size(), to);
    const Result<Manifest> read = ReadManifest(WriteText("bad.json", text));
    return read.ok() ? std::string("no error") : read.error().ToString();
  };
  EXPECT_TRUE(
      Contains(message("\"trc\":", "\"bvh\": [\"a.bvh\"], \"trc\":"), "trc is given beside bvh"));
  EXPECT_TRUE(Contains(message("\"trc\":", "\"trk\":"), "bvh is missing"));
  EXPECT_TRUE(Contains(message("\"trc\": [\n    \"a.trc\"\n   ]", "\"trc\": []"),
                       "trc lists 0 files for 1 subjects"));
  EXPECT_TRUE(
      Contains(message("\"trc\":", "\"first_frame\": 5, \"end_frame\": 5, \"trc\":"), "end_frame"));
}

TEST_F(LoadPointsTest, MarkersByName) {
  entry().joints.hip = JointReference{"", -1, {{"S1:LASI"}, {"RASI"}}};
  const auto loaded = Load();
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_LT((loaded.value()[0].people[0].hip[0] - Eigen::Vector3d(0.08, 0.0, 0.95)).norm(), 1e-9);
  entry().joints.hip = JointReference{"", -1, {{"LASI"}, {"SACR"}}};
  EXPECT_TRUE(
      Contains(Message(), "joints: hip: there is no point 'SACR'; it has S1:LASI, S1:RASI"));
  entry().joints.hip = JointReference{"LANK"};
  EXPECT_TRUE(Contains(Message(), "three different points"));
}

// Two people in one file: what is not said in full could be either.
TEST_F(LoadPointsTest, SeveralPeopleInOneFile) {
  const std::size_t markers = motion_.names.size();
  for (std::size_t i = 0; i < markers; ++i) {
    motion_.names.push_back("S2:" + motion_.names[i].substr(3));
    motion_.positions.push_back(motion_.positions[i]);
    for (Eigen::Vector3d& p : motion_.positions.back()) p.y() += 500.0;
  }
  Use("a.trc", MotionFormat::kTrc);
  entry().subjects.push_back({"s2", 80.0});
  entry().motion = {"a.trc", "a.trc"};
  EXPECT_TRUE(Contains(Message(), "hip could be 'S1:LASI' or 'S2:LASI'; name it in full"));
  entry().joints.hip = JointReference{"LASI"};
  EXPECT_TRUE(Contains(Message(), "joints: hip: hip could be 'S1:LASI' or 'S2:LASI'"));
  for (int n = 0; n < 2; ++n) {
    const std::string prefix = "S" + std::to_string(n + 1) + ":";
    entry().subjects[n].joints = {JointReference{"", -1, {{prefix + "LASI"}, {prefix + "RPSI"}}},
                                  JointReference{prefix + "LANK"}, JointReference{prefix + "RANK"}};
  }
  const auto loaded = Load();
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_NEAR(loaded.value()[0].people[1].left_ankle[0].y(), 0.6, 1e-9);
  EXPECT_NEAR(loaded.value()[0].people[0].left_ankle[0].y(), 0.1, 1e-9);
}

TEST_F(LoadPointsTest, ToesAndHeelsWhereThereAreSome) {
  EXPECT_TRUE(Load().value()[0].people[0].left_toe.empty());
  const struct {
    const char* name;
    double x, y;
  } markers[] = {{"S1:LTOE", 200, 110}, {"S1:R.Toe.Tip", 190, -110}, {"S1:LHEE", -60, 100}};
  for (const auto& marker : markers) {
    motion_.names.push_back(marker.name);
    motion_.positions.emplace_back(20, Eigen::Vector3d(marker.x, marker.y, 20.0));
  }
  Use("a.trc", MotionFormat::kTrc);
  const RecordedPerson person = Load().value()[0].people[0];
  ASSERT_EQ(person.left_toe.size(), 20u);
  ASSERT_EQ(person.right_toe.size(), 20u);
  EXPECT_LT((person.left_toe[7] - Eigen::Vector3d(0.2, 0.11, 0.02)).norm(), 1e-5);
  EXPECT_LT((person.right_toe[7] - Eigen::Vector3d(0.19, -0.11, 0.02)).norm(), 1e-5);
  EXPECT_TRUE(person.right_heel.empty());
  const FootSupport support = SupportOf(person);
  EXPECT_NEAR(support.forward.value(), 0.195, 1e-5);
  EXPECT_FALSE(support.back);  // of one heel nothing is known
  EXPECT_NEAR(support.side, 0.1, 1e-5);

  // Lost for two frames it is filled; lost for ten it is not used, and the frames count on.
  for (int t = 5; t < 7; ++t) motion_.positions[6][t] = kHidden;
  Use("a.trc", MotionFormat::kTrc);
  EXPECT_NEAR(Load().value()[0].people[0].left_toe[6].x(), 0.2, 1e-5);
  for (int t = 5; t < 15; ++t) motion_.positions[6][t] = kHidden;
  Use("a.trc", MotionFormat::kTrc);
  const RecordedPerson lost = Load().value()[0].people[0];
  EXPECT_TRUE(lost.left_toe.empty());
  EXPECT_EQ(lost.right_toe.size(), 20u);
  EXPECT_TRUE(lost.weight.empty());
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
}

// The middle of both malleoli, as the common marker sets name them.
TEST_F(LoadPointsTest, AnklesOfTheCommonMarkerSets) {
  const std::vector<std::pair<std::vector<std::string>, std::vector<int>>> sets = {
      {{"Pelvis", "L_FAL", "L_TAM", "R_FAL", "R_TAM"}, {1, 2}},
      {{"Pelvis", "LAL", "LAM", "RAL", "RAM"}, {1, 2}},
      {{"Pelvis", "l mall", "r mall"}, {1}},
      {{"Pelvis", "L_FAL", "R_FAL"}, {1}},
      {{"pelvis", "l_foot", "r_foot"}, {1}},
  };
  for (const auto& [names, left] : sets) {
    const auto chosen = ChoosePendulumPoints("x", names, {});
    ASSERT_TRUE(chosen.ok()) << chosen.error().ToString();
    EXPECT_EQ(chosen.value().left_ankle, left) << names[1];
    EXPECT_EQ(chosen.value().right_ankle.size(), left.size()) << names[1];
  }
}

// The toe of whose ankle it is; a foot beside an ankle is the toe of SMPL's skeletons.
TEST_F(LoadPointsTest, ToesOfSeveralPeople) {
  const std::vector<std::string> names = {"A:Hips", "A:L_Ankle", "A:R_Ankle", "A:L_Foot", "B:Hips",
                                          "B:LANK", "B:RANK",    "B:LTOE",    "A:LTOE",   "B:RTOE"};
  JointMapping of_b;
  of_b.hip = JointReference{"B:Hips"};
  of_b.left_ankle = JointReference{"B:LANK"};
  of_b.right_ankle = JointReference{"B:RANK"};
  const auto b = ChoosePendulumPoints("x", names, of_b);
  ASSERT_TRUE(b.ok()) << b.error().ToString();
  EXPECT_EQ(b.value().left_toe, std::vector<int>{7});
  EXPECT_EQ(b.value().right_toe, std::vector<int>{9});
  EXPECT_TRUE(b.value().left_heel.empty());
  const auto smpl = ChoosePendulumPoints(
      "x", {"Pelvis", "L_Ankle", "R_Ankle", "L_Foot", "R_Foot", "L_Heel", "R_Heel"}, {});
  ASSERT_TRUE(smpl.ok()) << smpl.error().ToString();
  EXPECT_EQ(smpl.value().left_toe, std::vector<int>{3});
  EXPECT_EQ(smpl.value().right_heel, std::vector<int>{6});
  const auto foot = ChoosePendulumPoints("x", {"Hips", "LeftFoot", "RightFoot", "LeftToeBase"}, {});
  EXPECT_EQ(foot.value().left_ankle, std::vector<int>{1});
  EXPECT_EQ(foot.value().left_toe, std::vector<int>{3});
  EXPECT_TRUE(foot.value().right_toe.empty());
}

TEST_F(LoadPointsTest, UnitsOfTheFile) {
  motion_.unit = LengthUnit::kMetre;
  for (auto& track : motion_.positions) {
    for (Eigen::Vector3d& p : track) p *= 1e-3;
  }
  Use("a.trc", MotionFormat::kTrc);
  ExpectTheWalker();  // TRC says m
  manifest_.length_unit = LengthUnit::kMillimetre;
  EXPECT_TRUE(Contains(Message(), "looks like m, pass --length_unit=m"));
  EXPECT_TRUE(Contains(warnings_[0], "says its lengths are m; they are read as mm"));
}

TEST_F(LoadPointsTest, UnitsInOtherSpellings) {
  const std::string trc = ReadText(Path("a.trc"));
  const auto with_unit = [&](const std::string& unit) {
    std::string text = trc;
    WriteText("a.trc", text.replace(text.find("\tmm\t"), 4, "\t" + unit + "\t"));
  };
  for (const char* unit : {"MM", "millimeters", "Millimetre"}) {
    with_unit(unit);
    ExpectTheWalker();
  }
  EXPECT_EQ(LengthUnitFromName("CENTIMETERS"), LengthUnit::kCentimetre);
  EXPECT_EQ(LengthUnitFromName("M"), LengthUnit::kMetre);
  EXPECT_EQ(LengthUnitFromName("metres"), LengthUnit::kMetre);
  with_unit("inch");
  EXPECT_TRUE(Contains(Message(), "a.trc: recording 'a': says its lengths are in 'inch'"));
  entry().length_unit = LengthUnit::kMillimetre;
  ExpectTheWalker();
}

TEST_F(LoadPointsTest, ShortGapsAreFilledLongOnesLeftOut) {
  for (int t : {4, 5}) motion_.positions[0][t] = kHidden;
  for (int t = 9; t < 17; ++t) motion_.positions[4][t] = kHidden;
  Use("a.c3d", MotionFormat::kC3d);
  const auto loaded = Load();
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  const RecordedPerson& person = loaded.value()[0].people[0];
  ASSERT_EQ(person.weight.size(), 20u);
  for (int t = 0; t < 20; ++t) EXPECT_EQ(person.weight[t], t >= 9 && t < 17 ? 0.0 : 1.0) << t;
  EXPECT_LT((person.hip[5] - Eigen::Vector3d(0.05, 0.0, 0.95)).norm(), 1e-5);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_TRUE(Contains(warnings_[0], "has 2 gaps in hip and ankles"));
  EXPECT_TRUE(Contains(warnings_[0], "8 of 20 frames are left out"));
  LoadOptions options;
  options.preparation.max_gap_s = 0.2;
  const auto patient = Load(options);
  ASSERT_TRUE(patient.ok());
  EXPECT_TRUE(patient.value()[0].people[0].weight.empty());
}

TEST_F(LoadPointsTest, TheFirstFrameMustBeSeen) {
  for (int t = 0; t < 3; ++t) motion_.positions[5][t] = kHidden;
  Use("a.trc", MotionFormat::kTrc);
  EXPECT_TRUE(Contains(Message(),
                       "at frame 0, where the fit starts, hip or ankles are not seen; set "
                       "first_frame to 3 or later"));
  entry().first_frame = 3;
  entry().end_frame = 18;
  const auto loaded = Load();
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_EQ(loaded.value()[0].num_frames(), 15);
  EXPECT_NEAR(loaded.value()[0].people[0].hip[0].x(), 0.03, 1e-9);
  entry().end_frame = 21;
  EXPECT_TRUE(
      Contains(Message(), "the file has 20 frames, too few for first_frame 3 and end_frame 21"));
  entry().end_frame.reset();
  motion_.positions[5].assign(20, kHidden);
  Use("a.trc", MotionFormat::kTrc);
  EXPECT_TRUE(Contains(Message(), "S1:RANK is never seen"));
}

TEST_F(LoadPointsTest, MappingFileForTables) {
  std::string text = "clock;w1;w2;w3;l1;l2;l3;r1;r2;r3\n";  // y up, z forward, cm
  for (int t = 0; t < 20; ++t) {
    text += std::to_string(t) + ";0;95;" + std::to_string(t) + ";10;8;0;-10;8;0\n";
  }
  WriteText("motion.csv", text);
  WriteText(
      "map.json",
      "{\"columns\": {\"waist\": [\"w1\", \"w2\", \"w3\"], \"fl\": [\"l1\", \"l2\", \"l3\"], "
      "\"fr\": [\"r1\", \"r2\", \"r3\"]}, \"joints\": {\"hip\": \"waist\", \"left_ankle\": "
      "\"fl\", \"right_ankle\": \"fr\"}, \"frame_rate\": 60, \"length_unit\": \"cm\", \"up\": "
      "\"y\", \"forward\": \"z\"}");
  Use("motion.csv", MotionFormat::kCsv);
  entry().mapping = "map.json";
  ExpectTheWalker();
  const std::string hash = Load().value()[0].content_hash;
  std::string map = ReadText(Path("map.json"));
  WriteText("map.json", map + " ");
  EXPECT_NE(Load().value()[0].content_hash, hash) << "the mapping is part of the data";
  entry().mapping = "none.json";
  EXPECT_TRUE(Contains(Message(), Path("none.json") + ": recording 'a': there is no such file"));
}

TEST_F(LoadPointsTest, RatesThatDiffer) {
  entry().fps = 50.0;
  ASSERT_TRUE(Load().ok());
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_TRUE(Contains(warnings_[0], "(60 frames per second), the manifest says 50"));
}

// From TRC and C3D heads, a column of times, a mapping; without all of those there is none.
TEST_F(LoadPointsTest, TheFileSaysTheRateWhereTheManifestDoesNot) {
  entry().fps = 0.0;
  const auto rate = [this] {
    const auto loaded = Load();
    EXPECT_TRUE(loaded.ok()) << loaded.error().ToString();
    return loaded.ok() ? loaded.value()[0].fps : -1.0;
  };
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
                                                       "manifest says the frame rate; give fps"));
  WriteText("map.json", "{\"frame_rate\": 60}");
  entry().mapping = "map.json";
  EXPECT_EQ(rate(), 60.0);
}

TEST_F(LoadPointsTest, FilterAndResampling) {
  LoadOptions options;
  options.preparation.lowpass_hz = 10.0;
  options.preparation.resample_fps = 30.0;
  const auto loaded = Load(options);
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_EQ(loaded.value()[0].fps, 30.0);
  EXPECT_EQ(loaded.value()[0].num_frames(), 10);
  EXPECT_EQ(loaded.value()[0].pushes[0].force.size(), 3u);  // five rows at 60 are 2.5 at 30
  options.preparation.lowpass_hz = 0.0;
  EXPECT_TRUE(Contains(Message(options), "recording 'a': --resample_fps=30 is below its 60"));
}

}  // namespace
}  // namespace pushid
