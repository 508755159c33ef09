// pushid-fit and pushid-report on synthetic recordings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using FitAppTest = AppTest;
using Words = std::vector<std::string>;

// The report's words; columns may be wider or narrower by a digit.
Words SplitWords(const std::string& text) {
  // How many steps the solver takes is its own business.
  std::istringstream stream(
      std::regex_replace(text, std::regex("after [0-9]+ iterations?"), "after some iterations"));
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// Equal, or numbers (brackets and commas around them aside) that differ by less than 2 %: last
// digits differ between compilers and versions of Ceres.
bool SameWord(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const std::regex number(R"(^(\[?)([-+0-9.e]+)([\],;]*)$)");
  std::smatch of_a, of_b;
  if (!std::regex_match(a, of_a, number) || !std::regex_match(b, of_b, number)) return false;
  if (of_a[1] != of_b[1] || of_a[3] != of_b[3]) return false;
  const double x = std::atof(of_a[2].str().c_str()), y = std::atof(of_b[2].str().c_str());
  return std::abs(x - y) <= 0.02 * std::max(std::abs(x), std::abs(y));
}

TEST_F(FitAppTest, ModelHasItsParts) {
  const nlohmann::ordered_json model = Json(FitModel());
  for (const char* key :
       {"format", "format_version", "version", "model", "parameters", "derived", "values",
        "behaviour", "uncertainty", "warnings", "fit", "table", "data", "configuration", "run"}) {
    EXPECT_TRUE(model.contains(key)) << key;
  }
  ASSERT_FALSE(model["parameters"].empty());
  for (const char* key : {"name", "unit", "value", "standard_error", "interval_95",
                          "standard_error_naive", "status"}) {
    EXPECT_TRUE(model["parameters"][0].contains(key)) << key << "\n" << model["parameters"][0];
  }
  EXPECT_EQ(model["data"]["recordings"].size(), 12u);
  EXPECT_FALSE(model["data"]["manifest_hash"].get<std::string>().empty());
  EXPECT_TRUE(model["fit"]["converged"]);
  EXPECT_EQ(model["configuration"]["seed"], "1");
  EXPECT_FALSE(Contains(model.dump(), "nan"));
}

TEST_F(FitAppTest, FindsTheParametersTheRecordingsWereMadeWith) {
  const nlohmann::ordered_json values = Json(FitModel())["values"];
  const nlohmann::ordered_json truth = Json(manifest_)["synthetic"]["truth"];
  for (const char* name : {"Kp_theta", "a_x", "tail_gain", "tail_time"}) {
    EXPECT_NEAR(values[name].get<double>() / truth[name].get<double>(), 1.0, 0.25) << name;
  }
}

TEST_F(FitAppTest, TwoRunsWriteTheSameModel) {
  nlohmann::ordered_json first = Json(FitModel("first.json"));
  nlohmann::ordered_json second = Json(FitModel("second.json"));
  EXPECT_NE(first["run"], second["run"]);
  first.erase("run");
  second.erase("run");
  EXPECT_EQ(first.dump(), second.dump());
}

TEST_F(FitAppTest, MoreThreadsFindTheSame) {
  const nlohmann::ordered_json one = Json(FitModel("one.json"))["values"];
  const nlohmann::ordered_json two = Json(FitModel("two.json", {"--num_threads=2"}))["values"];
  for (const auto& [name, value] : one.items()) {
    EXPECT_NEAR(two[name].get<double>(), value.get<double>(), 1e-9 * std::abs(value.get<double>()))
        << name;
  }
}

TEST_F(FitAppTest, ReportPrintsWhatTheFitPrinted) {
  const std::string model = FitModel();
  EXPECT_EQ(RunApp("pushid-report", {"--model=" + model, "--details"}).out, fit_.out);
  const AppRun fit = Succeeded(RunApp("pushid-fit", {Recordings(), "--model_out=" + model}));
  EXPECT_EQ(RunApp("pushid-report", {"--model=" + model}).out, fit.out);
  EXPECT_LE(std::count(fit.out.begin(), fit.out.end(), '\n'), 24) << fit.out;
  for (const char* part : {"\nparameter ", "\nmu ", "Ankle stiffness ", "\nnext: ", "--details"}) {
    EXPECT_TRUE(Contains(fit.out, part)) << fit.out;
  }
  EXPECT_FALSE(Contains(fit.out, "fixed")) << fit.out;
}

TEST_F(FitAppTest, ReportStaysAsItWasAgreed) {
  FitModel("m.json", {"--preset_priors=false", "--settling_weight=0", "--details"});
  std::string report = std::regex_replace(fit_.out, std::regex(R"( \\\n +)"), " ");
  // Advice names the recordings and the model where they are.
  report =
      std::regex_replace(report, std::regex(R"(--recordings=\S+)"), "--recordings=M/manifest.json");
  report = std::regex_replace(report, std::regex(R"(--model=\S+)"), "--model=model.json");
  const std::string golden = std::string(PUSHID_SOURCE_DIR) + "/tests/apps/golden/fit_report.txt";
  if (std::getenv("PUSHID_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(golden, std::ios::binary) << report;
    GTEST_SKIP() << golden << " written";
  }
  const Words is = SplitWords(report), was = SplitWords(ReadText(golden));
  for (size_t i = 0; i < std::min(is.size(), was.size()); ++i) {
    ASSERT_TRUE(SameWord(is[i], was[i]))
        << "'" << is[i] << "' where the agreed report has '" << was[i]
        << "'; if that is meant, run this test once with PUSHID_UPDATE_GOLDEN=1\n"
        << report;
  }
  EXPECT_EQ(is.size(), was.size()) << report;
}

// Words of a command line as a shell splits them, without quotes inside words.
Words ShellWords(const std::string& line) {
  Words words;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) {
    word.erase(std::remove(word.begin(), word.end(), '\''), word.end());
    words.push_back(word);
  }
  return words;
}

TEST_F(FitAppTest, AdviceRepeatsTheVeryFit) {
  const std::string first = FitModel(
      "first.json", {"--preset=group", "--interaction=none", "--pool=mu,a_x", "--pool_by=subject",
                     "--posture=upright", "--gain_scaling=mass", "--preset_priors=false",
                     "--prior=a_x:-11:3", "--settling_weight=3", "--fix=c_q,d_q=0.1",
                     "--marker_noise=0.002", "--seed=3", "--leave_out=" + id_});
  const std::string out = std::regex_replace(fit_.out, std::regex(R"( \\\n +)"), " ");
  const size_t begin = out.find("\n  pushid-fit ", out.find("alone changes"));
  ASSERT_NE(begin, std::string::npos) << out;
  Words again = ShellWords(out.substr(begin, out.find('\n', begin + 1) - begin));
  again.erase(again.begin());
  again.push_back("--leave_out=" + id_);  // the flag that the advice changed
  again.push_back("--model_out=" + Path("second.json"));
  Succeeded(RunApp("pushid-fit", again));
  nlohmann::ordered_json a = Json(first), b = Json(Path("second.json"));
  EXPECT_EQ(a["configuration"]["leave_out"], id_);
  a.erase("run");
  b.erase("run");
  EXPECT_EQ(a.dump(1), b.dump(1));
}

// Warnings about the files belong to the result: stderr is not kept.
TEST_F(FitAppTest, WarningsAboutFilesStayWithTheResult) {
  const std::string recordings =
      ChangedManifest([](nlohmann::ordered_json& json) { json["recordings"][0]["fps"] = 61; });
  const AppRun run =
      Succeeded(RunApp("pushid-fit", {recordings, "--model_out=" + Path("m.json"), "--details"}));
  const std::string bvh = Json(manifest_)["recordings"][0]["bvh"][0];
  const std::string says = "recording '" + id_ + "': " + bvh + " has a frame time of 0.0166667 s";
  EXPECT_TRUE(Contains(run.err, says)) << run.err;
  EXPECT_TRUE(Contains(OneLine(run.out), "Warning: " + says)) << run.out;
  EXPECT_TRUE(Contains(Json(Path("m.json"))["warnings"].dump(), says));
  const AppRun report = RunApp("pushid-report", {"--model=" + Path("m.json")});
  EXPECT_TRUE(Contains(OneLine(report.out), "warning: " + says));
}

TEST_F(FitAppTest, WhatIsLeftOutIsNotRead) {
  const std::string recordings = ChangedManifest(
      [](nlohmann::ordered_json& json) { json["recordings"][0]["bvh"][0] = "lost.bvh"; });
  EXPECT_EQ(RunApp("pushid-fit", {recordings}).exit_code, 1);
  Succeeded(RunApp("pushid-fit", {recordings, "--leave_out=" + id_}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {recordings, "--leave_out=nobody"}), {"'nobody'"}));
}

