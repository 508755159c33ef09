// Process noise through the programs: fits by single steps, drawn futures, most probable paths.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

class LangevinAppTest : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    noisy_ = FitModel("noisy.json", {"--likelihood=innovation"});
    plain_ = FitModel("plain.json");
  }
  std::vector<std::string> Predict(const std::string& model) const {
    return {"--model=" + model, Recordings(), "--id=" + id_, "--out=" + Path("out.csv")};
  }
  static size_t CountLines(const std::string& text) {
    return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  std::string noisy_, plain_;
};

TEST_F(LangevinAppTest, AFitBySingleStepsSaysHowLikely) {
  const std::string model = FitModel("steps.json", {"--likelihood=innovation"});
  EXPECT_TRUE(Contains(fit_.out, "-2 log L"));
  EXPECT_TRUE(Contains(fit_.out, "AIC"));
  EXPECT_TRUE(Contains(fit_.out, "measured_hip"));
  const nlohmann::ordered_json json = Json(model);
  EXPECT_EQ(json.at("model").at("likelihood"), "innovation");
  const auto& score = json.at("likelihood");
  EXPECT_NEAR(score.at("aic").get<double>(),
              score.at("deviance").get<double>() + 2.0 * score.at("parameters").get<int>(), 1e-6);
  const AppRun report = Succeeded(RunApp("pushid-report", {"--model=" + model, "--details"}));
  EXPECT_TRUE(Contains(report.out, "-2 log L"));
}

TEST_F(LangevinAppTest, FuturesAreDrawnScoredAndWritten) {
  std::vector<std::string> predict = Predict(noisy_);
  predict.push_back("--samples=20");
  const AppRun drawn = Succeeded(RunApp("pushid-predict", predict));
  EXPECT_TRUE(Contains(drawn.out, "20 drawn futures"));
  EXPECT_EQ(RunApp("pushid-predict", predict).out, drawn.out) << "the same seed, the same futures";

  const std::string scores = Path("scores.json");
  Succeeded(RunApp("pushid-evaluate",
                   {"--model=" + noisy_, Recordings(), "--samples=20", "--json_out=" + scores}));
  const nlohmann::ordered_json mean = Json(scores).at("mean");
  for (const char* key : {"inside90_x_share", "crps_m", "crps_standard_error_m"}) {
    EXPECT_TRUE(mean.contains(key)) << key;
  }

  const AppRun held_out = Succeeded(
      RunApp("pushid-crossvalidate",
             {Recordings(), "--likelihood=innovation", "--folds=2", "--repeats=1", "--samples=10",
              "--compare=steps: --likelihood=transition", "--json_out=" + scores, "--quiet"}));
  for (int i : {0, 1}) {
    EXPECT_TRUE(Json(scores).at("predictors")[i].at("mean").contains("inside90_x_share")) << i;
  }
  EXPECT_TRUE(Contains(held_out.out, "steps: 90 % bands hold"));

  const AppRun line = Succeeded(RunApp(
      "pushid-formation", {"--model=" + noisy_, "--formation=line", "--people=1", "--samples=10"}));
  EXPECT_TRUE(Contains(line.out, "10 drawn futures"));
}

TEST_F(LangevinAppTest, TheMostProbablePathAndItsEnds) {
  const std::string model = "--model=" + FitModel("states.json", {"--likelihood=transition"});
  const AppRun run =
      RunApp("pushid-path", {model, "--from=xd=0.4", "--to=x=0.2,xd=0; x=3,xd=0", "--frames=60",
                             "--out=" + Path("path.csv"), "--json_out=" + Path("path.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(Contains(run.out, "most probable: x=0.2,xd=0"));
  EXPECT_EQ(CountLines(ReadText(Path("path.csv"))), 61u);
  const nlohmann::ordered_json json = Json(Path("path.json"));
  EXPECT_LT(json.at("paths")[0].at("action").get<double>(),
            json.at("paths")[1].at("action").get<double>());
}

TEST_F(LangevinAppTest, BadUse) {
  std::vector<std::string> predict = Predict(plain_);
  predict.push_back("--samples=10");
  EXPECT_EQ(RunApp("pushid-predict", predict).exit_code, 1);
  EXPECT_TRUE(Contains(RunApp("pushid-predict", predict).err, "process noise"));
  const std::string model = "--model=" + noisy_;
  const std::vector<std::pair<std::vector<std::string>, std::string>> paths = {
      {{"--model=" + plain_, "--to=x=1"}, "no process noise"},
      {{model}, "--to"},
      {{model, "--to=x=1", "--from=z=1"}, "'z'"},
      {{model, "--to=theta=2"}, "theta"},
      {{model, "--to=x=1", "--frames=3"}, "--frames"},
      {{model, "--to=x=1", "--set=sigma_x=0"}, "sigma_x"},
  };
  for (const auto& [flags, says] : paths) {
    EXPECT_TRUE(Refused(RunApp("pushid-path", flags), {says})) << says;
  }
  const std::vector<std::pair<std::vector<std::string>, std::string>> fits = {
      {{"--likelihood=posterior"}, "--likelihood"},
      {{"--likelihood=innovation", "--stance=steps"}, "--stance=steps"},
  };
  for (const auto& [flags, says] : fits) {
    std::vector<std::string> all = flags;
    all.push_back(Recordings());
    EXPECT_TRUE(Refused(RunApp("pushid-fit", all), {says})) << says;
  }
  EXPECT_TRUE(
      Refused(RunApp("pushid-crossvalidate", {Recordings(), "--samples=10"}), {"process noise"}));
}

}  // namespace
}  // namespace pushid
