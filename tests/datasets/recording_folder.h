// A fixture: a folder with one small recording and its manifest, to be changed and loaded.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "datasets/formats/bvh.h"
#include "datasets/formats/force_csv.h"
#include "datasets/loading/load_recordings.h"
#include "tests/test_support.h"

namespace pushid {

// A hip that moves forward over two standing feet; axes and unit of the file are free.
inline BvhMotion Walker(int frames, double hip_height_m = 0.95) {
  BvhMotion motion;
  motion.frame_time_s = 0.016667;
  BvhJoint hip, left, right;
  hip.name = "Pelvis";
  hip.channels = DefaultBvhChannels(true);
  left.name = "rig:Left_Foot";
  left.parent = 0;
  left.channels = DefaultBvhChannels(true);
  right = left;
  right.name = "rig:Right_Foot";
  motion.skeleton.joints = {hip, left, right};
  for (int frame = 0; frame < frames; ++frame) {
    const double x = 0.01 * frame;
    const std::vector<double> row = {x,  0.0,  hip_height_m,        0, 0, 0,  //
                                     -x, 0.1,  0.08 - hip_height_m, 0, 0, 0,  //
                                     -x, -0.1, 0.08 - hip_height_m, 0, 0, 0};
    motion.values.insert(motion.values.end(), row.begin(), row.end());
  }
  return motion;
}

// The motion in a unit of which so many make the present one.
inline BvhMotion Scaled(BvhMotion motion, double factor) {
  std::vector<bool> rotation;
  for (BvhJoint& joint : motion.skeleton.joints) {
    joint.offset *= factor;
    for (Eigen::Vector3d& end : joint.end_sites) end *= factor;
    for (const BvhChannel channel : joint.channels) rotation.push_back(IsRotation(channel));
  }
  for (std::size_t i = 0; i < motion.values.size(); ++i) {
    if (!rotation[i % rotation.size()]) motion.values[i] *= factor;
  }
  return motion;
}

class RecordingFolderTest : public TempDirTest {
 protected:
  // One recording of one person: 20 frames, five of them pushed.
  void SetUp() override {
    TempDirTest::SetUp();
    WriteBvhFile("a.bvh", Walker(20));
    WritePush("a.csv", 5);
    ManifestRecording recording;
    recording.id = "a";
    recording.labels.Set(kSettingLabel, "single");
    recording.fps = 60.0;
    recording.subjects = {{"s1", 70.0}};
    recording.motion = {"a.bvh"};
    recording.push_csv = "a.csv";
    recording.labels.Set(kMagnitudeLabel, "weak");
    manifest_.recordings = {recording};
  }

  // motion: in metres.
  void WriteBvhFile(const std::string& name, const BvhMotion& motion,
                    LengthUnit unit = LengthUnit::kMillimetre) const {
    const BvhMotion written = Scaled(motion, RowOf(unit).per_metre);
    ASSERT_EQ(ProblemOf(WriteBvh(Path(name), written)), "no error");
  }

  void WritePush(const std::string& name, int rows) const {
    std::vector<Eigen::Vector4d> force;
    for (int i = 0; i < rows; ++i) force.emplace_back(100.0 + i, 0.0, 50.0, 0.0);
    ASSERT_FALSE(WritePushCsv(Path(name), force));
  }

  Result<std::vector<Recording>> Load(const LoadOptions& options = {}) {
    EXPECT_FALSE(WriteManifest(Path("manifest.json"), manifest_));
    warnings_.clear();
    return LoadRecordings(Path("manifest.json"), options, &warnings_);
  }

  // The message of the error that loading gives.
  std::string Message(const LoadOptions& options = {}) { return ProblemOf(Load(options)); }

  ManifestRecording& entry() { return manifest_.recordings[0]; }

  Manifest manifest_;
  Warnings warnings_;
};

}  // namespace pushid