TEST_F(FitAppTest, AReplicaSaysSo) {
  EXPECT_TRUE(Contains(RunApp("pushid-fit", {Recordings(), "--replica=60", "--details"}).out,
                       "drawn with replacement, as replica 60 of a bootstrap"));
  // A value that is no frame rate.
  EXPECT_EQ(RunApp("pushid-fit", {Recordings(), "--resample=60"}).exit_code, 1);
}

TEST_F(FitAppTest, TheHeaderNamesPooling) {
  FitModel("m.json", {"--pool=mu", "--pool_by=subject"});
  EXPECT_TRUE(Contains(fit_.out, "pooled by subject"));
  EXPECT_TRUE(Contains(fit_.out, "spread between subjects"));
  // All of them stand in one setting.
  FitModel("m.json", {"--pool=mu", "--pool_by=setting"});
  EXPECT_FALSE(Contains(fit_.out, "pooled by"));
  EXPECT_TRUE(Contains(fit_.err, "--pool=mu does nothing: all recordings share one setting"));
}

TEST_F(FitAppTest, AnyLabelOfTheManifestMayPool) {
  const std::string shod = ChangedManifest([](nlohmann::ordered_json& json) {
    int i = 0;
    for (auto& r : json["recordings"]) {
      r["shoes"] = ++i % 2 == 0 ? "bare" : "trainers";
      r.erase("magnitude");  // nor does a recording need one
    }
  });
  const AppRun fit =
      Succeeded(RunApp("pushid-fit", {shod, "--pool=mu", "--pool_by=shoes", "--details"}));
  EXPECT_TRUE(Contains(fit.out, "pooled by shoes"));
  EXPECT_TRUE(Contains(fit.out, "trainers"));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {shod, "--pool=mu", "--pool_by=shoe"}),
                      {"--pool_by is 'shoe'", "no recording has", "shoes"}));
}

