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

TEST_F(ForecastSceneTest, ACsvHasARowPerSourceFrameAndJoint) {
  ASSERT_FALSE(WriteForecastCsv(Path("m.csv"), SwayingScene()));
  const std::string text = ReadText(Path("m.csv"));
  EXPECT_EQ(text.find("frame,time_s,source,future,joint,x_m,y_m,z_m\n0,0,observed,0,spine,"), 0u);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 4 * (12 + 6 + 6 + 2 * 6));
  EXPECT_TRUE(Contains(text, "\n17,0.68,future,2,right,"));
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
