// pushid-train-restoration and what uses its output, as a user runs them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "datasets/files/names.h"
#include "tests/apps/any_skeleton_fixture.h"
#include "tests/apps/app_fixture.h"
#include "tests/datasets/raw_bvh.h"

namespace pushid {
namespace {

class RestorationAppTest : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    model_ = "--model=" + FitModel();
  }
  AppRun Train(const std::string& out, std::vector<std::string> more = {}) {
    more.insert(more.end(), {Recordings(), model_, "--out=" + Path(out), "--quiet"});
    return RunApp("pushid-train-restoration", more, 120);
  }
  std::string Trained() {
    Succeeded(Train("r", {"--effort=0.3"}));
    return "--restoration=" + Path("r");
  }

  std::string model_;
};

// The positions of a file of joints, row by row.
std::vector<Eigen::Vector3d> JointsOf(const std::string& path) {
  std::istringstream lines(ReadText(path));
  std::string line;
  std::getline(lines, line);
  std::vector<Eigen::Vector3d> joints;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = SplitList(line);
    joints.emplace_back(std::stod(cells[5]), std::stod(cells[6]), std::stod(cells[7]));
  }
  return joints;
}

TEST_F(RestorationAppTest, TrainsEvaluatesAndPredicts) {
  const std::string restoration = Trained();
  const AppRun evaluate = Succeeded(RunApp(
      "pushid-evaluate", {model_, Recordings(), restoration, "--json_out=" + Path("scores.json")}));
  EXPECT_TRUE(Contains(evaluate.out, "MPJPE"));
  const auto json = Json(Path("scores.json"));
  for (const char* key : {"MPJPE_m", "hipADE_m", "MBLE_m", "FSE_cm", "relative_MPJPE_m"}) {
    EXPECT_TRUE(json["mean"].contains(key)) << key;
    EXPECT_TRUE(json["baselines"]["static"]["mean"].contains(key)) << key;
  }
  // The recorded bones themselves vary: the joints are noisy by 2 mm.
  EXPECT_LT(json["mean"]["MBLE_m"].get<double>(), 2e-3);
  EXPECT_GT(json["recordings"][0]["MPJPE_m"].get<double>(), 0.0);
  const AppRun predict = Succeeded(
      RunApp("pushid-predict", {model_, Recordings(), restoration, "--id=" + id_,
                                "--out=" + Path("m.bvh"), "--poses_out=" + Path("j.csv")}));
  EXPECT_TRUE(Contains(predict.out, "MPJPE"));
  const auto bvh = BvhInMetres(Path("m.bvh"));
  EXPECT_EQ(bvh.num_frames(), 45);
  const std::vector<Eigen::Vector3d> joints = JointsOf(Path("j.csv"));
  EXPECT_LT((joints[44 * 22 + 9] - bvh.positions[9][44]).norm(), 4e-5);
}

// A skeleton of other names with a joint more learns and moves by its roles, and its own joints
// come out.
TEST_F(AnySkeletonTest, IsLearnedAndMoved) {
  const std::string model = Model(), restoration = "--restoration=" + Path("r");
  Succeeded(RunApp("pushid-train-restoration",
                   {recordings_, kScale, model, "--out=" + Path("r"), "--effort=0.3", "--quiet"},
                   120));
  Succeeded(RunApp("pushid-predict", {model, recordings_, kScale, restoration, "--id=" + id_,
                                      "--out=" + Path("m.bvh"), "--poses_out=" + Path("j.csv")}));
  const std::vector<Eigen::Vector3d> joints = JointsOf(Path("j.csv"));
  const auto bvh = Unwrapped(ReadBvh(Path("m.bvh")));
  ASSERT_EQ(joints.size(), bvh.num_frames() * bvh.skeleton.joints.size());
  EXPECT_EQ(bvh.skeleton.joints[kThumb].name, "mixamorig:LeftHandThumb1");
  const auto place = [&](int frame, int joint) {
    return joints[frame * bvh.skeleton.joints.size() + joint];
  };
  for (int t : {0, 20, 44}) {
    EXPECT_NEAR((place(t, kThumb) - place(t, kThumb - 1)).norm(), 0.03 * std::sqrt(2.0), 2e-5);
  }
  EXPECT_GT((place(44, kThumb) - place(0, kThumb)).norm(), 0.01) << "it goes with the hand";
}

