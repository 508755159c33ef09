// Recordings whose motion is C3D, TRC, CSV or STO: mapping, joints, several people.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/loading/foot_steps.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/manifest/joint_mapping.h"
#include "tests/datasets/points_folder.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using LoadPointsTest = PointsFolderTest;

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
  const auto clock = [this] { return Unwrapped(Load())[0].people[0].file_clock_s; };
  Use("a.c3d", MotionFormat::kC3d);
  entry().first_frame = 6;
  entry().end_frame = 20;
  EXPECT_NEAR(clock(), 0.1, 1e-12);
  UseTable("motion.sto", MotionFormat::kStorage, 2.5);
  EXPECT_NEAR(clock(), 2.6, 1e-9);
}

TEST_F(LoadPointsTest, ManifestRoundTrip) {
  entry().joints.Set(kBodyHip, JointReference{"", -1, {{"LASI"}, {"", 1}}});
  entry().subjects[0].joints.Set(kLeftAnkle, JointReference{"LANK"});
  entry().mapping = "map.json";
  entry().first_frame = 2;
  entry().end_frame = 9;
  ASSERT_FALSE(WriteManifest(Path("manifest.json"), manifest_));
  const Manifest read = Unwrapped(ReadManifest(Path("manifest.json")));
  const ManifestRecording& again = read.recordings[0];
  EXPECT_EQ(again.motion_format, MotionFormat::kTrc);
  EXPECT_EQ(again.motion, std::vector<std::string>{"a.trc"});
  ASSERT_EQ(again.joints.Of(kBodyHip)->mean_of.size(), 2u);
  EXPECT_EQ(again.joints.Of(kBodyHip)->mean_of[0].name, "LASI");
  EXPECT_EQ(again.joints.Of(kBodyHip)->mean_of[1].index, 1);
  EXPECT_EQ(again.subjects[0].joints.Of(kLeftAnkle)->name, "LANK");
  EXPECT_EQ(again.mapping, "map.json");
  EXPECT_EQ(again.first_frame, 2);
  EXPECT_EQ(again.end_frame, 9);
}

TEST_F(LoadPointsTest, BadManifestsOfPoints) {
  const auto message = [this](const std::string& from, const std::string& to) {
    EXPECT_FALSE(WriteManifest(Path("manifest.json"), manifest_));
    std::string text = ReadText(Path("manifest.json"));
    text.replace(text.find(from), from.size(), to);
    return ProblemOf(ReadManifest(WriteText("bad.json", text)));
  };
  EXPECT_TRUE(Contains(message("\"trc\":", "\"bvh\": [\"a.bvh\"], \"trc\":"),
                       "trc is given together with bvh"));
  EXPECT_TRUE(Contains(message("\"trc\":", "\"trk\":"), "bvh is missing"));
  EXPECT_TRUE(Contains(message("\"trc\": [\n    \"a.trc\"\n   ]", "\"trc\": []"),
                       "trc lists 0 files for 1 subjects"));
  EXPECT_TRUE(
      Contains(message("\"trc\":", "\"first_frame\": 5, \"end_frame\": 5, \"trc\":"), "end_frame"));
}

TEST_F(LoadPointsTest, MarkersByName) {
  entry().joints.Set(kBodyHip, JointReference{"", -1, {{"S1:LASI"}, {"RASI"}}});
  const auto loaded = Unwrapped(Load());
  EXPECT_LT((loaded[0].people[0].hip[0] - Eigen::Vector3d(0.08, 0.0, 0.95)).norm(), 1e-9);
  entry().joints.Set(kBodyHip, JointReference{"", -1, {{"LASI"}, {"SACR"}}});
  EXPECT_TRUE(
      Contains(Message(), "joints: hip: there is no point 'SACR'; it has S1:LASI, S1:RASI"));
  entry().joints.Set(kBodyHip, JointReference{"LANK"});
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
  entry().joints.Set(kBodyHip, JointReference{"LASI"});
  EXPECT_TRUE(Contains(Message(), "joints: hip: hip could be 'S1:LASI' or 'S2:LASI'"));
  for (int n = 0; n < 2; ++n) {
    const std::string prefix = "S" + std::to_string(n + 1) + ":";
    JointMapping& joints = entry().subjects[n].joints;
    joints.Set(kBodyHip, JointReference{"", -1, {{prefix + "LASI"}, {prefix + "RPSI"}}});
    joints.Set(kLeftAnkle, JointReference{prefix + "LANK"});
    joints.Set(kRightAnkle, JointReference{prefix + "RANK"});
  }
  const auto loaded = Unwrapped(Load());
  EXPECT_NEAR(loaded[0].people[1].left_ankle[0].y(), 0.6, 1e-9);
  EXPECT_NEAR(loaded[0].people[0].left_ankle[0].y(), 0.1, 1e-9);
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
  EXPECT_TRUE(warnings_.empty()) << warnings_[0].text;
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
    const auto chosen = Unwrapped(ChoosePendulum("x", names, nullptr, {}));
    EXPECT_EQ(chosen.left_ankle, left) << names[1];
    EXPECT_EQ(chosen.right_ankle.size(), left.size()) << names[1];
  }
}

// The toe of whose ankle it is; a foot beside an ankle is the toe of SMPL's skeletons.
TEST_F(LoadPointsTest, ToesOfSeveralPeople) {
  const std::vector<std::string> names = {"A:Hips", "A:L_Ankle", "A:R_Ankle", "A:L_Foot", "B:Hips",
                                          "B:LANK", "B:RANK",    "B:LTOE",    "A:LTOE",   "B:RTOE"};
  JointMapping of_b;
  of_b.Set(kBodyHip, JointReference{"B:Hips"});
  of_b.Set(kLeftAnkle, JointReference{"B:LANK"});
  of_b.Set(kRightAnkle, JointReference{"B:RANK"});
  const auto b = Unwrapped(ChoosePendulum("x", names, nullptr, of_b));
  EXPECT_EQ(b.left_toe, std::vector<int>{7});
  EXPECT_EQ(b.right_toe, std::vector<int>{9});
  EXPECT_TRUE(b.left_heel.empty());
  const auto smpl = Unwrapped(ChoosePendulum(
      "x", {"Pelvis", "L_Ankle", "R_Ankle", "L_Foot", "R_Foot", "L_Heel", "R_Heel"}, nullptr, {}));
  EXPECT_EQ(smpl.left_toe, std::vector<int>{3});
  EXPECT_EQ(smpl.right_heel, std::vector<int>{6});
  const auto foot =
      ChoosePendulum("x", {"Hips", "LeftFoot", "RightFoot", "LeftToeBase"}, nullptr, {});
  EXPECT_EQ(foot.value().left_ankle, std::vector<int>{1});
  EXPECT_EQ(foot.value().left_toe, std::vector<int>{3});
  EXPECT_TRUE(foot.value().right_toe.empty());
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

}  // namespace
}  // namespace pushid
