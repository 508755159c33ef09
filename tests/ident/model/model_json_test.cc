// A result is its JSON: nothing is lost, damage is named, the same seed gives the same bytes.
#include "ident/model/model_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/files/json_file.h"
#include "ident/fit/fit.h"
#include "ident/report/page/build_report.h"
#include "ident/report/report_text.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

FittedModel SampleModel(const TableEdits& edits = {}, int num_threads = 1) {
  const SyntheticOptions study = TinyStudy();
  FitOptions options = DefaultFit(study);
  options.num_threads = num_threads;
  EXPECT_FALSE(EditTable(edits, &options.table));
  FittedModel model;
  model.fit = Fit(MakePendulums(study), options);
  model.provenance = {"0.1.0", {{"seed", "1"}, {"preset", "tail"}}, {"preset"}, "m.json", "abc",
                      "single"};
  return model;
}

const RunInfo kRun = {"2024-01-01", "here", "model.json", 1.5, 1};

Json RoundTrip(const Json& json) {
  return ToJson(Unwrapped(FittedModelFromJson(json, "model.json")), kRun);
}

TEST(ResultJson, RoundTripIsExact) {
  // Plain; with null directions (infinite errors); with pooled subjects.
  for (const TableEdits& edits : {TableEdits{}, TableEdits{"", "Kp_x,Kp_y", "", "", ""},
                                  TableEdits{"", "", "", "", "mu,Kp_theta"}}) {
    const Json json = ToJson(SampleModel(edits), kRun);
    EXPECT_EQ(RoundTrip(json).dump(), json.dump());
    // Through text too, as a file has it.
    EXPECT_EQ(RoundTrip(Json::parse(json.dump())).dump(), json.dump());
  }
}

// Numbers that do not end in binary, an open side, a bootstrap and every diagnostic.
FittedModel JudgedModel() {
  FittedModel model = SampleModel();
  const double infinity = std::numeric_limits<double>::infinity();
  model.profiles = {{"mu",
                     "N s/m",
                     20.1,
                     ProfileClass::kPracticallyNot,
                     ProfileClass::kStructurallyNot,
                     -infinity,
                     30.7,
                     1.1,
                     0.3,
                     "bound",
                     "threshold",
                     {{10.0 / 3.0, 1.3, {{"a_x", -0.1}}}, {20.1, 1.1, {{"a_x", -0.2}}}}}};
  model.bootstrap = Bootstrap{2, 7, 1, {"mu"}, {"N s/m"}, {{0.1}, {0.7}}, {0.3}, {0.1}, {0.7}};
  model.bootstrap->drawn_by = ClusterBy::kSubject;
  model.bootstrap->drawn_from = 4;
  model.bootstrap->people_shared = true;
  Diagnostics& d = model.fit.diagnostics;
  d.start = {infinity, {}, {"t_v"}, {"mu moved off its bound"}, {}};
  d.start.findings = {{FindingKind::kMass, "one", "s1", 85000.0}};
  d.start.null_directions.push_back({{"mu", "Kp_x"}, {1.0, -1.0}, {}, "cannot be separated"});
  d.recordings = {{"one", 97.3, true, 0.2, 0.9, 31.7, 1e-7, {{3, 0, 2.3, 0.1}}}};
  d.whiteness = {{"hip x", {0.9, 0.8}, {0.1, 0.1}, {0.2}, {0.3}, 0.2, 0.04, 99.1, 0.0}};
  d.leverage = {{"one"}, {"mu"}, {"N s/m"}, {{-0.7}}, {{0.1}}};
  d.trace = {{8, 0, 5.3, 1.7}, {0, 1, 1.1, 1e-9}};
  model.advice = {{"free less", "pushid-fit --fix=mu"}};
  return model;
}