TEST_F(RestorationAppTest, AnimatesAndPosesFormations) {
  const std::string restoration = Trained();
  const AppRun animate =
      Succeeded(RunApp("pushid-animate", {model_, Recordings(), restoration, "--id=" + id_,
                                          "--out=" + Path("a.html")}));
  const std::string html = ReadText(Path("a.html"));
  EXPECT_TRUE(Contains(html, "</html>"));
  EXPECT_FALSE(Contains(html, "http")) << "the page must stand alone";
  const AppRun simulate = Succeeded(RunApp(
      "pushid-formation", {model_, restoration, "--formation=line", "--people=3", "--duration=1",
                           "--recordings=" + manifest_, "--html_out=" + Path("f.html"),
                           "--bodies_out=" + Path("f.bvh")}));
  EXPECT_TRUE(std::filesystem::exists(Path("f_2_p02.bvh")));
  EXPECT_TRUE(Contains(simulate.err, "--more_settings=groups")) << "it saw people alone";
  EXPECT_FALSE(Contains(animate.err, "--more_settings")) << "one person is no group";
}

TEST_F(RestorationAppTest, RepeatsItself) {
  const std::vector<std::string> five = {"--seed=5", "--effort=0.3"};
  Succeeded(Train("a", five));
  Succeeded(Train("b", five));
  EXPECT_EQ(ReadText(Path("a/weights.npy")), ReadText(Path("b/weights.npy")));
  EXPECT_EQ(ReadText(Path("a/restoration.json")), ReadText(Path("b/restoration.json")));
  Succeeded(Train("d", {"--seed=6", five[1]}));
  EXPECT_NE(ReadText(Path("a/weights.npy")), ReadText(Path("d/weights.npy")));
}

TEST_F(RestorationAppTest, CrossValidatesTheWholeChain) {
  Succeeded(
      RunApp("pushid-train-restoration", {Recordings(), model_, "--crossvalidate=2", "--effort=0.1",
                                          "--quiet", "--json_out=" + Path("cv.json")}));
  const auto json = Json(Path("cv.json"));
  EXPECT_EQ(json["recordings"].size(), 12u);
  EXPECT_EQ(json["mean"]["recordings"], 12);
  EXPECT_GT(json["true_pendulum"]["mean"]["MPJPE_m"].get<double>(), 0.0);
}

// What a restoration was told stands in its folder, and those who use it need not know.
TEST_F(RestorationAppTest, SeesWhatItIsToldTo) {
  for (const char* view : {"neighbours", "pose"}) {
    Succeeded(Train("v", {"--effort=0.1", std::string("--sees=") + view}));
    EXPECT_EQ(Json(Path("v/restoration.json"))["settings"]["sees"], view);
    Succeeded(
        RunApp("pushid-evaluate", {model_, Recordings(), "--restoration=" + Path("v"), "--quiet"}));
  }
}

// Physics alone differ too: other recordings are fitted.
TEST_F(RestorationAppTest, CrossValidatesOnTheFoldsOfGenerators) {
  const auto rigid = [&](const std::string& scheme) {
    Succeeded(RunApp("pushid-train-restoration",
                     {Recordings(), model_, "--crossvalidate=2", "--effort=0.01", "--quiet",
                      "--scheme=" + scheme, "--json_out=" + Path("cv.json")}));
    return Json(Path("cv.json"))["baselines"]["rigid"]["mean"]["hipADE_m"].get<double>();
  };
  const double interleaved = rigid("interleaved");
  EXPECT_NE(interleaved, rigid("stratified"));
  Succeeded(RunApp("pushid-train-generator",
                   {Recordings(), "--kind=diffusion", "--crossvalidate=2", "--scheme=interleaved",
                    "--physics=" + Path("model.json"), "--blend=0.5", "--steps=2", "--batch=2",
                    "--quiet", "--json_out=" + Path("g.json")}));
  EXPECT_DOUBLE_EQ(Json(Path("g.json"))["baselines"]["rigid"]["mean"]["hipADE_m"], interleaved);
  EXPECT_TRUE(Refused(RunApp("pushid-train-restoration",
                             {Recordings(), model_, "--scheme=subject", "--out=" + Path("o")}),
                      {"--scheme needs --crossvalidate"}));
}

