// pushid-evaluate, pushid-predict and pushid-crossvalidate on synthetic recordings.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using EvaluateAppTest = AppTest;
using PredictAppTest = AppTest;
using CrossValidateAppTest = AppTest;

// Rows of a CSV file; the first is the header.
std::vector<std::vector<std::string>> ReadCsv(const std::string& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(ReadText(path));
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

double LastNumber(const std::string& path, const std::string& column) {
  const auto rows = ReadCsv(path);
  for (size_t i = 0; i < rows[0].size(); ++i) {
    if (rows[0][i] == column) return std::atof(rows.back()[i].c_str());
  }
  ADD_FAILURE() << "no column " << column;
  return NAN;
}

void ExpectScore(const nlohmann::ordered_json& json, const char* what) {
  ASSERT_TRUE(json.contains("hipADE_m") && json.contains("hipFDE_m")) << what << ": " << json;
  EXPECT_GT(json["hipADE_m"].get<double>(), 0.0) << what;
  EXPECT_GT(json["hipFDE_m"].get<double>(), 0.0) << what;
}

TEST_F(EvaluateAppTest, ScoresStandUnderTheAgreedKeys) {
  const std::string model = "--model=" + FitModel();
  const AppRun run = Succeeded(RunApp(
      "pushid-evaluate", {model, Recordings(), "--details", "--json_out=" + Path("scores.json")}));
  const nlohmann::ordered_json json = Json(Path("scores.json"));
  ASSERT_EQ(json["recordings"].size(), 12u);
  double sum = 0.0;
  for (const auto& row : json["recordings"]) {
    ExpectScore(row, "recording");
    EXPECT_TRUE(row.contains("id"));
    sum += row["hipADE_m"].get<double>();
  }
  EXPECT_EQ(json["recordings"][0]["id"], id_);
  EXPECT_EQ(json["recordings"][0]["frames"], 45);
  EXPECT_NEAR(json["mean"]["hipADE_m"].get<double>(), sum / 12, 1e-12);
  ExpectScore(json["mean"], "mean");
  ExpectScore(json["baselines"]["static"]["mean"], "static");
  ExpectScore(json["baselines"]["constant_velocity"]["mean"], "constant_velocity");
  EXPECT_LT(json["mean"]["hipADE_m"], json["baselines"]["static"]["mean"]["hipADE_m"]);
  EXPECT_LT(json["mean"]["hipADE_m"].get<double>(), 0.05) << "the model made these recordings";
  for (const char* part : {"mean over recordings", "constant velocity"}) {
    EXPECT_TRUE(Contains(run.out, part));
  }
  EXPECT_TRUE(Contains(OneLine(Succeeded(RunApp("pushid-evaluate", {model, Recordings()})).out),
                       "The model was fitted to 12 of the 12 recordings"));
  EXPECT_FALSE(json.contains("person")) << "the fit's own pushes";
}

TEST_F(EvaluateAppTest, OfExternalPushesItSaysWhoseAnswerItIs) {
  const std::string model = "--model=" + FitModel();
  const std::string external = ChangedManifest([](nlohmann::ordered_json& json) {
    for (auto& recording : json["recordings"]) recording["push_kind"] = "external";
  });
  const std::string said =
      "person: of 2 people in 12 recordings of net pushes (--stance=slide); given 0.2 m/s in 0.6 s "
      "at the hip it ends ";
  const std::string readme = ReadText(PUSHID_SOURCE_DIR "/models/README.md");
  EXPECT_TRUE(Contains(readme, "\n| 0.2 | 0.6 | 0.15 | 0.02 / ")) << "the measured pushes";
  EXPECT_TRUE(Contains(readme, "\n| 0.62 | 0.86 | 0.88 | 0.01 / 0.68 "));
  for (const char* more : {"--details=false", "--details"}) {
    const AppRun run = Succeeded(
        RunApp("pushid-evaluate", {model, external, more, "--json_out=" + Path("scores.json")}));
    EXPECT_TRUE(Contains(OneLine(run.out), said));
    EXPECT_TRUE(
        Contains(OneLine(run.out), " m away (ten measured people: 0.02 m); given 0.62 m/s"));
    EXPECT_TRUE(Contains(OneLine(run.out), " m away (ten measured people: 0.68 m)"));
    EXPECT_EQ(Json(Path("scores.json"))["person"].get<std::string>().find(said), 0u);
  }
  const std::vector<std::string> predict = {model, "--id=" + id_, "--out=" + Path("path.csv")};
  EXPECT_TRUE(
      Contains(OneLine(Succeeded(RunApp("pushid-predict", With(predict, {external}))).out), said));
  EXPECT_FALSE(Contains(Succeeded(RunApp("pushid-predict", With(predict, {Recordings()}))).out,
                        "person: of 2"));
}

TEST_F(EvaluateAppTest, AWhatIfChangesTheScores) {
  const std::string model = "--model=" + FitModel();
  const std::string out = Path("scores.json");
  Succeeded(RunApp("pushid-evaluate", {model, Recordings(), "--json_out=" + out}));
  const double before = Json(out)["mean"]["hipADE_m"];
  Succeeded(RunApp("pushid-evaluate", {model, Recordings(), "--json_out=" + out, "--set=mu=200"}));
  EXPECT_GT(Json(out)["mean"]["hipADE_m"].get<double>(), before);
}

TEST_F(EvaluateAppTest, ARolloutThatFailsIsNamedAndTheOthersGoOn) {
  const std::string model = "--model=" + FitModel();
  const AppRun run =
      Succeeded(RunApp("pushid-evaluate", {model, Recordings(), "--json_out=" + Path("scores.json"),
                                           "--per_recording", "--set=Kp_theta=1,tail_torque=0.8"}));
  const nlohmann::ordered_json json = Json(Path("scores.json"));
  size_t failed = 0;
  for (const auto& row : json["recordings"]) {
    if (!row.contains("failure")) continue;
    ++failed;
    EXPECT_TRUE(Contains(row["failure"], "leaves the model's domain"));
    EXPECT_TRUE(Contains(row["failure"], "frame "));
    EXPECT_TRUE(Contains(OneLine(run.out), row["failure"]));
  }
  EXPECT_GT(failed, 0u);
  ASSERT_LT(failed, 12u);
  EXPECT_EQ(json["mean"]["recordings"], 12 - failed);
}

TEST_F(PredictAppTest, WritesOneRowPerFrameWithNothingButNumbers) {
  const std::string model = "--model=" + FitModel();
  const std::string out = Path("trajectory.csv");
  const AppRun run =
      Succeeded(RunApp("pushid-predict", {model, Recordings(), "--id=" + id_, "--out=" + out}));
  EXPECT_TRUE(Contains(run.out, "45 frames"));
  EXPECT_TRUE(Contains(run.out, "hipADE"));
  const auto rows = ReadCsv(out);
  ASSERT_EQ(rows.size(), 46u);
  for (size_t i = 1; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), rows[0].size()) << "row " << i;
    for (size_t j = 0; j < rows[i].size(); ++j) {
      if (rows[0][j] == "subject") continue;
      char* end = nullptr;
      EXPECT_TRUE(std::isfinite(std::strtod(rows[i][j].c_str(), &end)) && *end == '\0')
          << rows[0][j] << " = " << rows[i][j];
    }
  }
}

