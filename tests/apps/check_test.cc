// pushid-check: the checks of a model's file; what it refuses.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

class CheckTest : public AppTest {
 protected:
  AppRun Check(const std::string& model, const std::vector<std::string>& flags) {
    return RunApp("pushid-check", With({"--model=" + model, Recordings()}, flags));
  }
};

// A model from its file has lost nothing that a refit starts from: whatever it is made of.
TEST_F(CheckTest, ChecksOfEveryKindOfModelAreAdded) {
  // Horizons take seconds, and every refit of a network or of feet that step one: not all are
  // checked by all.
  const std::vector<std::string> most = {"--profile=mu", "--bootstrap=9",
                                         "--bootstrap_by=recording", "--horizon_check"};
  const std::vector<std::string> few = {"--bootstrap=3", "--bootstrap_by=recording"};
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> cases = {
      {{"--pool=mu", "--pool_by=subject", "--seed=3"}, most},
      {{"--self_force=linear,mlp:2"}, few},
      {{"--stance=steps"}, few},
      {{"--replica=2"}, few}};
  for (const auto& [fit, checks] : cases) {
    SCOPED_TRACE(fit[0]);
    const std::string model = FitModel("model.json", fit);
    const nlohmann::ordered_json plain = Json(model);
    const AppRun run = Succeeded(Check(model, checks));
    EXPECT_TRUE(Contains(run.out, model)) << "where the checks are";
    const nlohmann::ordered_json checked = Json(model);
    EXPECT_EQ(checked["values"].dump(), plain["values"].dump());
    EXPECT_TRUE(checked.contains("bootstrap"));
    EXPECT_EQ(checked.contains("profiles"), checks.size() == most.size());
  }
}

TEST_F(CheckTest, TheModelStaysWhereAnotherIsNamedOrNothingIsAdded) {
  const std::string model = FitModel();
  const std::string before = ReadText(model);
  Succeeded(Check(model, {"--profile=mu", "--model_out=" + Path("checked.json")}));
  EXPECT_TRUE(Json(Path("checked.json")).contains("profiles"));
  const AppRun printed = Succeeded(Check(model, {"--design=mu"}));
  EXPECT_TRUE(Contains(printed.out, "error of mu"));
  EXPECT_FALSE(Contains(printed.out, "--design=")) << "advised where it was done";
  EXPECT_EQ(ReadText(model), before);
  // Checks add up.
  ASSERT_EQ(Check(model, {"--profile=mu", "--model_out=" + model}).exit_code, 0);
  ASSERT_EQ(Check(model, {"--bootstrap=3"}).exit_code, 0);
  EXPECT_TRUE(Json(model).contains("profiles"));
  EXPECT_TRUE(Json(model).contains("bootstrap"));
}

TEST_F(CheckTest, FilesAreReadAsTheFitReadThem) {
  const std::string model = FitModel("model.json", {"--resample_fps=30", "--lowpass_hz=8"});
  EXPECT_EQ(Check(model, {"--profile=mu"}).exit_code, 0);
  EXPECT_TRUE(Refused(Check(model, {"--profile=mu", "--lowpass_hz=5"}),
                      {"recording " + id_, "is not what the model was fitted to"}));
  const std::string in_mm = FitModel("mm.json", {"--length_unit=mm", "--length_scale=0"});
  EXPECT_EQ(Check(in_mm, {"--profile=mu"}).exit_code, 0) << "a scale was not given";
  EXPECT_EQ(Check(in_mm, {"--profile=mu", "--length_scale=0.001"}).exit_code, 0);
}

// A command that is copied must not meet another model.
TEST_F(CheckTest, AdviceNamesTheFileOfTheModel) {
  const std::string model = FitModel("my model.json"), moved = Path("moved.json");
  const auto asks = [this](const std::string& file) {
    return "pushid-check --model=" + file + " --recordings=" + manifest_ + " ";
  };
  EXPECT_TRUE(Contains(OneLine(fit_.out), asks("'" + model + "'")));
  EXPECT_FALSE(Contains(fit_.out, "FILE"));
  const AppRun run = Check(model, {"--profile=mu", "--model_out=" + moved, "--details"});
  EXPECT_TRUE(Contains(OneLine(run.out), asks(moved)));
  std::filesystem::rename(moved, Path("again.json"));
  const AppRun report = RunApp("pushid-report", {"--model=" + Path("again.json"), "--details"});
  EXPECT_TRUE(Contains(OneLine(report.out), asks(Path("again.json"))));
  const AppRun unkept = RunApp("pushid-fit", {Recordings(), "--details"});
  EXPECT_TRUE(Contains(OneLine(unkept.out), asks("FILE")));
  EXPECT_TRUE(
      Contains(unkept.out, "FILE is the model, which --model_out=FILE of pushid-fit keeps."));
}

TEST_F(CheckTest, OtherRecordingsThanThoseOfTheFitAreNamed) {
  const std::string model = FitModel("model.json", {"--leave_out=" + id_});
  EXPECT_EQ(Check(model, {"--profile=mu"}).exit_code, 0) << "those of the model, by id";
  EXPECT_TRUE(Refused(Check(model, {"--profile=mu", "--setting=single"}),
                      {"recording " + id_ + " is none of those", "leave --setting and --ids"}));
  const std::string whole = FitModel("whole.json");
  EXPECT_TRUE(Refused(Check(whole, {"--profile=mu", "--leave_out=" + id_}),
                      {"recording " + id_ + " is missing", "--leave_out"}));
  const std::string heavier = ChangedManifest(
      [](nlohmann::ordered_json& json) { json["recordings"][0]["subjects"][0]["mass_kg"] = 90.5; });
  EXPECT_TRUE(Refused(RunApp("pushid-check", {"--model=" + whole, heavier, "--profile=mu"}),
                      {"recording " + id_ + " is not what the model was fitted to", "manifest"}));
  const std::string fewer =
      ChangedManifest([](nlohmann::ordered_json& json) { json["recordings"].erase(0); });
  EXPECT_TRUE(Refused(RunApp("pushid-check", {"--model=" + whole, fewer, "--profile=mu"}),
                      {id_, "give the manifest of the fit", "--ids"}));
  EXPECT_TRUE(Refused(RunApp("pushid-report", {"--model=" + whole, fewer, "--details"}),
                      {id_, "give the manifest of the fit", "--ids"}));
}

TEST_F(CheckTest, WhatItRefuses) {
  const std::string model = FitModel();
  EXPECT_TRUE(Refused(RunApp("pushid-check", {Recordings(), "--profile=mu"}), {"--model"}));
  EXPECT_TRUE(Refused(RunApp("pushid-check", {"--model=" + model, "--profile=mu"}),
                      {"--recordings is missing"}));
  EXPECT_TRUE(Refused(Check(model, {}), {"nothing is asked", "--profile", "--bootstrap"}));
  EXPECT_TRUE(Refused(Check(model, {"--bootstrap=1"}), {"--bootstrap must be 0"}));
  EXPECT_TRUE(Refused(Check(model, {"--profile=mew"}), {"--profile", "mew"}));
  EXPECT_TRUE(Refused(Check(model, {"--design=mew"}), {"--design: 'mew'", "choose from all"}));
  EXPECT_TRUE(Refused(Check(model, {"--profile=mu", "--seed=-1"}), {"--seed", "-1"}));
  EXPECT_TRUE(Refused(Check(model, {"--profile=mu", "--preset=ldp"}), {"no flag --preset"}));
}

}  // namespace
}  // namespace pushid
