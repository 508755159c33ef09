// A fixture: the recordings of app_fixture.h in a skeleton as Mixamo names it, with a joint more,
// in lengths that have no name.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/bvh.h"
#include "datasets/manifest/manifest.h"
#include "tests/apps/app_fixture.h"
#include "tests/datasets/raw_bvh.h"
#include "tests/datasets/recording_folder.h"

namespace pushid {

inline constexpr char kScale[] = "--length_scale=0.0564";

// The synthetic skeleton's joints, in its order, and a thumb behind the left hand.
inline constexpr const char* kNames[] = {
    "Hips",          "Spine",     "Spine1",         "Spine2",     "Neck",         "Head",
    "RightShoulder", "RightArm",  "RightForeArm",   "RightHand",  "LeftShoulder", "LeftArm",
    "LeftForeArm",   "LeftHand",  "LeftHandThumb1", "RightUpLeg", "RightLeg",     "RightFoot",
    "RightToeBase",  "LeftUpLeg", "LeftLeg",        "LeftFoot",   "LeftToeBase"};
inline constexpr int kThumb = 14;

class AnySkeletonTest : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    nlohmann::ordered_json json = Json(manifest_);
    json.erase("units");
    json.erase("length_unit");
    for (auto& entry : json["recordings"]) {
      entry.erase("joints");
      Rename(ResolvePath(manifest_, entry["bvh"][0]));
    }
    recordings_ = "--recordings=" + WriteText("mixamo.json", json.dump(1));
    source_ = ResolvePath(manifest_, json["recordings"][0]["bvh"][0]);
  }

  void Rename(const std::string& path) {
    BvhMotion motion = ReadBvh(path).value();
    const std::vector<double> values = motion.values;
    const int channels = motion.skeleton.num_channels(), frames = motion.num_frames();
    std::vector<BvhJoint>& joints = motion.skeleton.joints;
    int before = 0;
    for (int j = 0; j < kThumb; ++j) before += static_cast<int>(joints[j].channels.size());
    BvhJoint thumb;
    thumb.parent = kThumb - 1;
    thumb.offset = Eigen::Vector3d(30.0, 0.0, -30.0);
    thumb.channels = DefaultBvhChannels(false);
    joints[kThumb - 1].end_sites.clear();
    joints.insert(joints.begin() + kThumb, thumb);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      joints[j].name = "mixamorig:" + std::string(kNames[j]);
      if (j > kThumb && joints[j].parent >= kThumb) ++joints[j].parent;
    }
    motion.values.clear();
    for (int t = 0; t < frames; ++t) {
      const auto row = values.begin() + t * channels;
      motion.values.insert(motion.values.end(), row, row + before);
      motion.values.insert(motion.values.end(), 3, 0.0);
      motion.values.insert(motion.values.end(), row + before, row + channels);
    }
    constexpr double kUnitsPerMillimetre = 1e-3 / 0.0564;
    ASSERT_FALSE(WriteBvh(path, Scaled(motion, kUnitsPerMillimetre)));
  }

  std::string Model() {
    fit_ =
        Succeeded(RunApp("pushid-fit", {recordings_, kScale, "--model_out=" + Path("model.json")}));
    return "--model=" + Path("model.json");
  }

  std::string recordings_, source_;
};

}  // namespace pushid
