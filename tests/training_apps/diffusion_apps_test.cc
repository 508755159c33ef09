// Diffusion by pushid-train-generator and pushid-generate, as a user runs them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

class DiffusionAppTest : public AppTest {
 protected:
  AppRun Train(std::vector<std::string> more) const {
    more.insert(more.end(),
                {"--kind=diffusion", Recordings(), "--steps=20", "--batch=2", "--quiet"});
    return RunApp("pushid-train-generator", more);
  }
  AppRun Generate(std::vector<std::string> more) const {
    more.insert(more.end(), {"--model=" + Path("g"), Recordings(), "--steps=2", "--quiet"});
    return RunApp("pushid-generate", more);
  }
};

TEST_F(DiffusionAppTest, TrainsForecastsAndShows) {
  Succeeded(Train({"--out=" + Path("g")}));
  Succeeded(Generate({"--id=" + id_, "--frames=90", "--html_out=" + Path("p.html"),
                      "--poses_out=" + Path("p.csv"), "--json_out=" + Path("e.json")}));
  const auto json = Json(Path("e.json"));
  EXPECT_GT(json["mean"]["MPJPE_m"].get<double>(), 0.0);
  EXPECT_LT(json["mean"]["MBLE_m"].get<double>(), 5e-3);
  EXPECT_GT(json["run"]["seconds_per_recording"].get<double>(), 0.0);
  EXPECT_TRUE(Contains(ReadText(Path("p.html")), id_ + ", diffusion"));
  EXPECT_TRUE(Contains(ReadText(Path("p.csv")), "\n89,")) << "past the recording's end";
  Succeeded(Generate({"--observed=20"}));
}

TEST_F(DiffusionAppTest, CrossValidatesBesidePhysics) {
  Succeeded(RunApp("pushid-fit", {Recordings(), "--model_out=" + Path("m.json")}));
  Succeeded(Train({"--crossvalidate=2", "--scheme=interleaved", "--physics=" + Path("m.json"),
                   "--blend=0.5", "--json_out=" + Path("e.json")}));
  const auto json = Json(Path("e.json"));
  for (const char* name : {"generator_unblended", "generator_shown_20", "rigid", "static"}) {
    EXPECT_TRUE(json["baselines"][name]["mean"].contains("MPJPE_m")) << name;
  }
  EXPECT_NE(json["mean"]["hipADE_m"], json["baselines"]["generator_unblended"]["mean"]["hipADE_m"]);
  Succeeded(Train({"--out=" + Path("g")}));
  Succeeded(Generate({"--physics=" + Path("m.json"), "--blend=0.3"}));
}

// Nobody is pushed; who speaks is annotated.
TEST_F(DiffusionAppTest, GroupsWithoutAPushAreForecastAndTheirStatesCompared) {
  Succeeded(RunApp("simulate-others", {"--turns=4", "--frames=90", "--out=" + Path("t")}));
  const std::string turns = "--recordings=" + Path("t/manifest.json");
  Succeeded(RunApp("pushid-train-generator",
                   {"--published=sdm", turns, "--steps=5", "--batch=2", "--quiet",
                    "--hold_out=false", "--observed=20", "--out=" + Path("g")}));
  const auto generate = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--model=" + Path("g"), turns, "--steps=2", "--quiet",
                             "--json_out=" + Path("e.json")});
    return RunApp("pushid-generate", more);
  };
  const AppRun run = Succeeded(generate(
      {"--states=" + Path("t/states.csv"), "--id=turns_01", "--html_out=" + Path("p.html")}));
  EXPECT_TRUE(Contains(run.out, "root to 1 s"));
  auto json = Json(Path("e.json"));
  EXPECT_EQ(json["errors_at"][0]["recordings"], 4);
  EXPECT_TRUE(json["errors_at"][1]["root_m"].is_null());
  EXPECT_EQ(json["social"]["names"].size(), 3u);
  const auto by_frame = json["social"]["by"]["generator"]["by_frame"];
  EXPECT_EQ(json["social"]["first_frame"], 20);
  EXPECT_EQ(by_frame["sscp"].size(), 70u);
  EXPECT_EQ(by_frame["ndms"].size(), 52u);
  EXPECT_TRUE(Contains(ReadText(Path("p.html")), "people: changes of state a minute"));
  // The built-in states from a file are the built-in ones.
  ASSERT_EQ(generate({"--csv_out=" + Path("s.csv")}).exit_code, 0);
  auto built_in = Json(Path("e.json"));
  ASSERT_EQ(generate({"--states=" + Path("s.csv")}).exit_code, 0);
  auto from_file = Json(Path("e.json"));
  for (auto* of : {&built_in, &from_file}) (*of)["social"].erase("states");
  EXPECT_EQ(built_in["social"].dump(), from_file["social"].dump());
  EXPECT_EQ(built_in["group_metrics"].dump(), from_file["group_metrics"].dump());
  WriteText("wrong.csv", "recording,frame,person,symbol\nturns_1,0,T1,speak\n");
  EXPECT_TRUE(Refused(generate({"--states=" + Path("wrong.csv")}),
                      {"wrong.csv:2", "turns_1", "did you mean turns_01?"}));
}

