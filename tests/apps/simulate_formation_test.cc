// pushid-formation: from a model to tables, CSV, BVH and pictures; what it refuses.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

class SimulateFormationTest : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    alone_ = FitModel("alone.json");
    // The synthetic people of the fixture stand alone: give their model a contact by hand.
    nlohmann::ordered_json json = Json(alone_);
    json["model"]["interaction"] = "contact";
    json["values"]["contact_stiffness"] = 2800.0;
    json["values"]["contact_distance"] = 0.42;
    json["values"]["contact_kappa"] = 0.58;
    json["values"]["contact_damping"] = 270.0;
    json["values"]["contact_height"] = 0.5;
    model_ = "--model=" + WriteText("touching.json", json.dump(1));
  }

  AppRun Simulate(const std::vector<std::string>& flags) {
    return RunApp("pushid-formation", With({model_}, flags), 60);
  }

  std::string alone_;  // path
  std::string model_;  // flag
};

// The onsets of the table on stdout, "-" for none: the lines between its header and the legend.
std::vector<std::string> Onsets(const std::string& out) {
  std::istringstream lines(out.substr(out.find("person   x")));
  std::vector<std::string> onsets;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.find("outcome: ") == std::string::npos) {
    std::istringstream words(line);
    std::string person, x, y, onset;
    words >> person >> x >> y >> onset;
    onsets.push_back(onset);
  }
  return onsets;
}

// The group model that comes with the programs says what it was fitted to; what its intervals leave
// out stands beside them.
TEST_F(SimulateFormationTest, TheShippedModelIsOfSyntheticPeople) {
  const AppRun run =
      Succeeded(RunApp("pushid-formation",
                       {"--model=pushid:synthetic_group", "--formation=line", "--set=mu=60",
                        "--people=4", "--spacing=0.42", "--out=" + Path("line.txt")},
                       60));
  EXPECT_TRUE(Contains(run.err, "was fitted to synthetic people"));
  EXPECT_TRUE(Contains(run.out, "not in these intervals: "));
  EXPECT_TRUE(Contains(run.out, "contact_height = 0.5"));
  EXPECT_TRUE(Contains(run.out, "mu = 60 (--set)"));
  const AppRun wave = Succeeded(RunApp("pushid-inspect", {"--wave", Path("line.txt")}));
  EXPECT_TRUE(Contains(wave.out, "speed of the onset: "));
  EXPECT_TRUE(Refused(RunApp("pushid-formation", {"--model=pushid:none", "--formation=line"}),
                      {"pushid:none", "pushid:synthetic_group"}));
}

