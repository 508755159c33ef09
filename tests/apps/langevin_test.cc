// Process noise through the programs: fits by single steps, most probable paths.
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
}

}  // namespace
}  // namespace pushid