TEST_F(DiffusionAppTest, AsSdmIsPublished) {
  Succeeded(Train({"--out=" + Path("g"), "--published=sdm"}));
  const auto settings = Json(Path("g/generator.json"))["settings"];
  EXPECT_EQ(settings["pooling"], "mean_all");
  EXPECT_EQ(settings["pooling_at"], "bottleneck");
  EXPECT_EQ(settings["frame"], "own");
  Succeeded(Generate({"--published=sdm", "--frames=241", "--json_out=" + Path("e.json")}));
  EXPECT_GT(Json(Path("e.json"))["mean"]["MBLE_m"].get<double>(), 1e-3) << "nothing is corrected";
  EXPECT_TRUE(Refused(Generate({"--published=sde"}),
                      {"--published has no effect on a generator of diffusion"}));
  EXPECT_TRUE(
      Refused(Train({"--published=sdm", "--crossvalidate=2"}), {"leave out --published=sdm"}));
  Succeeded(Train({"--out=" + Path("h"), "--published=sdm", "--pooling=heads"}));
  EXPECT_EQ(Json(Path("h/generator.json"))["settings"]["pooling"], "heads")
      << "flags change the preset";
  EXPECT_TRUE(Refused(RunApp("pushid-train-generator",
                             {"--kind=particles", "--published=sdm", "--out=" + Path("i")}),
                      {"--published=sdm needs --kind=diffusion"}));
}

// It learned from net pushes, and that is told once.
TEST_F(DiffusionAppTest, PushesOfAnotherKindAreToldOf) {
  Succeeded(Train({"--out=" + Path("g")}));
  const auto generate = [&](const std::string& recordings) {
    return RunApp("pushid-generate", {"--model=" + Path("g"), recordings, "--steps=2", "--quiet"});
  };
  EXPECT_EQ(generate(Recordings()).err, "");
  const AppRun other = generate(ChangedManifest([](nlohmann::ordered_json& json) {
    for (auto& recording : json["recordings"]) recording["push_kind"] = "external";
  }));
  EXPECT_EQ(other.exit_code, 0) << other.err;
  const size_t told = other.err.find("is applied to pushes of kind external");
  EXPECT_NE(told, std::string::npos) << other.err;
  EXPECT_EQ(other.err.find("is applied", told + 20), std::string::npos) << other.err;
}

TEST_F(DiffusionAppTest, MistakesAreNamed) {
  EXPECT_TRUE(Refused(Train({"--out=" + Path("g"), "--noise_steps=1"}),
                      {"--noise_steps needs --kind=particles"}));
  EXPECT_TRUE(Refused(Train({"--out=" + Path("g"), "--pooling=all"}), {"--pooling is 'all'"}));
  EXPECT_TRUE(
      Refused(Train({"--out=" + Path("g"), "--blend=0.3"}), {"--blend needs --crossvalidate"}));
  EXPECT_TRUE(Refused(Train({"--crossvalidate=2", "--blend=0.3"}), {"--blend needs --physics"}));
  EXPECT_TRUE(Refused(Train({"--out=" + Path("g"), "--physics=" + Path("m.json")}),
                      {"--physics needs --crossvalidate"}));
  Succeeded(Train({"--out=" + Path("g")}));
  EXPECT_TRUE(Refused(Generate({"--blend=0.3"}), {"needs --physics"}));
  for (const char* flag : {"--without=simlpe", "--samples=19"}) {
    EXPECT_TRUE(Refused(Generate({flag}), {"has no effect on a generator of diffusion"})) << flag;
  }
  EXPECT_TRUE(Refused(Generate({"--id=nobody", "--html_out=" + Path("p.html")}), {"nobody"}));
}

}  // namespace
}  // namespace pushid