// Shown first frames, bodies err less.
TEST_F(RestorationAppTest, CrossValidatesAfterFramesThatWereSeen) {
  const auto error = [&](const std::string& observed) {
    Succeeded(RunApp("pushid-train-restoration",
                     {Recordings(), model_, "--crossvalidate=2", "--effort=0.1", "--quiet",
                      observed, "--json_out=" + Path("cv.json")}));
    const auto json = Json(Path("cv.json"));
    const double unseen = json["mean"]["MPJPE_m"];
    const auto all = json["baselines"].find("restoration_all_frames");
    EXPECT_EQ(all != json["baselines"].end(), observed == "--observed=20");
    if (all == json["baselines"].end()) return unseen;
    // Frames that were seen err as well: their bodies are restored, not copied.
    const double of_all = (*all)["mean"]["MPJPE_m"];
    EXPECT_LT(of_all, unseen);
    return of_all;  // to compare with the same frames
  };
  EXPECT_LT(error("--observed=20"), error("--seed=1"));
  EXPECT_TRUE(Refused(RunApp("pushid-train-restoration",
                             {Recordings(), model_, "--observed=20", "--out=" + Path("o")}),
                      {"--observed needs --crossvalidate"}));
}

TEST_F(RestorationAppTest, RefusesWhatMakesNoSense) {
  const auto refused = [&](const std::string& app, std::vector<std::string> flags,
                           const std::vector<std::string>& says) {
    flags.insert(flags.end(), {model_, Recordings()});
    EXPECT_TRUE(Refused(RunApp(app, flags), says)) << app;
  };
  const std::string train = "pushid-train-restoration";
  refused(train, {}, {"--out"});
  refused(train, {"--out=" + Path("x"), "--kind=best"}, {"--kind", "best", "window", "cvae"});
  refused(train, {"--out=" + Path("x"), "--effort=0"}, {"--effort"});
  refused(train, {"--crossvalidate=1"}, {"--crossvalidate"});
  refused(train, {"--out=" + Path("x"), "--coordinates=hip"}, {"--coordinates"});
  refused(train, {"--out=" + Path("x"), "--sees=people"}, {"--sees", "neighbours"});
  refused(train, {"--out=" + Path("x"), "--kind=cvae", "--sees=neighbours"}, {"--kind=window"});
  refused(train, {"--out=" + Path("x"), "--nohalves"}, {"--kind=cvae"});
  refused(train, {"--out=" + Path("x"), "--training=published"}, {"--training", "--kind=cvae"});
  refused(train, {"--out=" + Path("x"), "--coordinates=ldp"}, {"--coordinates", "--kind=cvae"});
  refused("pushid-evaluate", {"--restoration=" + Path("none")}, {"restoration.json"});
  refused("pushid-predict", {"--id=" + id_, "--out=" + Path("m.bvh")}, {"--restoration"});
  refused("pushid-predict",
          {"--id=" + id_, "--out=" + Path("m.bvh"), "--restoration=rigid", "--postprocess=magic"},
          {"--postprocess", "magic", "fade"});
  refused("pushid-animate", {"--id=" + id_}, {"--out"});
  refused("pushid-evaluate", {"--latent=draw"}, {"--latent", "--restoration"});
  refused("pushid-evaluate", {"--restoration=rigid", "--latent=mean:2"}, {"draw:2"});
  refused("pushid-evaluate", {"--restoration=rigid", "--latent=draw"}, {"--kind=cvae"});
  EXPECT_TRUE(Refused(RunApp("pushid-formation", {model_, "--formation=line", "--poses_out=x.csv"}),
                      {"--poses_out", "--restoration"}));
}

}  // namespace
}  // namespace pushid