TEST_F(SimulateFormationTest, ALineMovesOneAfterAnotherAndEverythingIsWritten) {
  const AppRun run =
      Succeeded(Simulate({"--formation=line", "--people=4", "--spacing=0.42", "--duration=3",
                          "--push=12", "--csv_out=" + Path("line.csv"), "--bvh_out=" + Path("line"),
                          "--svg_out=" + Path("wave.svg")}));
  EXPECT_EQ(run.err, "");
  const std::vector<std::string> onsets = Onsets(run.out);
  ASSERT_EQ(onsets.size(), 4u) << run.out;
  for (int n = 1; n < 4; ++n) EXPECT_GT(std::stod(onsets[n]), std::stod(onsets[n - 1])) << run.out;
  EXPECT_TRUE(Contains(run.out, "4 of 4 people moved by 2 cm or more; from person 0 to 3"));
  EXPECT_TRUE(Contains(run.out, "outcome: judged 2 s after the last push, or after the onset"));
  EXPECT_TRUE(Contains(ReadText(Path("wave.svg")), "uncertainty of the parameters"));

  const std::string csv = ReadText(Path("line.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4 * 181);
  EXPECT_TRUE(Contains(csv, ",interaction_x_N,"));
  const std::string text = ReadText(Path("wave.svg"));
  EXPECT_EQ(text.find("<svg"), 0u);
  EXPECT_TRUE(Contains(text, "4 people in a line, 0.42 m apart; 12 N s at 0 s on person 0"));
  EXPECT_EQ(text.substr(text.size() - 7), "</svg>\n");
  // The written motion is a recording that the model predicts exactly.
  const AppRun scores =
      Succeeded(RunApp("pushid-evaluate", {model_, "--recordings=" + Path("line/manifest.json"),
                                           "--json_out=" + Path("scores.json")}));
  EXPECT_TRUE(Refused(RunApp("pushid-report", {model_, "--truth=" + Path("line/manifest.json")}),
                      {"a formation of pushid-formation", "the model"}));
  EXPECT_LT(Json(Path("scores.json"))["mean"]["hipADE_m"].get<double>(), 1e-9) << scores.out;
}

// Displacements are along the push; of feet that step there are foot, times and place.
TEST_F(SimulateFormationTest, APushToTheLeftAndWhatTheFeetDo) {
  nlohmann::ordered_json json = Json(alone_);
  json["model"]["stance"] = "steps";
  const std::string steps = WriteText("steps.json", json.dump(1));
  const auto pushed = [](const std::string& model, const std::string& impulse, int degrees) {
    return RunApp("pushid-formation",
                  {"--model=" + model, "--formation=line", "--people=1", "--push=" + impulse,
                   "--push_duration=0.7", "--direction=" + std::to_string(degrees)});
  };
  const AppRun weak = pushed(steps, "3", 0), hard = pushed(steps, "60", 0);
  const AppRun left = pushed(alone_, "60", 90);
  ASSERT_EQ(weak.exit_code + hard.exit_code + left.exit_code, 0) << weak.err << hard.err;
  EXPECT_TRUE(Contains(weak.out, "p00: stands\n"));
  EXPECT_TRUE(Contains(hard.out, "p00: steps "));
  EXPECT_TRUE(Contains(hard.out, " m forwards"));
  EXPECT_TRUE(Contains(left.out, "60 N s at 0 s on person 0, 90 degrees to the left; "));
  EXPECT_TRUE(Contains(pushed(alone_, "60", -90).out, " on person 0, 90 degrees to the right; "));
  std::istringstream row(left.out.substr(left.out.find("\n     0") + 1));
  std::string person, x, y, onset, peak, displaced;
  row >> person >> x >> y >> onset >> peak >> displaced;
  EXPECT_GT(std::stod(displaced), 0.03) << left.out;
  EXPECT_TRUE(Refused(Simulate({"--formation=line", "--direction=400"}), {"--direction", "360"}));
}

TEST_F(SimulateFormationTest, ThirteenInADiamondThreePushed) {
  const AppRun run = Succeeded(Simulate({"--formation=diamond", "--people=13", "--pushed=0,1,3"}));
  EXPECT_TRUE(Contains(run.out, "13 people in a diamond"));
  EXPECT_EQ(Onsets(run.out).size(), 13u);
  EXPECT_TRUE(Contains(run.out, "no speed: several people are pushed"));
}

// The two people of the fixture in turn, and not the formation's own.
TEST_F(SimulateFormationTest, TenRecordedPeopleInALine) {
  const AppRun run =
      Succeeded(Simulate({"--formation=line", "--people=10", "--recordings=" + manifest_,
                          "--bvh_out=" + Path("line"), "--duration=1"}));
  EXPECT_TRUE(Contains(run.out, "10 recorded people in a line"));
  std::vector<double> masses;
  const nlohmann::ordered_json recorded = Json(manifest_);
  for (const auto& entry : recorded["recordings"]) {
    const double mass = entry["subjects"][0]["mass_kg"];
    if (masses.empty() || masses.back() != mass) masses.push_back(mass);
  }
  ASSERT_EQ(masses.size(), 2u);
  const auto people = Json(Path("line/manifest.json"))["recordings"][0]["subjects"];
  ASSERT_EQ(people.size(), 10u);
  for (int n = 0; n < 10; ++n) EXPECT_EQ(people[n]["mass_kg"], masses[n % 2]) << n;
  EXPECT_TRUE(Refused(Simulate({"--formation=line", "--recordings=" + manifest_, "--mass=70"}),
                      {"--recordings gives", "leave out --mass"}));
  EXPECT_TRUE(
      Refused(Simulate({"--formation=line", "--recordings=" + Path("none.json")}), {"none.json"}));
}

// The fit's people, who stood in its recordings, and pushes as they were there.
TEST_F(SimulateFormationTest, WithoutRecordingsTheFitsPeopleStandThere) {
  const nlohmann::ordered_json range = Json(alone_)["push_range"];
  ASSERT_GE(range["people"].size(), 2u);
  const AppRun run =
      Succeeded(RunApp("pushid-formation", {"--model=" + alone_, "--formation=line", "--people=5",
                                            "--bvh_out=" + Path("fitted")}));
  const auto made = Json(Path("fitted/manifest.json"))["recordings"][0];
  for (int n = 0; n < 5; ++n) {
    EXPECT_EQ(made["subjects"][n]["mass_kg"],
              range["people"][n % range["people"].size()]["mass_kg"]);
  }
  EXPECT_EQ(made["push_kind"], range["usual"]["kind"]);
  EXPECT_TRUE(Contains(run.out, " of the fit in turn, "));
  EXPECT_TRUE(Contains(run.out, "; pushes as the fit's: "));
  const AppRun alike = Succeeded(RunApp(
      "pushid-formation", {"--model=" + alone_, "--formation=line", "--people=2", "--mass=200"}));
  EXPECT_TRUE(Contains(alike.out, "people: upright, 200 kg"));
  EXPECT_TRUE(Contains(alike.err, "the mass of a person of formation is 200 kg"));
}

TEST_F(SimulateFormationTest, WhatTheFitWarnedOfStandsUnderTheTable) {
  nlohmann::ordered_json json = Json(alone_);
  json["warnings"] = {"ends behind the start", "recording 'a': a.bvh has gaps",
                      "recording 'b': b.bvh has gaps"};
  json["warnings_of_recordings"] = {
      {{"warning", 1}, {"recording", "a"}, {"of_many", "the file has gaps"}},
      {{"warning", 2}, {"recording", "b"}, {"of_many", "the file has gaps"}}};
  const AppRun run =
      Succeeded(RunApp("pushid-formation", {"--model=" + WriteText("warned.json", json.dump()),
                                            "--formation=line", "--people=1"}));
  EXPECT_TRUE(Contains(run.out,
                       "\nwarning of the fit: ends behind the start\n"
                       "warning of the fit: in 2 recordings (a, b): the file has gaps\n"));
}

// Parameters that are known so well move no onset, and onsets are whole frames.
TEST_F(SimulateFormationTest, AnIntervalWithoutWidthIsNone) {
  nlohmann::ordered_json json = Json(Path("touching.json"));
  for (auto& row : json["uncertainty"]["covariance_fitted_scale"]) {
    for (auto& entry : row) entry = 1e-14 * entry.get<double>();
  }
  model_ = "--model=" + WriteText("known.json", json.dump(1));
  const AppRun run = Succeeded(Simulate({"--formation=line", "--people=3"}));
  EXPECT_TRUE(Contains(run.out, "parameters: less than a frame of the onsets, from the waves of "));
}

TEST_F(SimulateFormationTest, ThreeSuccessivePushes) {
  const AppRun run = Succeeded(Simulate({"--formation=line", "--people=3", "--push=40, 40@1,56@2.5",
                                         "--fps=120", "--bvh_out=" + Path("three")}));
  EXPECT_TRUE(Contains(run.out, "no speed: there are several pushes"));
  const auto pushes = Json(Path("three/manifest.json"))["recordings"][0]["pushes"];
  ASSERT_EQ(pushes.size(), 3u);
  EXPECT_EQ(pushes[1]["start_frame"], 120);
  EXPECT_EQ(pushes[2]["start_frame"], 300);
  // Its own output may be replaced when told, recordings may not.
  const std::vector<std::string> again = {"--formation=line", "--bvh_out=" + Path("three")};
  EXPECT_TRUE(Refused(Simulate(again), {Path("three/manifest.json"), "--overwrite"}));
  Succeeded(Simulate({again[0], again[1], "--overwrite"}));
  WriteText("real/manifest.json", R"({"recordings": []})");
  EXPECT_TRUE(Refused(Simulate({"--formation=line", "--bvh_out=" + Path("real"), "--overwrite"}),
                      {Path("real/manifest.json"), "--bvh_out"}));
}

TEST_F(SimulateFormationTest, AModelWithoutInteractionIsWarnedAbout) {
  const AppRun run =
      Succeeded(RunApp("pushid-formation", {"--model=" + alone_, "--formation=line"}));
  EXPECT_TRUE(Contains(run.err, "people will not affect each other"));
  EXPECT_TRUE(Contains(run.out, "1 of 4 people moved"));
  const AppRun one = RunApp("pushid-formation",
                            {"--model=" + alone_, "--formation=grid", "--people=1", "--push=12"});
  EXPECT_EQ(one.err, "");
}

TEST_F(SimulateFormationTest, WhoLeavesTheDomainIsNamedAndNothingIsWritten) {
  const AppRun run = Simulate({"--formation=line", "--push=2000", "--csv_out=" + Path("out.csv"),
                               "--bvh_out=" + Path("out"), "--svg_out=" + Path("out.svg")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(Contains(run.err, "of person 0 leaves the model's domain at frame"));
  EXPECT_TRUE(Contains(run.err, "try a weaker or longer push"));
  const AppRun coarse = Simulate({"--formation=line", "--push=2000", "--fps=20"});
  EXPECT_TRUE(Contains(coarse.err, "try --fps=60"));
  for (const char* out : {"out.csv", "out", "out.svg"}) {
    EXPECT_FALSE(std::filesystem::exists(Path(out))) << out;
  }
}

TEST_F(SimulateFormationTest, BadUsage) {
  const struct {
    std::vector<std::string> flags;
    std::vector<std::string> says;
  } cases[] = {
      {{"--formation=circle"}, {"--formation", "'circle'", "line, diamond or grid"}},
      {{"--formation=line", "--people=0"}, {"--people is 0"}},
      {{"--formation=line", "--spacing=0"}, {"--spacing is 0"}},
      {{"--formation=line", "--spacing=-1"}, {"--spacing is -1"}},
      {{"--formation=line", "--spacing=nan"}, {"--spacing is nan"}},
      {{"--formation=line", "--mass=-1"}, {"--mass is -1"}},
      {{"--formation=line", "--duration=-1"}, {"--duration is -1"}},
      {{"--formation=line", "--duration=0.01"}, {"--duration", "two frames"}},
      {{"--formation=line", "--push_duration=-1"}, {"--push_duration is -1"}},
      {{"--formation=line", "--push_duration=nan"}, {"--push_duration is nan"}},
      {{"--formation=line", "--people=10000", "--duration=60"}, {"too many"}},
      {{"--formation=line", "--pushed=4"}, {"--pushed", "person 4", "0 to 3"}},
      {{"--formation=line", "--pushed=-1"}, {"--pushed", "person -1"}},
      {{"--formation=line", "--pushed=one"}, {"--pushed", "'one'"}},
      {{"--formation=line", "--pushed=0,,1"}, {"--pushed", "''"}},
      {{"--formation=line", "--pushed=1,1"}, {"--pushed", "twice"}},
      {{"--formation=line", "--pushed="}, {"--pushed is empty"}},
      {{"--formation=line", "--push=hard"}, {"--push", "'hard'", "80@1.5"}},
      {{"--formation=line", "--push=80@"}, {"--push", "'80@'"}},
      {{"--formation=line", "--push=80@-1"}, {"--push", "'80@-1'", "starts"}},
      {{"--formation=line", "--push=0"}, {"--push", "'0'", "impulse"}},
      {{"--formation=line", "--push=nan"}, {"--push", "'nan'"}},
      {{"--formation=line", "--set=mew=1"}, {"--set", "'mew'"}},
      {{"--formation=line", "--out=x"}, {"--out names x", "end in .txt"}},
      {{"--formation=line", "--noise=0.1"}, {"no flag --noise"}},
      {{"--formation=line", "--svg_out=/none/wave.svg"}, {"/none/wave.svg"}},
      {{"--formation=line", "--people=301", "--svg_out=x"}, {"--svg_out", "300"}},
      {{"--formation=line", "--poses_out=x"}, {"--poses_out needs bodies", "--restoration"}},
      {{"--formation=line", "--bvh_out=" + alone_}, {"--bvh_out", "file"}},
      {{"--spacing=1"}, {"--formation is missing", "line, diamond or grid"}},
      {{"--formation=line", "--push=80@0,80@3", "--duration=2"}, {"--duration", "at 3 s"}},
      {{"--formation=line", "--csv_out=" + Path("o.txt"), "--out=" + Path("./o.txt")},
       {"--csv_out and --out", "file of its own"}},
  };
  const int files = CountFiles();
  for (const auto& one : cases) {
    SCOPED_TRACE(one.flags.back());
    EXPECT_TRUE(Refused(Simulate(one.flags), one.says));
  }
  EXPECT_TRUE(Refused(RunApp("pushid-formation", {"--formation=line"}), {"--model", "pushid-fit"}));
  EXPECT_EQ(CountFiles(), files) << "something was written";
}

TEST_F(SimulateFormationTest, ACrowdIsAFormation) {
  const std::string crowd = WriteText("crowd.txt",
                                      "# framerate: 10\n# id frame x/m y/m\n21 0 0 0\n21 1 0 0\n"
                                      "30 1 0.5 0.02\n44 1 1.0 -0.01\n");
  const AppRun run =
      Succeeded(Simulate({"--formation=" + crowd, "--formation_frame=1", "--pushed=1", "--push=20",
                          "--mass=80", "--duration=2", "--out=" + Path("out.txt")}));
  EXPECT_TRUE(Contains(run.out, "3 people of " + crowd + ", frame 1"));
  const std::string out = ReadText(Path("out.txt"));
  EXPECT_TRUE(Contains(out, "\n30\t0\t0.5\t0.02\t"));
  EXPECT_FALSE(Contains(out, "person")) << "ids are the file's own";
  // The result is itself a crowd.
  Succeeded(Simulate({"--formation=" + Path("out.txt"), "--push=20", "--formation_frame=60",
                      "--out=" + Path("next.txt")}));
  const auto refused = [&](const std::vector<std::string>& more, const std::string& says) {
    return Refused(Simulate(With({"--formation=" + crowd}, more)), {says});
  };
  EXPECT_TRUE(refused({"--formation_frame=7"}, "there is no frame 7"));
  EXPECT_TRUE(refused({"--people=3"}, "--people is for line, diamond and grid"));
  EXPECT_TRUE(refused({"--formation_frame=1", "--pushed=3"}, "the 3 people of the file count"));
  EXPECT_TRUE(refused({"--formation_frame=1", "--pushed=44"}, "the file's id 44 is person 2"));
  EXPECT_TRUE(refused({"--out=" + crowd}, "both name"));
  EXPECT_TRUE(refused({"--out=a.csv"}, "trajectories end in .txt"));
  EXPECT_TRUE(Refused(Simulate({"--formation=line", "--formation_frame=1"}),
                      {"--formation_frame needs a trajectory file"}));
}

}  // namespace
}  // namespace pushid
