// The real recordings, where they are.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/formats/bvh.h"
#include "datasets/loading/foot_steps.h"
#include "datasets/loading/load_recordings.h"
#include "tests/datasets/raw_bvh.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(RealRecordings, AllOfThemLoad) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  Warnings warnings;
  const auto loaded = Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", {}, &warnings));
  EXPECT_EQ(loaded.size(), 81u);
  EXPECT_TRUE(warnings.empty()) << warnings[0].text;
  int people = 0;
  for (const Recording& recording : loaded) {
    people += static_cast<int>(recording.people.size());
    EXPECT_EQ(recording.pushes.size(), 1u);
    for (const RecordedPerson& person : recording.people) {
      // People stand on the ground and face x, the left foot to the left.
      EXPECT_NEAR(person.hip[0].z(), 1.0, 0.25) << person.file;
      EXPECT_GT(person.left_ankle[0].y(), person.right_ankle[0].y()) << person.file;
      // Their toes are recorded, and no heels.
      ASSERT_FALSE(person.left_toe.empty()) << person.file;
      EXPECT_NEAR(person.left_toe[0].x() - person.left_ankle[0].x(), 0.15, 0.15) << person.file;
      EXPECT_TRUE(person.left_heel.empty()) << person.file;
    }
  }
  EXPECT_EQ(people, 255);
}

TEST(RealRecordings, SettingSingle) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  LoadOptions options;
  options.setting = "single";
  const auto loaded = Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", options));
  EXPECT_EQ(loaded.size(), 32u);
  EXPECT_EQ(loaded[0].id, "single_X05_00");
  EXPECT_EQ(loaded[0].num_frames(), 103);
  EXPECT_EQ(loaded[0].pushes[0].force[1][0], 13.962787);
}

// A body is those joints themselves, to the last bit, and nothing of it is filled.
TEST(RealRecordings, TheirJointsAreTheBodys) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  LoadOptions options;
  options.keep_all_joints = true;
  options.setting = "single,row_1";
  Warnings warnings;
  const auto loaded =
      Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", options, &warnings));
  EXPECT_TRUE(warnings.empty()) << warnings[0].text;
  for (const Recording& recording : loaded) {
    for (const RecordedPerson& person : recording.people) {
      EXPECT_TRUE(UnfilledRoles(person.roles).empty() && FilledRoles(person.roles).empty());
      for (const std::vector<Eigen::Vector3d>& joints : person.joints) {
        ASSERT_EQ(joints.size(), 22u);
        const Pose pose = PoseOf(person.roles, joints);
        for (int j = 0; j < kBodyJoints; ++j) ASSERT_EQ(pose.col(j), joints[j]);
      }
    }
  }
}

// Reading and writing a real file changes no value, and writing twice changes no byte.
class RealRoundTrip : public TempDirTest {};

TEST_F(RealRoundTrip, Bvh) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  const Manifest manifest = Unwrapped(ReadManifest(RecordingsRoot() + "/manifest.json"));
  const std::string path = ResolvePath(manifest.path, manifest.recordings.back().motion.back());
  const BvhMotion original = Unwrapped(ReadBvh(path));
  ASSERT_FALSE(WriteBvh(Path("a.bvh"), original));
  const BvhMotion copy = Unwrapped(ReadBvh(Path("a.bvh")));
  EXPECT_EQ(copy.values, original.values);
  EXPECT_EQ(copy.skeleton.joints.size(), 22u);
}

TEST_F(RealRoundTrip, Manifest) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  const Manifest manifest = Unwrapped(ReadManifest(RecordingsRoot() + "/manifest.json"));
  ASSERT_FALSE(WriteManifest(Path("manifest.json"), manifest));
  EXPECT_EQ(nlohmann::json::parse(ReadText(Path("manifest.json"))),
            nlohmann::json::parse(ReadText(manifest.path)));
}

}  // namespace
}  // namespace pushid
