// BVH: reading, writing and round trips. What is refused is in bvh_errors_test.cc, kinematics in
// bvh_kinematics_test.cc.
#include "datasets/formats/bvh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/files/input_file.h"
#include "tests/datasets/raw_bvh.h"
#include "tests/datasets/recording_folder.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using BvhTest = TempDirTest;

constexpr char kTwoJoints[] =
    "HIERARCHY\n"
    "ROOT Hips\n"
    "{\n"
    "  OFFSET 0 0 0\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
    "  JOINT Left Leg\n"
    "  {\n"
    "    OFFSET 0 100 -900\n"
    "    CHANNELS 3 Xrotation Yrotation Zrotation\n"
    "    End Site\n"
    "    {\n"
    "      OFFSET 150 0 -50\n"
    "    }\n"
    "  }\n"
    "}\n"
    "MOTION\n"
    "Frames: 2\n"
    "Frame Time: 0.016667\n"
    "1 2 3 4 5 6 7 8 9\n"
    "-1.5 2e1 +3.25 .5 1E-3 0 1.e2 -0.0 12345.678901\n";

TEST_F(BvhTest, ReadsHierarchyAndValues) {
  const BvhMotion motion = Unwrapped(ReadBvh(WriteText("a.bvh", kTwoJoints)));
  ASSERT_EQ(motion.skeleton.joints.size(), 2u);
  const BvhJoint& root = motion.skeleton.joints[0];
  const BvhJoint& leg = motion.skeleton.joints[1];
  EXPECT_EQ(root.name, "Hips");
  EXPECT_EQ(root.parent, -1);
  EXPECT_EQ(root.channels, DefaultBvhChannels(true));
  EXPECT_TRUE(root.end_sites.empty());
  EXPECT_EQ(leg.name, "Left Leg");
  EXPECT_EQ(leg.parent, 0);
  EXPECT_EQ(leg.offset, Eigen::Vector3d(0, 100, -900));
  EXPECT_EQ(leg.channels, (std::vector<BvhChannel>{BvhChannel::kXrotation, BvhChannel::kYrotation,
                                                   BvhChannel::kZrotation}));
  ASSERT_EQ(leg.end_sites.size(), 1u);
  EXPECT_EQ(leg.end_sites[0], Eigen::Vector3d(150, 0, -50));
  EXPECT_EQ(motion.frame_time_s, 0.016667);
  EXPECT_EQ(motion.num_frames(), 2);
  EXPECT_EQ(motion.values, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, -1.5, 20, 3.25, 0.5,
                                                0.001, 0, 100, 0, 12345.678901}));
  EXPECT_EQ(motion.skeleton.Find("Left Leg"), 1);
  EXPECT_EQ(motion.skeleton.Find("Leg"), -1);
}

// The content stays the same, however it is laid out.
TEST_F(BvhTest, LayoutMakesNoDifference) {
  const std::string text = kTwoJoints;
  std::string crlf, tabs, no_final_newline = text.substr(0, text.size() - 1);
  for (char c : text) {
    crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    tabs += c == ' ' ? std::string(" \t ") : std::string(1, c);
  }
  // Names keep inner blanks, so this one must not be spread.
  tabs.replace(tabs.find("Left \t Leg"), 10, "Left Leg");
  std::string dense = text;
  dense.replace(dense.find("ROOT Hips\n{\n"), 12, "root Hips { ");
  dense.replace(dense.find("End Site\n    {\n"), 15, "End Site{");
  dense.replace(dense.find("-50\n    }\n  }\n}\n"), 16, "-50}}}\n");
  dense.replace(dense.find("HIERARCHY"), 9, "hierarchy");

  const BvhMotion expected = Unwrapped(ReadBvh(WriteText("plain.bvh", text)));
  for (const std::string& variant :
       {crlf, tabs, dense, no_final_newline, "\xEF\xBB\xBF" + text, text + "\n \n\t\n"}) {
    const Result<BvhMotion> read = ReadBvh(WriteText("variant.bvh", variant));
    ASSERT_TRUE(read.ok()) << read.error().ToString() << "\n" << variant;
    EXPECT_EQ(read.value().values, expected.values);
    ASSERT_EQ(read.value().skeleton.joints.size(), 2u);
    EXPECT_EQ(read.value().skeleton.joints[1].name, "Left Leg");
    EXPECT_EQ(read.value().skeleton.joints[1].end_sites[0], Eigen::Vector3d(150, 0, -50));
  }
}

BvhMotion RandomMotion(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 100.0);
  BvhMotion motion;
  motion.frame_time_s = 1.0 / 60.0;
  const int parents[] = {-1, 0, 1, 1, 3, 0, -1, 6};
  for (int i = 0; i < 8; ++i) {
    BvhJoint joint;
    joint.name = "joint " + std::to_string(i);
    joint.parent = parents[i];
    joint.offset = Eigen::Vector3d(normal(random), normal(random), normal(random));
    joint.channels = DefaultBvhChannels(i % 3 == 0);
    std::shuffle(joint.channels.begin(), joint.channels.end(), random);
    if (i == 4) joint.channels.clear();
    if (i == 2 || i == 4 || i == 5 || i == 7) joint.end_sites = {joint.offset / 3.0};
    motion.skeleton.joints.push_back(joint);
  }
  for (int i = 0; i < 5 * motion.skeleton.num_channels(); ++i) {
    motion.values.push_back(normal(random) * (i % 7 == 0 ? 1e-12 : 1.0));
  }
  return motion;
}

