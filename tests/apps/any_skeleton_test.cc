// A skeleton as Mixamo names it, in units that have no name, from the fit to BVH.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/any_skeleton_fixture.h"

namespace pushid {
namespace {

TEST_F(AnySkeletonTest, PredictedBodiesComeInTheHierarchyThatWentIn) {
  const std::string model = Model();
  const auto predict = [&](const std::string& out) {
    return RunApp("pushid-predict",
                  {model, recordings_, kScale, "--id=" + id_, "--restoration=rigid",
                   "--out=" + Path(out), "--poses_out=" + Path("joints.csv")});
  };
  const AppRun run = Succeeded(predict("motion.bvh"));
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

  const AppRun bare = RunApp(
      "pushid-predict", {model, recordings_, kScale, "--id=" + id_, "--out=" + Path("bare.bvh")});
  EXPECT_TRUE(Refused(bare, {"--out=", "bare.bvh needs bodies"}));
}

TEST_F(AnySkeletonTest, BodiesAreJudgedAndShown) {
  const std::string model = Model();
  Succeeded(RunApp("pushid-evaluate", {model, recordings_, kScale, "--restoration=rigid",
                                       "--json_out=" + Path("scores.json")}));
  EXPECT_TRUE(Contains(ReadText(Path("scores.json")), "MPJPE"));
  const AppRun shown = Succeeded(RunApp(
      "pushid-animate", {model, recordings_, kScale, "--id=" + id_, "--out=" + Path("m.html")}));
  EXPECT_EQ(shown.err, "");
}

TEST_F(AnySkeletonTest, WithoutItsScaleItIsNoPerson) {
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {recordings_, "--model_out=" + Path("m.json")}),
                      {"--length_scale"}));
}

}  // namespace
}  // namespace pushid
