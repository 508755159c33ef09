// --observed in predict, evaluate and crossvalidate.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

// Recordings that differ, or first frames would have nothing to tell.
class ObservedTest : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    SyntheticOptions options;
    options.subjects = 2;
    options.recordings_per_subject = 6;
    options.frames = 45;
    options.joint_noise_m = 0.0005;
    options.recording_spread = 0.4;
    const auto made = Unwrapped(MakeSyntheticRecordings(options));
    ASSERT_FALSE(WriteSyntheticRecordings(folder_.string(), options, made));
  }
};

TEST_F(ObservedTest, OneFrameIsWhatThereIsWithoutTheFlag) {
  const std::string model = "--model=" + CheckedModel({"--learn_forecasts"});
  for (const bool asked : {false, true}) {
    std::vector<std::string> more = {model, Recordings(),
                                     "--json_out=" + Path(asked ? "one.json" : "none.json")};
    if (asked) more.push_back("--observed=1");
    Succeeded(RunApp("pushid-evaluate", more));
  }
  const auto none = Json(Path("none.json")), one = Json(Path("one.json"));
  for (const char* key : {"hipADE_m", "hipFDE_m", "hipADE_standard_error_m"}) {
    EXPECT_EQ(none["mean"][key], one["mean"][key]);
  }
  EXPECT_FALSE(none["mean"].contains("after_hipADE_m"));
  EXPECT_EQ(one["mean"]["after_hipADE_m"], one["mean"]["hipADE_m"]);
}

TEST_F(ObservedTest, FramesThatAreSeenHelp) {
  const std::string model = "--model=" + CheckedModel({"--learn_forecasts"});
  double before = 1e9;
  for (const int k : {1, 10, 25}) {
    const AppRun run =
        Succeeded(RunApp("pushid-evaluate", {model, Recordings(), "--json_out=" + Path("s.json"),
                                             "--observed=" + std::to_string(k)}));
    const auto json = Json(Path("s.json"));
    EXPECT_EQ(json["observed"], k);
    EXPECT_LT(json["mean"]["hipADE_m"].get<double>(), before);
    before = json["mean"]["hipADE_m"];
    EXPECT_TRUE(json["mean"].contains("inside90_x_share"));
    for (const char* baseline : {"static", "constant_velocity", "kinematic"}) {
      EXPECT_TRUE(json["baselines"][baseline]["mean"].contains("after_hipADE_m")) << baseline;
    }
    EXPECT_TRUE(Contains(run.out, "90 % bands hold"));
    EXPECT_TRUE(Contains(run.out, "kinematic"));
  }
}

TEST_F(ObservedTest, PredictWritesBandsBehindWhatWasSeen) {
  const std::string model = "--model=" + CheckedModel({"--learn_forecasts"});
  const AppRun run =
      Succeeded(RunApp("pushid-predict", {model, Recordings(), "--id=" + id_, "--observed=12",
                                          "--out=" + Path("t.csv")}));
  EXPECT_TRUE(Contains(run.out, "after hipADE"));
  const std::string csv = ReadText(Path("t.csv"));
  EXPECT_TRUE(Contains(csv.substr(0, csv.find('\n')), "hip_x_lower90_m,hip_x_upper90_m"));
}

TEST_F(ObservedTest, HeldOutRecordingsAreScoredBehindTheirFirstFrames) {
  Succeeded(RunApp("pushid-crossvalidate", {Recordings(), "--folds=3", "--repeats=1",
                                            "--observed=12", "--json_out=" + Path("cv.json")}));
  const auto json = Json(Path("cv.json"));
  ASSERT_EQ(json["predictors"].size(), 4u);
  EXPECT_EQ(json["predictors"][1]["name"], "static");
  for (const auto& predictor : json["predictors"]) {
    EXPECT_GT(predictor["mean"]["after_hipADE_m"].get<double>(), 0.0);
  }
  EXPECT_TRUE(json["predictors"][0]["mean"].contains("inside90_y_share"));
  EXPECT_FALSE(json["predictors"][2]["mean"].contains("inside90_y_share"));
  EXPECT_TRUE(json["paired_differences"][0].contains("after_hipADE_m"));
}

TEST_F(ObservedTest, WhatCannotBeIsRefused) {
  const std::string model = "--model=" + CheckedModel({"--learn_forecasts"});
  const auto evaluate = [&](const std::string& observed) {
    return RunApp("pushid-evaluate", {model, Recordings(), observed});
  };
  EXPECT_TRUE(Refused(evaluate("--observed=0"), {"--observed is 0", "at least 1"}));
  EXPECT_TRUE(Refused(evaluate("--observed=-4"), {"--observed is -4"}));
  EXPECT_TRUE(
      Refused(evaluate("--observed=45"), {"recording " + id_ + " has 45 frames", "at most 44"}));
  EXPECT_TRUE(Refused(RunApp("pushid-predict", {model, Recordings(), "--id=" + id_, "--frames=10",
                                                "--observed=12", "--out=" + Path("t.csv")}),
                      {"--frames=10", "--observed=12"}));
  EXPECT_TRUE(Refused(RunApp("pushid-crossvalidate", {Recordings(), "--observed=99"}),
                      {"recording " + id_, "--observed=99"}));
  const std::string plain = "--model=" + FitModel("plain.json");
  EXPECT_TRUE(Refused(RunApp("pushid-evaluate", {plain, Recordings(), "--observed=9"}),
                      {"plain.json", "learned no forecasts", "pushid-check --learn_forecasts"}));
}

}  // namespace
}  // namespace pushid
