// From files to recordings: small ones made here, and broken ones.
#include "datasets/loading/load_recordings.h"

#include <gtest/gtest.h>

#include "datasets/loading/pendulum_recording.h"
#include "tests/datasets/recording_folder.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using LoadRecordingsTest = RecordingFolderTest;

TEST_F(LoadRecordingsTest, EverythingInSiUnits) {
  entry().labels.Set(kConditionLabel, "p");
  entry().push_kind = PushKind::kNet;
  entry().initial_velocity = InitialVelocity::kEstimated;
  entry().frames = 20;
  const auto loaded = Unwrapped(Load());
  ASSERT_EQ(loaded.size(), 1u);
  const Recording& recording = loaded[0];
  EXPECT_EQ(recording.id, "a");
  EXPECT_EQ(recording.labels.setting(), "single");
  EXPECT_EQ(recording.labels.magnitude(), "weak");
  EXPECT_EQ(recording.labels.condition(), "p");
  EXPECT_EQ(recording.fps, 60.0);
  EXPECT_EQ(recording.push_kind, PushKind::kNet);
  EXPECT_EQ(recording.initial_velocity, InitialVelocity::kEstimated);
  EXPECT_EQ(recording.num_frames(), 20);
  ASSERT_EQ(recording.people.size(), 1u);
  const RecordedPerson& person = recording.people[0];
  EXPECT_EQ(person.subject_id, "s1");
  EXPECT_EQ(person.mass_kg, 70.0);
  EXPECT_EQ(person.file, Path("a.bvh"));
  EXPECT_LT((person.hip[7] - Eigen::Vector3d(0.07, 0, 0.95)).norm(), 1e-12);
  EXPECT_LT((person.left_ankle[7] - Eigen::Vector3d(0, 0.1, 0.08)).norm(), 1e-12);
  EXPECT_LT((person.right_ankle[7] - Eigen::Vector3d(0, -0.1, 0.08)).norm(), 1e-12);
  EXPECT_TRUE(person.joints.empty());
  ASSERT_EQ(recording.pushes.size(), 1u);
  EXPECT_EQ(recording.pushes[0].force.size(), 5u);
  EXPECT_EQ(recording.pushes[0].start_frame, 0);
  EXPECT_EQ(recording.pushes[0].file, Path("a.csv"));
  EXPECT_EQ(recording.content_hash.size(), 32u);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0].text;
}

TEST_F(LoadRecordingsTest, AllJointsWhenAsked) {
  LoadOptions options;
  options.keep_all_joints = true;
  const auto loaded = Unwrapped(Load(options));
  const RecordedPerson& person = loaded[0].people[0];
  ASSERT_EQ(person.joints.size(), 20u);
  EXPECT_EQ(person.joint_names,
            (std::vector<std::string>{"Pelvis", "rig:Left_Foot", "rig:Right_Foot"}));
  EXPECT_EQ(person.joint_parents, (std::vector<int>{-1, 0, 0}));
  for (int frame = 0; frame < 20; ++frame) {
    EXPECT_EQ(person.joints[frame][0], person.hip[frame]);
    EXPECT_EQ(person.joints[frame][2], person.right_ankle[frame]);
  }
}

TEST_F(LoadRecordingsTest, HashFollowsTheContents) {
  const std::string first = Load().value()[0].content_hash;
  EXPECT_EQ(Load().value()[0].content_hash, first);
  WritePush("a.csv", 6);
  const std::string second = Load().value()[0].content_hash;
  EXPECT_NE(second, first);
  BvhMotion motion = Walker(20);
  motion.values[0] += 1e-9;
  WriteBvhFile("a.bvh", motion);
  EXPECT_NE(Load().value()[0].content_hash, second);
}

TEST_F(LoadRecordingsTest, UnitsFromFlagRecordingAndManifest) {
  WriteBvhFile("a.bvh", Walker(20), LengthUnit::kCentimetre);
  EXPECT_TRUE(Contains(Message(), "looks like cm, pass --length_unit=cm"));
  manifest_.length.length_unit = LengthUnit::kCentimetre;
  EXPECT_NEAR(Load().value()[0].people[0].hip[0].z(), 0.95, 1e-12);
  entry().length.length_unit = LengthUnit::kMetre;
  EXPECT_TRUE(Contains(Message(), "when lengths are read as m: looks like cm"));
  LoadOptions options;
  options.length.length_unit = LengthUnit::kCentimetre;
  EXPECT_NEAR(Load(options).value()[0].people[0].hip[0].z(), 0.95, 1e-12);
}

