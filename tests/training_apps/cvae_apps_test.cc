// LDP's chain as a user trains and uses it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

class CvaeAppTest : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    model_ = "--model=" + FitModel();
  }
  AppRun Train(const std::string& out, std::vector<std::string> more) {
    more.insert(more.end(), {Recordings(), model_, "--out=" + Path(out)});
    return RunApp("pushid-train-restoration", more, 120);
  }

  std::string model_;
};

TEST_F(CvaeAppTest, TheCvaeTrainsAndIsUsed) {
  Succeeded(Train("v", {"--kind=cvae", "--effort=0.001"}));
  Succeeded(RunApp("pushid-evaluate", {model_, Recordings(), "--restoration=" + Path("v")}));
}

// LDP's sampler as published: sizes are said beside the release's; z is drawn where asked for.
TEST_F(CvaeAppTest, ThePublishedCvaeSaysItsSizesAndDraws) {
  const std::vector<std::string> flags = {"--kind=cvae", "--effort=0.001", "--training=published",
                                          "--coordinates=ldp"};
  const AppRun run = Succeeded(Train("v", flags));
  EXPECT_TRUE(Contains(run.err,
                       "lower autoencoder: 865536 parameters (release: 865536)\n"
                       "lower sampler: 136960 parameters\n"
                       "upper autoencoder: 1097904 parameters (release: 1097904)\n"));
  const auto json = Json(Path("v/restoration.json"));
  EXPECT_EQ(json["settings"]["training"], "published");
  EXPECT_EQ(json["training"]["parameters"]["upper autoencoder"], 1097904);
  const auto joints = [&](const std::vector<std::string>& more) {
    Succeeded(RunApp("pushid-predict",
                     With({model_, Recordings(), "--restoration=" + Path("v"), "--id=" + id_,
                           "--out=" + Path("m.bvh"), "--poses_out=" + Path("j.csv")},
                          more)));
    return ReadText(Path("j.csv"));
  };
  const std::string mean = joints({}), drawn = joints({"--latent=draw"});
  EXPECT_NE(mean, drawn);
  EXPECT_EQ(drawn, joints({"--latent=draw:1"}));
  EXPECT_NE(drawn, joints({"--latent=draw:2"}));
}

TEST_F(CvaeAppTest, TheCvaeIsCrossValidatedByMeanAndByDraws) {
  const AppRun run = Succeeded(RunApp(
      "pushid-train-restoration", {Recordings(), model_, "--crossvalidate=2", "--kind=cvae",
                                   "--effort=0.001", "--quiet", "--json_out=" + Path("cv.json")}));
  EXPECT_TRUE(Contains(run.out, "restoration drawn"));
  const auto json = Json(Path("cv.json"));
  const double mean = json["mean"]["MPJPE_m"], drawn = json["restoration_drawn"]["mean"]["MPJPE_m"];
  EXPECT_GT(drawn, 0.0);
  EXPECT_NE(drawn, mean);
}

// Pendulums with rods that move, restored through the chain.
TEST_F(CvaeAppTest, IsTrainedOnRodsThatMove) {
  const std::string model = "--model=" + FitModel("rod.json", {"--rod=ldp:2", "--fix=Kd_theta=70"});
  Succeeded(RunApp("pushid-simulate", {"--out=" + Path("short"), "--people=2", "--frames=16",
                                       "--recordings_per_person=2", "--quiet"}));
  const std::string few = "--recordings=" + Path("short/manifest.json");
  Succeeded(RunApp("pushid-train-restoration",
                   {few, model, "--crossvalidate=2", "--kind=cvae", "--effort=0.001",
                    "--training=published", "--quiet"},
                   400));
}

}  // namespace
}  // namespace pushid