TEST_F(PredictAppTest, ASlipperyFloorCarriesFurtherAndFramesMayGoOn) {
  const std::string model = "--model=" + FitModel();
  double last[2];
  const char* sets[] = {"--set=mu=20", "--set=mu=200"};
  for (int i : {0, 1}) {
    const std::string out = Path("trajectory.csv");
    Succeeded(RunApp("pushid-predict", {model, Recordings(), "--id=" + id_, "--out=" + out,
                                        "--frames=120", sets[i]}));
    EXPECT_EQ(ReadCsv(out).size(), 121u);
    last[i] = LastNumber(out, "hip_x_m");
  }
  EXPECT_GT(last[0], last[1] + 0.02);
}

// Further with a harder push and with three of them; errors against the recording are not printed.
TEST_F(PredictAppTest, HarderPushesAndRepeatedOnes) {
  const std::string model = "--model=" + FitModel(), out = Path("trajectory.csv");
  const auto predict = [&](std::vector<std::string> flags) {
    flags.insert(flags.end(), {model, Recordings(), "--id=" + id_, "--out=" + out});
    return RunApp("pushid-predict", flags);
  };
  ASSERT_EQ(predict({"--frames=120"}).exit_code, 0);
  const double once = LastNumber(out, "hip_x_m");
  AppRun run = Succeeded(predict({"--push_scale=1.2"}));
  EXPECT_TRUE(Contains(run.out, "1.2 times the recorded push; no recorded motion to compare"));
  EXPECT_FALSE(Contains(run.out, "hipADE"));
  EXPECT_EQ(ReadCsv(out).size(), 46u);
  EXPECT_TRUE(Contains(predict({"--push_scale=1"}).out, "hipADE"));
  ASSERT_EQ(predict({"--push_scale=1.2", "--frames=120"}).exit_code, 0);
  EXPECT_GT(LastNumber(out, "hip_x_m"), once + 0.02);
  run = predict({"--push_again=40,80:1.5", "--frames=120"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(Contains(run.out, "at frames 0, 40 and 80 (1.5 times); no recorded motion"));
  EXPECT_GT(LastNumber(out, "hip_x_m"), once + 0.1);

  const std::pair<std::vector<std::string>, const char*> bad[] = {
      {{"--push_scale=0"}, "--push_scale is 0; it must be a positive number"},
      {{"--push_again=40,x"}, "--push_again: 'x' is not a frame's number"},
      {{"--push_again=40:x"}, "--push_again: '40:x' is not a frame's number"},
      {{"--push_again=2"}, "--push_again: frame 2 comes before the push before it has ended"},
      {{"--push_again=80"}, "frame 80 is too late for the 45 frames that are predicted"},
      {{"--push_again=40", "--observed=12"}, "--push_again for another push than made it"}};
  for (const auto& [flags, message] : bad) {
    EXPECT_TRUE(Refused(predict(flags), {message}));
  }
}

TEST_F(CrossValidateAppTest, EverySchemeScoresAndCompares) {
  for (const char* scheme : {"stratified", "subject", "strong"}) {
    const std::string out = Path(std::string(scheme) + ".json");
    const AppRun run = RunApp(
        "pushid-crossvalidate",
        {Recordings(), std::string("--scheme=") + scheme, "--folds=2", "--repeats=2",
         "--compare=short: --push_tail=none; linear: --self_force=linear", "--json_out=" + out});
    ASSERT_EQ(run.exit_code, 0) << scheme << ": " << run.err;
    for (const char* part :
         {"tail", "short", "linear", "ridge", "template", "static", "constant velocity"}) {
      EXPECT_TRUE(Contains(run.out, part)) << scheme;
    }
    const nlohmann::ordered_json json = Json(out);
    ASSERT_EQ(json["predictors"].size(), 7u);
    EXPECT_EQ(json["paired_differences"].size(), 6u);
    for (const auto& predictor : json["predictors"]) {
      ExpectScore(predictor["mean"], "mean");
    }
    const size_t folds = std::string(scheme) == "stratified" ? 4
                         : std::string(scheme) == "subject"  ? 2
                                                             : 1;
    EXPECT_EQ(json["predictors"][0]["folds"].size(), folds) << scheme;
    EXPECT_LT(json["predictors"][0]["mean"]["hipADE_m"].get<double>(), 0.1) << scheme;
  }
}

TEST_F(CrossValidateAppTest, RepeatsItself) {
  const std::vector<std::string> arguments = {Recordings(), "--folds=3", "--repeats=1",
                                              "--yardsticks=false"};
  const AppRun first = Succeeded(RunApp("pushid-crossvalidate", arguments));
  EXPECT_EQ(RunApp("pushid-crossvalidate", arguments).out, first.out);
}

}  // namespace
}  // namespace pushid
