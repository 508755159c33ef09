// A skeleton as Mixamo names it, in units that have no name, from the fit to BVH and glTF.
#include <gtest/gtest.h>

#include "datasets/formats/bvh.h"
#include "datasets/manifest/manifest.h"
#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

constexpr char kScale[] = "--length_scale=0.0564";

// The synthetic skeleton's joints, in its order, and a thumb behind the left hand.
constexpr const char* kNames[] = {
    "Hips",          "Spine",     "Spine1",         "Spine2",     "Neck",         "Head",
    "RightShoulder", "RightArm",  "RightForeArm",   "RightHand",  "LeftShoulder", "LeftArm",
    "LeftForeArm",   "LeftHand",  "LeftHandThumb1", "RightUpLeg", "RightLeg",     "RightFoot",
    "RightToeBase",  "LeftUpLeg", "LeftLeg",        "LeftFoot",   "LeftToeBase"};
constexpr int kThumb = 14;

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
    BvhMotion motion = ReadBvh(path, {LengthUnit::kMillimetre}).value();
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
    InOddUnits(&motion);
    ASSERT_FALSE(WriteBvh(path, motion, LengthUnit::kMetre));
  }

  // Millimetres to lengths of 0.0564 m.
  static void InOddUnits(BvhMotion* motion) {
    constexpr double kUnitsPerMillimetre = 1e-3 / 0.0564;
    std::size_t value = 0;
    for (BvhJoint& joint : motion->skeleton.joints) {
      joint.offset *= kUnitsPerMillimetre;
      for (Eigen::Vector3d& end : joint.end_sites) end *= kUnitsPerMillimetre;
    }
    while (value < motion->values.size()) {
      for (const BvhJoint& joint : motion->skeleton.joints) {
        for (const BvhChannel channel : joint.channels) {
          if (!IsRotation(channel)) motion->values[value] *= kUnitsPerMillimetre;
          ++value;
        }
      }
    }
    motion->length_unit = LengthUnit::kMetre;
  }

  std::string Model() {
    fit_ = RunApp("pushid-fit", {recordings_, kScale, "--model_out=" + Path("model.json")});
    EXPECT_EQ(fit_.exit_code, 0) << fit_.err;
    return "--model=" + Path("model.json");
  }

  std::string recordings_, source_;
};

TEST_F(AnySkeletonTest, PredictedBodiesComeInTheHierarchyThatWentIn) {
  const std::string model = Model();
  const auto predict = [&](const std::string& out) {
    return RunApp(
        "pushid-predict",
        {model, recordings_, kScale, "--id=" + id_, "--restoration=rigid", "--out=" + Path(out),
         "--joints_out=" + Path("joints.csv"), "--json_out=" + Path("joints.json")});
  };
  const AppRun run = predict("motion.bvh");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "") << "nothing had to be filled";
  const auto source = ReadBvh(source_), out = ReadBvh(Path("motion.bvh"));
  ASSERT_TRUE(out.ok()) << out.error().ToString();
  ASSERT_EQ(out.value().skeleton.joints.size(), source.value().skeleton.joints.size());
  for (std::size_t j = 0; j < source.value().skeleton.joints.size(); ++j) {
    const BvhJoint &was = source.value().skeleton.joints[j], &is = out.value().skeleton.joints[j];
    EXPECT_EQ(is.name, was.name);
    EXPECT_EQ(is.offset, was.offset);
    EXPECT_EQ(is.channels, was.channels);
  }
  EXPECT_EQ(out.value().num_frames(), source.value().num_frames());
  EXPECT_TRUE(Contains(ReadText(Path("joints.csv")), ",mixamorig:LeftHandThumb1,"));
  EXPECT_EQ(Json(Path("joints.json"))["joint_names"].size(), 23u);

  ASSERT_EQ(predict("motion.glb").exit_code, 0);
  EXPECT_EQ(ReadText(Path("motion.glb")).substr(0, 4), "glTF");
  EXPECT_TRUE(Contains(ReadText(Path("motion.glb")), "mixamorig:LeftHandThumb1"));
  const AppRun bare = RunApp("pushid-predict", {model, recordings_, kScale, "--id=" + id_,
                                                "--out=" + Path("motion.gltf")});
  EXPECT_TRUE(Refused(bare, {"--out=", "motion.gltf needs bodies"}));
}

TEST_F(AnySkeletonTest, BodiesAreJudgedAndShown) {
  const std::string model = Model();
  const AppRun evaluated = RunApp(
      "pushid-evaluate",
      {model, recordings_, kScale, "--restoration=rigid", "--json_out=" + Path("scores.json")});
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
  EXPECT_TRUE(Contains(ReadText(Path("scores.json")), "MPJPE"));
  const AppRun shown = RunApp(
      "pushid-animate", {model, recordings_, kScale, "--id=" + id_, "--out=" + Path("m.html")});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_EQ(shown.err, "");
}

TEST_F(AnySkeletonTest, WithoutItsScaleItIsNoPerson) {
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {recordings_, "--model_out=" + Path("m.json")}),
                      {"--length_scale"}));
}

}  // namespace
}  // namespace pushid