TEST_F(LoadRecordingsTest, UnitsThatCannotBeRight) {
  LoadOptions options;
  options.length.length_unit = LengthUnit::kMetre;
  EXPECT_EQ(Message(options),
            Path("a.bvh") +
                ": recording 'a': the hip is 870 m high above the ankles when lengths are "
                "read as m: looks like mm, pass --length_unit=mm");
  WriteBvhFile("a.bvh", Walker(20), LengthUnit::kMetre);
  EXPECT_TRUE(Contains(Message(), "looks like m, pass --length_unit=m"));
  // 33 of some unit: no unit makes a person of it, least of all one of 0.33 m.
  WriteBvhFile("a.bvh", Walker(20, 33.08), LengthUnit::kMetre);
  EXPECT_TRUE(Contains(Message(options), "check the unit (--length_unit) and the joints chosen"));
  WriteBvhFile("a.bvh", Walker(20, 0.08), LengthUnit::kMetre);
  EXPECT_TRUE(Contains(Message(), "the joints chosen"));
}

TEST_F(LoadRecordingsTest, KeysNearToKnownOnesAreWarnedAbout) {
  ASSERT_TRUE(Load().ok());
  const std::string text = ReadText(Path("manifest.json"));
  const auto with_key = [&](const std::string& key) {
    WriteText("manifest.json",
              std::string(text).replace(text.find("\"id\""), 4, "\"" + key + "\": 3, \"id\""));
    warnings_.clear();
    return LoadRecordings(Path("manifest.json"), {}, &warnings_).ok();
  };
  for (const auto& [key, meant] : {std::pair{"lenght_unit", "length_unit"},
                                   {"First-Frame", "first_frame"},
                                   {"push_scv", "push_csv"}}) {
    ASSERT_TRUE(with_key(key));
    ASSERT_EQ(warnings_.size(), 1u) << key;
    EXPECT_TRUE(Contains(warnings_[0].text, std::string("has the key '") + key + "'"));
    EXPECT_TRUE(Contains(warnings_[0].text, std::string("did you mean ") + meant + "?"));
  }
  ASSERT_TRUE(with_key("anomalies"));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(LoadRecordingsTest, WarningsOfSeveralRecordingsAreSaidOnce) {
  WriteBvhFile("b.bvh", Walker(20));
  entry().fps = 59.9;
  ManifestRecording other = entry();
  other.id = "b c";
  other.motion = {"b.bvh"};
  manifest_.recordings.push_back(other);
  ASSERT_TRUE(Load().ok());
  ASSERT_EQ(warnings_.size(), 2u);
  const std::vector<std::string> grouped = GroupedWarnings(warnings_);
  ASSERT_EQ(grouped.size(), 1u);
  EXPECT_TRUE(Contains(grouped[0], "in 2 recordings (a, b c): the file has a frame time of"));
}

TEST_F(LoadRecordingsTest, AxesAreTurned) {
  // A y-up file that faces z: what is (x, y, z) here stands there as (y, z, x).
  BvhMotion motion = Walker(20);
  for (std::size_t i = 0; i < motion.values.size(); i += 6) {
    const Eigen::Vector3d p(motion.values[i], motion.values[i + 1], motion.values[i + 2]);
    motion.values[i] = p.y();
    motion.values[i + 1] = p.z();
    motion.values[i + 2] = p.x();
  }
  WriteBvhFile("a.bvh", motion);
  EXPECT_TRUE(Contains(Message(), "set \"up\" and \"forward\""));
  entry().up = "y";
  entry().forward = "+z";
  const auto loaded = Unwrapped(Load());
  EXPECT_LT((loaded[0].people[0].hip[7] - Eigen::Vector3d(0.07, 0, 0.95)).norm(), 1e-12);
  EXPECT_LT((loaded[0].people[0].left_ankle[7] - Eigen::Vector3d(0, 0.1, 0.08)).norm(), 1e-12);
}

// Metres in one of the file's lengths, where that is no unit; the nearest that is said wins, be it
// a unit or a scale.
TEST_F(LoadRecordingsTest, AScaleInsteadOfAUnit) {
  BvhMotion odd = Walker(20);
  for (std::size_t i = 0; i < odd.values.size(); ++i) {
    if (i % 6 < 3) odd.values[i] /= 0.0564;
  }
  WriteBvhFile("a.bvh", odd, LengthUnit::kMetre);
  EXPECT_TRUE(Contains(Message(), "--length_scale"));
  entry().length.length_scale = 0.0564;
  auto loaded = Load();
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_NEAR(loaded.value()[0].people[0].hip[0].z(), 0.95, 1e-12);
  entry().length.length_scale.reset();
  manifest_.length.length_scale = 0.0564;
  EXPECT_TRUE(Load().ok());
  entry().length.length_unit = LengthUnit::kMillimetre;
  EXPECT_TRUE(Contains(Message(), "read as mm"));
  LoadOptions options;
  options.length.length_scale = 0.0564;
  loaded = Load(options);
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_NEAR(loaded.value()[0].people[0].left_ankle[0].z(), 0.08, 1e-12);
  options.length.length_scale = 0.5;
  EXPECT_TRUE(Contains(Message(options), "read as 0.5 m each"));
}

TEST_F(LoadRecordingsTest, JointsByNameAndIndex) {
  BvhMotion motion = Walker(20);
  motion.skeleton.joints[1].name = "A";
  motion.skeleton.joints[2].name = "B";
  WriteBvhFile("a.bvh", motion);
  const std::string message = Message();
  EXPECT_TRUE(Contains(message, "no joint could be recognised as left_ankle"));
  EXPECT_TRUE(Contains(message, "\"joints\""));
  EXPECT_TRUE(Contains(message, "the skeleton has Pelvis, A, B"));
  entry().joints.Set(kLeftAnkle, JointReference{"A", -1});
  entry().joints.Set(kRightAnkle, JointReference{"", 2});
  EXPECT_TRUE(Load().ok());
  entry().joints.Set(kRightAnkle, JointReference{"C", -1});
  EXPECT_TRUE(
      Contains(Message(), "joints: right_ankle: there is no joint 'C'; it has Pelvis, A, B"));
  entry().joints.Set(kRightAnkle, JointReference{"", 3});
  EXPECT_TRUE(Contains(Message(), "right_ankle is joint 3, but the skeleton has joints 0 to 2"));
  entry().joints.Set(kRightAnkle, JointReference{"A", -1});
  EXPECT_TRUE(Contains(Message(), "three different joints"));
}

// 22 joints are only taken for the FZJ skeleton when they hang together like it.
TEST_F(LoadRecordingsTest, TwentyTwoJoints) {
  const int parents[] = {-1, 0,  1,  2, 3,  4,  3,  6, 7,  8,  3,
                         10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};
  BvhMotion motion;
  motion.frame_time_s = 1.0 / 60.0;
  for (int i = 0; i < 22; ++i) {
    BvhJoint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.parent = parents[i];
    joint.offset = Eigen::Vector3d(0.0, i == 14 ? -0.1 : i == 18 ? 0.1 : 0.0, i > 14 ? -0.4 : 0.1);
    joint.channels = DefaultBvhChannels(i == 0);
    motion.skeleton.joints.push_back(joint);
  }
  motion.values.assign(20 * motion.skeleton.num_channels(), 0.0);
  WriteBvhFile("a.bvh", motion);
  const auto loaded = Unwrapped(Load());
  EXPECT_GT(loaded[0].people[0].left_ankle[0].y(), 0.0);
  EXPECT_LT(loaded[0].people[0].right_ankle[0].y(), 0.0);
  motion.skeleton.joints[21].parent = 19;
  WriteBvhFile("a.bvh", motion);
  EXPECT_TRUE(Contains(Message(), "no joint could be recognised as left_ankle"));
  EXPECT_TRUE(Contains(Message(), "joint_7, ... (22 joints)"));
}

TEST_F(LoadRecordingsTest, FrameTimes) {
  entry().fps = 60.05;  // 0.08 % off
  EXPECT_TRUE(Load().ok());
  EXPECT_TRUE(warnings_.empty());
  entry().fps = 59.9;  // 0.17 % off
  EXPECT_TRUE(Load().ok());
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_TRUE(Contains(warnings_[0].text, "recording 'a': a.bvh has"));
  EXPECT_TRUE(Contains(warnings_[0].text, "0.016667 s (59.9988 frames per second)"));
  EXPECT_TRUE(Contains(warnings_[0].text, "59.9 frames per second; the manifest's value is used"));
}

// 0.016667 s is 1/60 s, rounded.
TEST_F(LoadRecordingsTest, TheFileSaysTheRateWhereTheManifestDoesNot) {
  entry().fps = 0.0;
  const auto loaded = Unwrapped(Load());
  EXPECT_EQ(loaded[0].fps, 60.0);
  EXPECT_TRUE(warnings_.empty());
  EXPECT_FALSE(Contains(ReadText(Path("manifest.json")), "fps"));

  BvhMotion slow = Walker(20);
  slow.frame_time_s = 0.04;
  WriteBvhFile("b.bvh", slow);
  entry().subjects.push_back({"s2", 70.0});
  entry().motion.push_back("b.bvh");
  EXPECT_TRUE(Contains(Message(), Path("b.bvh") +
                                      ": recording 'a': the file gives 25 frames per "
                                      "second, but " +
                                      Path("a.bvh") + " gives 60; give the right one as fps"));
  entry().fps = 60.0;
  EXPECT_TRUE(Load().ok());
  EXPECT_EQ(warnings_.size(), 1u) << "25 is not 60";
}

TEST_F(LoadRecordingsTest, FrameCounts) {
  entry().frames = 21;
  EXPECT_EQ(Message(), Path("a.bvh") +
                           ": recording 'a': wrong frame count: the file has 20 frames, "
                           "the manifest gives 21");
  entry().frames.reset();
  WriteBvhFile("a.bvh", Walker(2));
  EXPECT_TRUE(Contains(Message(), "the motion has 2 frames; at least three are needed"));
  WriteBvhFile("a.bvh", Walker(20));
  WriteBvhFile("b.bvh", Walker(19));
  entry().subjects.push_back({"s2", 80.0});
  entry().motion.push_back("b.bvh");
  EXPECT_TRUE(Contains(Message(), Path("b.bvh") + ": recording 'a': the file has 19 frames, but " +
                                      Path("a.bvh") + " has 20"));
}

TEST_F(LoadRecordingsTest, PushesAndTheMotion) {
  WritePush("a.csv", 20);  // a row per frame, as a sensor gives them
  EXPECT_TRUE(Load().ok());
  WritePush("a.csv", 21);
  EXPECT_EQ(Message(), Path("a.csv") +
                           ": recording 'a': the push is longer than the motion: it has "
                           "21 rows, the motion has 20 frames");
  WritePush("a.csv", 5);
  WritePush("late.csv", 4);
  entry().pushes = {{0, "late.csv", 16}};
  const auto loaded = Unwrapped(Load());
  ASSERT_EQ(loaded[0].pushes.size(), 2u);
  EXPECT_EQ(loaded[0].pushes[1].start_frame, 16);
  EXPECT_EQ(loaded[0].pushes[1].EndFrame(), 20);
  entry().pushes[0].start_frame = 17;
  EXPECT_TRUE(Contains(Message(), "longer than the motion: it has 4 rows from frame 17"));
  entry().pushes[0].start_frame = 19;
  EXPECT_TRUE(Contains(Message(), "the push starts at frame 19, but the motion has 20 frames"));
  entry().pushes[0].start_frame = 1000000000;
  EXPECT_TRUE(Contains(Message(), "the push starts at frame 1000000000"));
  entry().pushes = {{0, "a.csv", 0}};
  EXPECT_TRUE(Contains(Message(), "also given as push_csv"));
  entry().pushes.clear();
  entry().push_csv.clear();
  EXPECT_TRUE(Load().value()[0].pushes.empty());
}

// Without torques a push is at the hip, or where the manifest says; torques of 0 are at the ankles.
TEST_F(LoadRecordingsTest, TheHeightOfAPush) {
  WriteText("forces.csv", "frame,fx,fy\n0,100,0\n1,100,0\n");
  entry().push_csv = "forces.csv";
  const double rod = 0.95 - 0.08;
  Eigen::Vector4d row = Unwrapped(Load())[0].pushes[0].force[0];
  EXPECT_NEAR(row[2], 100.0 * rod, 1e-9);
  EXPECT_TRUE(warnings_.empty());
  entry().push_height_m = 1.3;
  row = Unwrapped(Load())[0].pushes[0].force[0];
  EXPECT_NEAR(row[2], 100.0 * (1.3 - 0.08), 1e-9);
  entry().push_csv = "a.csv";  // with torques
  EXPECT_TRUE(Contains(Message(), "say its height as well"));
  entry().push_height_m.reset();
  WriteText("a.csv", "frame,fx,fy,ftheta,fphi\n0,100,0,0,0\n");
  Unwrapped(Load());
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_TRUE(Contains(warnings_[0].text, "which is a push at the ankles"));
  entry().push_height_m = 4.0;
  EXPECT_TRUE(Contains(Message(), "a push is between 0 and 3 m above the ground"));
}

// A log of a machine: a centre of mass over a base of support, and no ankles.
TEST_F(LoadRecordingsTest, AMassOverABase) {
  WriteText("log.csv",
            "time,com_x,com_y,com_z,base_x,base_y,base_z\n0,0,0,0.7,0,0,0\n0.01,0.01,0,0.7,0,0,0\n"
            "0.02,0.02,0,0.7,0,0,0\n0.03,0.03,0,0.7,0,0,0\n");
  WriteText("map.json", R"({"joints": {"hip": "com", "base": "base"}, "length_unit": "m"})");
  entry().motion_format = MotionFormat::kCsv;
  entry().motion = {"log.csv"};
  entry().mapping = "map.json";
  entry().fps = 0.0;
  entry().push_csv.clear();
  entry().subjects[0].known.numbers = {{kComOverRod, 1.0}, {kGyrationOverRod, 0.3}};
  const PendulumRecording log = MakePendulumRecording(Unwrapped(Load())[0]);
  EXPECT_NEAR(log.scene.people[0].body.rod_length, 0.7, 1e-12);
  EXPECT_EQ(log.facing, 0.0);
  EXPECT_EQ(log.masses[0].cart_share, 0.0);
  EXPECT_EQ(log.masses[0].com, 1.0);
  EXPECT_EQ(log.masses[0].gyration, 0.3);
  WriteText("map.json", R"({"joints": {"hip": "com", "base": "base", "left_ankle": "base"}})");
  EXPECT_TRUE(Contains(Message(), "it stands for both of them"));
}

TEST_F(LoadRecordingsTest, BadFilesAreNamed) {
  entry().motion[0] = "none.bvh";
  EXPECT_EQ(Message(), Path("none.bvh") + ": recording 'a': there is no such file");
  entry().motion[0] = "a.bvh";
  entry().push_csv = "none.csv";
  EXPECT_EQ(Message(), Path("none.csv") + ": recording 'a': there is no such file");
  WriteText("bad.csv", "frame,fx,fy,ftheta,fphi\n0,1,2,3,x\n");
  entry().push_csv = "bad.csv";
  EXPECT_EQ(Message(), Path("bad.csv") +
                           ":2: recording 'a': fphi: 'x' is not a number; a value that is "
                           "missing is an empty cell or nan");
  entry().push_csv = "a.csv";
  BvhMotion motion = Walker(20);
  motion.values[18 * 7] = 1e300;
  WriteBvhFile("a.bvh", motion, LengthUnit::kMetre);
  entry().length.length_unit = LengthUnit::kMetre;
  EXPECT_TRUE(Contains(Message(), "m from the origin at frame 7"));
}

TEST_F(LoadRecordingsTest, SettingsAndIds) {
  ManifestRecording pair = entry();
  pair.id = "b";
  pair.labels.Set(kSettingLabel, "row_1");
  pair.subjects.push_back({"s2", 80.0});
  pair.motion.push_back("a.bvh");
  ManifestRecording other = entry();
  other.id = "c";
  other.labels.Set(kSettingLabel, "other");
  manifest_.recordings = {entry(), pair, other};
  const auto ids = [&](const std::string& setting, const std::vector<std::string>& only = {}) {
    LoadOptions options;
    options.setting = setting;
    options.ids = only;
    const auto loaded = Load(options);
    if (!loaded.ok()) return loaded.error().ToString();
    std::string text;
    for (const Recording& recording : loaded.value()) text += recording.id;
    return text;
  };
  EXPECT_EQ(ids("all"), "abc");
  EXPECT_EQ(ids("groups"), "b");
  EXPECT_EQ(ids("other, single"), "ac");  // the manifest's order
  EXPECT_EQ(ids("single,groups"), "ab");
  EXPECT_EQ(ids("all", {"c", "a"}), "ac");
  const std::string unknown = ids("single,singel");
  EXPECT_TRUE(Contains(unknown, "--setting=single,singel: no recording has the setting 'singel'"));
  EXPECT_TRUE(Contains(unknown, "other (1), row_1 (1), single (1), besides all and groups"));
  EXPECT_TRUE(Contains(ids(""), "no recording has the setting ''"));
  EXPECT_TRUE(Contains(ids("all", {"z"}), "there is no recording 'z'; it has a, b, c"));
  EXPECT_TRUE(Contains(ids("single", {"b"}), "'row_1', which --setting=single leaves out"));
  manifest_.recordings = {entry()};
  EXPECT_TRUE(Contains(ids("groups"), "no recording has more than one person"));
}

}  // namespace
}  // namespace pushid