TEST(ResultJson, ConfidenceRoundTripIsExact) {
  const Json json = ToJson(JudgedModel(), kRun);
  for (const char* key : {"profiles", "bootstrap", "diagnostics"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(RoundTrip(Json::parse(json.dump())).dump(), json.dump());
  EXPECT_EQ(json["profiles"][0]["interval_95"][0], "-infinity");
  EXPECT_EQ(json["profiles"][0]["class"], "practically_not");
}

TEST(ResultJson, InfinitiesStayInfinite) {
  // Freed alone, Kp_x is told from mu by what little people move sideways.
  const FittedModel model = SampleModel({"", "Kp_x,Kp_y", "", "", ""});
  const Json json = ToJson(model, kRun);
  EXPECT_TRUE(Contains(json.dump(), "\"infinity\""));
  EXPECT_FALSE(Contains(json.dump(), "null,"));
  const FittedModel read = FittedModelFromJson(json, "").value();
  const Estimate& e = *FindEstimate(read.fit.estimates, "Kp_x");
  EXPECT_EQ(e.status, EstimateStatus::kUnidentifiable);
  EXPECT_EQ(e.standard_error, std::numeric_limits<double>::infinity());
  EXPECT_EQ(e.lower95, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(DetailsText(read), DetailsText(model));
}

// Five recordings that the data of two parameters run away on: what is derived has no bounds then,
// and a constant error has no autocorrelation. A null in their places is a model that cannot be
// read.
TEST(ResultJson, NumbersThatAreNoneComeBack) {
  FittedModel model = JudgedModel();
  FitResult& result = model.fit;
  const double infinity = std::numeric_limits<double>::infinity(), none = std::nan("");
  result.derived = {{"c_x", "N s/m", -infinity, infinity, -infinity, infinity}};
  result.estimates[0].value = infinity;
  model.profiles[0].points[0] = {infinity, infinity, {{"a_x", none}}};
  model.profiles[0].estimate = model.profiles[0].cost = infinity;
  Diagnostics& d = result.diagnostics;
  d.start.null_directions[0].coefficients[0] = none;
  d.start.null_directions[0].identified = result.derived;
  d.recordings = {{"one", none, true, infinity, none, none, none, {{3, 0, infinity, none}}}};
  d.whiteness = {{"hip x", {none}, {none}, {none}, {none}, infinity, infinity, none, none}};
  d.trace[0] = {8, 0, infinity, none};
  result.uncertainty.sigma = result.uncertainty.settling.free_seconds = infinity;
  result.behaviour.fastest_growth = none;
  SettlingSimulation& fallen = result.behaviour.simulations.front();
  fallen.speed = fallen.lean = fallen.distance = fallen.advance = fallen.pushed_advance = infinity;
  result.cost = result.recordings[0].cost = infinity;
  SolveStart& start = result.starts.front();
  start.cost = start.stages.front().initial_cost = start.stages.front().final_cost = infinity;
  start.from.shared = start.to.shared = {infinity, none};
  const Json json = ToJson(model, kRun);
  EXPECT_FALSE(Contains(json.dump(), "null,") || Contains(json.dump(), "null]") ||
               Contains(json.dump(), "null}"));
  EXPECT_EQ(RoundTrip(Json::parse(json.dump())).dump(), json.dump());
}

TEST(ResultJson, PredictionsNeedTheJsonAlone) {
  const FittedModel model = SampleModel({"", "", "", "", "mu"});
  const FittedModel read = FittedModelFromJson(ToJson(model, kRun), "").value();
  const IdentifiedModel a = ModelOf(model.fit), b = ModelOf(read.fit);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.by_unit, b.by_unit);
  EXPECT_EQ(a.by_unit.size(), 2u);
}

// Reports say once what several recordings share: files keep which they are, beside the sentences.
TEST(ResultJson, WarningsKeepTheirRecordings) {
  FittedModel model = SampleModel();
  model.fit.warnings = {Warning("mu is at its bound")};
  EXPECT_FALSE(ToJson(model, kRun).contains("warnings_of_recordings"));
  for (const char* id : {"a", "b"}) {
    const std::string what = "the mass is 7; is mass_kg in kg?";
    model.fit.warnings.emplace_back(std::string("recording ") + id + ": " + what, id, what);
  }
  const Json json = ToJson(model, kRun);
  EXPECT_EQ(json["warnings"][2], "recording b: the mass is 7; is mass_kg in kg?");
  EXPECT_EQ(json["warnings_of_recordings"][1]["recording"], "b");
  const FittedModel read = Unwrapped(FittedModelFromJson(json, "some.json"));
  const std::vector<std::string> once = {
      "mu is at its bound", "in 2 recordings (a, b): the mass is 7; is mass_kg in kg?"};
  EXPECT_EQ(GroupedWarnings(read.fit.warnings), once);
  Json damaged = json;
  damaged["warnings_of_recordings"][1]["warning"] = 3;
  EXPECT_FALSE(FittedModelFromJson(damaged, "some.json").ok());
}

TEST(ResultJson, SameSeedSameBytes) {
  Json a = ToJson(SampleModel(), kRun), b = ToJson(SampleModel(), kRun);
  a.erase("run");
  b.erase("run");
  EXPECT_EQ(a.dump(), b.dump());
}

// Evaluations run ahead over threads, and Ceres adds up in one order: not a bit differs.
TEST(ResultJson, ThreadsDoNotMatter) {
  Json one = ToJson(SampleModel({}, 1), kRun), two = ToJson(SampleModel({}, 2), kRun);
  one.erase("run");  // how long it took
  two.erase("run");
  EXPECT_EQ(one.dump(), two.dump());
}

TEST(ResultJson, DamageIsNamed) {
  const Json good = ToJson(SampleModel(), kRun);
  const auto message = [](const Json& json) {
    const Result<FittedModel> read = FittedModelFromJson(json, "some.json");
    EXPECT_FALSE(read.ok());
    return read.ok() ? std::string() : read.error().ToString();
  };
  EXPECT_TRUE(Contains(message(Json::array()), "some.json: this is not a pushid model"));
  EXPECT_TRUE(Contains(message({{"recordings", 3}}), "this is not a pushid model"));
  EXPECT_TRUE(Contains(message({{"format", 7}}), "this is not a pushid model"));
  EXPECT_TRUE(
      Contains(message({{"schema", "pushid-manifest/1"}}), "its schema is pushid-manifest/1"));
  Json json = good;
  json["format_version"] = 99;
  EXPECT_TRUE(Contains(message(json), "newer pushid"));
  json = good;
  json["schema"] = "pushid-model/2";
  EXPECT_TRUE(Contains(message(json), "newer pushid"));
  // A value that was changed by hand in one of its two places.
  for (const char* name : {"mu", "Kp_theta", "Kd_theta", "tail_time", "tail_gain"}) {
    json = good;
    json["values"][name] = 1.01 * json["values"][name].get<double>();
    EXPECT_TRUE(Contains(message(json), std::string("at 'parameters/") + name + "': " + name));
    json = good;
    for (Json& row : json["parameters"]) {
      if (row["name"] == name) row["value"] = 300.0;
    }
    EXPECT_TRUE(Contains(message(json), std::string(name) + " is 300 here and "));
    json["values"][name] = 300.00001;
    EXPECT_TRUE(FittedModelFromJson(json, "some.json").ok()) << name;
  }
  json = good;
  json.erase("values");
  EXPECT_TRUE(Contains(message(json), "values"));
  // One of another version, with the way to convert it.
  EXPECT_TRUE(Contains(message(json), "pushid 0.1.0 wrote it"));
  EXPECT_TRUE(Contains(message(json), "run pushid-fit on the manifest under 'run'"));
  json = good;
  json["model"]["posture"] = "sitting";
  EXPECT_TRUE(Contains(message(json), "posture is 'sitting'"));
  json = good;
  json["table"][0]["name"] = "nu";
  EXPECT_TRUE(Contains(message(json), "unknown parameter 'nu'"));
  json = good;
  json["fit"]["cost"] = "cheap";
  EXPECT_TRUE(Contains(message(json), "some.json: incomplete or damaged model"));
  json = good;
  json["uncertainty"]["covariance_fitted_scale"][1] = Json::array({1.0});
  EXPECT_TRUE(Contains(message(json), "damaged"));
  // A contradiction between parts of the file is reported at an entry, not at the part that was
  // read last.
  json = good;
  json["fit"]["best_start"] = 7;
  EXPECT_TRUE(Contains(message(json), "at 'fit/best_start'"));
  json = good;
  json["values"]["tail_time"] = 0.0;
  EXPECT_TRUE(Contains(message(json), "at 'values/tail_time'"));
  json = good;
  json["uncertainty"]["correlation"].erase(0);
  EXPECT_TRUE(Contains(message(json), "at 'uncertainty/correlation'"));
  json = good;
  json["subjects"].front()["pooled"]["nu"] = json["parameters"][0];
  EXPECT_TRUE(Contains(message(json), "/pooled/nu': subject"));
  json = good;
  json["values"].erase("mu");
  EXPECT_TRUE(Contains(message(json), "at 'values/mu'"));
  // Any entry of the top gone is an error, never a crash.
  for (const auto& [key, value] : good.items()) {
    static const std::set<std::string> kNotOfAll = {"schema", "push_range", "feet", "forecasts"};
    if (kNotOfAll.count(key) > 0) continue;
    json = good;
    json.erase(key);
    EXPECT_FALSE(message(json).empty()) << key;
  }
}

// Models of other versions lack entries, or name parameters that there are not.
TEST(ResultJson, AModelOfAnotherVersionIsToBeFittedAgain) {
  Json other = ToJson(SampleModel(), kRun);
  other["version"] = "0.2.0";
  other["table"].push_back({{"name", "drive_gain"}, {"nominal", 0.5}});
  const std::string unknown = ProblemOf(FittedModelFromJson(other, "some.json"));
  EXPECT_TRUE(Contains(unknown, "'drive_gain'"));
  EXPECT_TRUE(Contains(unknown, "run pushid-fit on the manifest"));
  other["table"].erase(other["table"].size() - 1);
  other["model"].erase("directions");
  EXPECT_TRUE(Contains(ProblemOf(FittedModelFromJson(other, "some.json")), "0.2.0 wrote it"));
}

using ResultFile = TempDirTest;

TEST_F(ResultFile, ReadsWhatWasWritten) {
  const Json json = ToJson(SampleModel(), kRun);
  ASSERT_FALSE(WriteJson(Path("model.json"), json));
  const FittedModel read = Unwrapped(ReadFittedModel(Path("model.json")));
  EXPECT_EQ(ToJson(read, kRun).dump(), json.dump());
}

TEST_F(ResultFile, BadFilesAreNamed) {
  const std::string cut = WriteText("cut.json", "{\"format\": \"pushid model\",\n \"values\": {");
  EXPECT_TRUE(Contains(ProblemOf(ReadFittedModel(cut)), "cut.json:2"));
  EXPECT_TRUE(Contains(ProblemOf(ReadFittedModel(Path("missing.json"))), "missing.json"));
}

// A damaged verdict that moves more estimates than there are.
TEST(ResultJson, AVerdictOfMoreEstimatesIsShown) {
  FitResult result;
  result.verdict.not_checked.clear();
  result.verdict.assumptions = {{"masses", "", 0.03, 0.1, 0.05, 1.7, 0.1, {0.3, 0.4}}};
  EXPECT_TRUE(Contains(AssumptionTable(result).ToString(), "masses"));
}

}  // namespace
}  // namespace pushid