TEST_F(BvhTest, WrittenMotionReadsBackBitForBit) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const BvhMotion motion = RandomMotion(seed);
    ASSERT_EQ(ProblemOf(WriteBvh(Path("a.bvh"), motion)), "no error");
    const BvhMotion read = Unwrapped(ReadBvh(Path("a.bvh")));
    EXPECT_EQ(read.values, motion.values);
    EXPECT_EQ(read.frame_time_s, motion.frame_time_s);
    ASSERT_EQ(read.skeleton.joints.size(), motion.skeleton.joints.size());
    for (std::size_t i = 0; i < motion.skeleton.joints.size(); ++i) {
      const BvhJoint& a = motion.skeleton.joints[i];
      const BvhJoint& b = read.skeleton.joints[i];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.parent, b.parent);
      EXPECT_EQ(a.offset, b.offset);
      EXPECT_EQ(a.channels, b.channels);
      EXPECT_EQ(a.end_sites, b.end_sites);
    }
    const std::string once = ReadText(Path("a.bvh"));
    ASSERT_FALSE(WriteBvh(Path("b.bvh"), read));
    EXPECT_EQ(ReadText(Path("b.bvh")), once);
  }
}

TEST_F(BvhTest, UnitsOfTheFileDoNotChangePositions) {
  const BvhMotion motion = RandomMotion(7);
  std::vector<PointMotion> positions;
  for (double metres : {1e-3, 1e-2, 1.0}) {
    ASSERT_FALSE(WriteBvh(Path("a.bvh"), Scaled(motion, 1e-3 / metres)));
    positions.push_back(BvhInMetres(Path("a.bvh"), metres));
  }
  ASSERT_EQ(positions[0].positions.size(), 8u);
  for (std::size_t joint = 0; joint < 8; ++joint) {
    for (int frame = 0; frame < 5; ++frame) {
      EXPECT_LT(
          (positions[0].positions[joint][frame] - positions[1].positions[joint][frame]).norm(),
          1e-14);
      EXPECT_LT(
          (positions[0].positions[joint][frame] - positions[2].positions[joint][frame]).norm(),
          1e-14);
    }
  }
}

TEST_F(BvhTest, LeafWithoutEndSiteGetsOne) {
  BvhMotion motion = RandomMotion(1);
  motion.skeleton.joints[2].end_sites.clear();
  ASSERT_FALSE(WriteBvh(Path("a.bvh"), motion));
  const BvhMotion read = Unwrapped(ReadBvh(Path("a.bvh")));
  ASSERT_EQ(read.skeleton.joints[2].end_sites.size(), 1u);
  EXPECT_TRUE(read.skeleton.joints[2].end_sites[0].isZero());
}

TEST_F(BvhTest, WriterRefusesWhatNobodyCouldRead) {
  const std::pair<const char*, void (*)(BvhMotion*)> cases[] = {
      {"values for", [](BvhMotion* m) { m->values.pop_back(); }},
      {"values for", [](BvhMotion* m) { m->values.clear(); }},
      {"frame 1 is not finite",
       [](BvhMotion* m) { m->values[m->skeleton.num_channels()] = std::nan(""); }},
      {"frame time", [](BvhMotion* m) { m->frame_time_s = 0.0; }},
  };
  for (const auto& [part, damage] : cases) {
    BvhMotion motion = RandomMotion(3);
    damage(&motion);
    EXPECT_TRUE(Contains(ProblemOf(WriteBvh(Path("a.bvh"), motion)), part));
    EXPECT_EQ(CountFiles(), 0);
  }
}

TEST_F(BvhTest, PositionsAreThoseAskedForAndTheHashIsTheFiles) {
  const std::string path = WriteText("a.bvh", kTwoJoints);
  PointReadOptions options;
  options.choose = [](const PointMotion& file) {
    return std::vector<int>{file.skeleton->Find("Left Leg")};
  };
  const PointMotion read = Unwrapped(ReadBvhPoints(path, options));
  EXPECT_EQ(read.chosen, std::vector<int>{1});
  EXPECT_EQ(read.num_frames(), 2);
  EXPECT_EQ(read.content_hash, HashFile(path).value());
}

// Rows longer than the reader's buffer and joints deeper than any stack.
TEST_F(BvhTest, VeryDeepHierarchy) {
  constexpr int kJoints = 60000;
  std::string text = "HIERARCHY\n";
  for (int i = 0; i < kJoints; ++i) {
    text += (i == 0 ? "ROOT j" : "JOINT j") + std::to_string(i) +
            " { OFFSET 0 0 1 CHANNELS 3 Zrotation Yrotation Xrotation\n";
  }
  text += std::string(kJoints, '}') + "\nMOTION\nFrames: 3\nFrame Time: 0.01\n";
  for (int frame = 0; frame < 3; ++frame) {
    for (int i = 0; i < 3 * kJoints; ++i) text += "0.000000 ";
    text += "\n";
  }
  PointReadOptions options;
  options.choose = [](const PointMotion&) { return std::vector<int>{kJoints - 1}; };
  const PointMotion read = Unwrapped(ReadBvhPoints(WriteText("deep.bvh", text), options));
  EXPECT_NEAR(read.positions[0][2].z(), 60000.0, 1e-6);
}

}  // namespace
}  // namespace pushid
