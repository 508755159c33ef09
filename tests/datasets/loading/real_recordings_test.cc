// The real recordings, where they are.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/formats/bvh.h"
#include "datasets/loading/foot_steps.h"
#include "datasets/loading/load_recordings.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(RealRecordings, AllOfThemLoad) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  Warnings warnings;
  const auto loaded = LoadRecordings(RecordingsRoot() + "/manifest.json", {}, &warnings);
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_EQ(loaded.value().size(), 81u);
  EXPECT_TRUE(warnings.empty()) << warnings[0].text;
  int people = 0;
  for (const Recording& recording : loaded.value()) {
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
  const auto loaded = LoadRecordings(RecordingsRoot() + "/manifest.json", options);
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_EQ(loaded.value().size(), 32u);
  EXPECT_EQ(loaded.value()[0].id, "single_X05_00");
  EXPECT_EQ(loaded.value()[0].num_frames(), 103);
  EXPECT_EQ(loaded.value()[0].pushes[0].force[1][0], 13.962787);
}

// A body is those joints themselves, to the last bit, and nothing of it is filled.
TEST(RealRecordings, TheirJointsAreTheBodys) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  LoadOptions options;
  options.keep_all_joints = true;
  options.setting = "single,row_1";
  Warnings warnings;
  const auto loaded = LoadRecordings(RecordingsRoot() + "/manifest.json", options, &warnings);
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_TRUE(warnings.empty()) << warnings[0].text;
  for (const Recording& recording : loaded.value()) {
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
  const Result<Manifest> manifest = ReadManifest(RecordingsRoot() + "/manifest.json");
  ASSERT_TRUE(manifest.ok()) << manifest.error().ToString();
  const std::string path =
      ResolvePath(manifest.value().path, manifest.value().recordings.back().motion.back());
  const Result<BvhMotion> original = ReadBvh(path);
  ASSERT_TRUE(original.ok()) << original.error().ToString();
  ASSERT_FALSE(WriteBvh(Path("a.bvh"), original.value(), original.value().length_unit));
  const Result<BvhMotion> copy = ReadBvh(Path("a.bvh"));
  ASSERT_TRUE(copy.ok()) << copy.error().ToString();
  EXPECT_EQ(copy.value().values, original.value().values);
  EXPECT_EQ(copy.value().skeleton.joints.size(), 22u);
}

TEST_F(RealRoundTrip, Manifest) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  const Result<Manifest> manifest = ReadManifest(RecordingsRoot() + "/manifest.json");
  ASSERT_TRUE(manifest.ok());
  ASSERT_FALSE(WriteManifest(Path("manifest.json"), manifest.value()));
  EXPECT_EQ(nlohmann::json::parse(ReadText(Path("manifest.json"))),
            nlohmann::json::parse(ReadText(manifest.value().path)));
}

}  // namespace
}  // namespace pushid