TEST_F(FitAppTest, OnlyTheRecordingsAskedForAreFitted) {
  const nlohmann::ordered_json model = Json(FitModel("m.json", {"--ids=" + id_}));
  ASSERT_EQ(model["data"]["recordings"].size(), 1u);
  EXPECT_EQ(model["data"]["recordings"][0]["id"], id_);
  EXPECT_TRUE(Contains(fit_.out, "a single recording"));
}

TEST_F(FitAppTest, GainsThatCannotBeToldApartAreNamed) {
  FitModel("m.json", {"--free=mu,Kp_x,Kp_y", "--preset_priors=false", "--settling_weight=0"});
  EXPECT_TRUE(Contains(fit_.out, "unidentifiable"));
  EXPECT_TRUE(Contains(OneLine(fit_.out), "mu, Kp_x and Kp_y cannot be separated"));
}

TEST_F(FitAppTest, ThePlainPresetFitsToo) {
  const nlohmann::ordered_json model = Json(FitModel("m.json", {"--preset=ldp"}));
  EXPECT_EQ(model["model"]["preset"], "ldp");
  EXPECT_FALSE(Contains(fit_.out, "mu_y"));
  EXPECT_TRUE(Contains(fit_.out, "In LDP's units, per frame of 1/60 s: Kd_theta "));
}

}  // namespace
}  // namespace pushid
