// Forecasts as files and pictures.
#include "ident/forecasts/forecast_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/datasets/raw_bvh.h"
#include "tests/models/generators/generator_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

ForecastScene SwayingScene() {
  ForecastScene scene;
  scene.title = "sway <1>";
  scene.layout = FourParticles();
  const Trajectories motion = SwayingMotion(18, 0.4f);
  scene.observed = motion.leftCols(12);
  scene.recorded = motion.rightCols(6);
  scene.forecast = motion.rightCols(6).array() + 0.01f;
  scene.futures = {{scene.forecast, -1.0}, {scene.recorded, -2.0}};
  return scene;
}

class ForecastSceneTest : public TempDirTest {};

TEST_F(ForecastSceneTest, ABvhHoldsThePositionsExactly) {
  const ForecastScene scene = SwayingScene();
  const auto files = Unwrapped(WritePoses(Path("m.bvh"), scene));
  ASSERT_EQ(files.size(), 3u);
  EXPECT_TRUE(Contains(files[2], "m_future_2.bvh"));
  ASSERT_TRUE(WritePoses(Path("m.BVH"), scene).ok());
  EXPECT_EQ(ReadText(Path("m.BVH")).substr(0, 9), "HIERARCHY") << "whatever the case";
  const auto read = BvhInMetres(Path("m.bvh"));
  ASSERT_EQ(read.num_frames(), 18);
  for (int i = 0; i < 4; ++i) {
    const int joint = read.skeleton->Find(scene.layout.names[i]);
    ASSERT_GE(joint, 0);
    for (int t : {0, 11, 17}) {
      const Eigen::Vector3f expected = t < 12 ? scene.observed.col(t).segment<3>(3 * i)
                                              : scene.forecast.col(t - 12).segment<3>(3 * i);
      const auto& found = read.positions[joint][t];
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 1e-5);
    }
  }
}

// A hip that no fixed point holds is the root itself.
TEST_F(ForecastSceneTest, WithoutFixedPointsTheFirstParticleIsTheRoot) {
  ParticleLayout layout = FourParticles();
  layout.parents[0] = kNoBone;
  const BvhMotion bvh = ToBvh(SwayingMotion(3, 0.0f), layout, 0.04);
  ASSERT_EQ(bvh.skeleton.joints.size(), 4u);
  EXPECT_EQ(bvh.skeleton.joints[0].name, "spine");
  EXPECT_EQ(bvh.num_frames(), 3);
}

TEST_F(ForecastSceneTest, ACsvHasARowPerSourceFrameAndJoint) {
  ASSERT_TRUE(WritePoses(Path("m.csv"), SwayingScene()).ok());
  const std::string text = ReadText(Path("m.csv"));
  EXPECT_EQ(text.find("frame,time_s,source,future,joint,x_m,y_m,z_m\n0,0,observed,0,spine,"), 0u);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 4 * (12 + 6 + 6 + 2 * 6));
  EXPECT_TRUE(Contains(text, "\n17,0.68,future,2,right,"));
  EXPECT_FALSE(WritePoses(Path("m.txt"), SwayingScene()).ok());
}

TEST_F(ForecastSceneTest, PicturesShowTheFan) {
  const std::string page = AnimationHtml({ToAnimation(SwayingScene())});
  for (const char* shown : {"> recorded<", "> sampled futures<", "> forecast<"}) {
    EXPECT_TRUE(Contains(page, shown)) << shown;
  }
  EXPECT_TRUE(Contains(page, "<title>sway &lt;1&gt;</title>"));
  EXPECT_TRUE(Contains(page, "\"frames\":18"));
  EXPECT_FALSE(Contains(page, "http")) << "the page needs no network";
}

}  // namespace
}  // namespace pushid
