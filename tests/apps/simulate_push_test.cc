// pushid-simulate and pushid-push: what they write is what the other programs take.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "datasets/files/json_file.h"
#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

class SimulateAppTest : public AppTest {
 protected:
  // pushid-simulate into `name`; returns the manifest's path.
  std::string Simulate(const std::string& name, const std::vector<std::string>& flags) {
    run_ = Succeeded(RunApp("pushid-simulate", With(flags, {"--out=" + Path(name)})));
    return Path(name + "/manifest.json");
  }

  AppRun run_;
};

TEST_F(SimulateAppTest, TheDefaultFitFindsItsTruth) {
  const std::string manifest = Simulate("made", {"--noise=0", "--set=mu=60,Kp_theta=1800"});
  const nlohmann::ordered_json truth = Json(manifest)["synthetic"]["truth"];
  EXPECT_EQ(truth["mu"], 60.0);
  EXPECT_TRUE(Contains(run_.out, "1800"));
  Succeeded(RunApp("pushid-fit", {"--recordings=" + manifest, "--preset_priors=false",
                                  "--settling_weight=0", "--model_out=" + Path("model.json")}));
  const auto model = Json(Path("model.json"));  // lives longer than a temporary in the loop's head
  for (const auto& [name, value] : model.at("values").items()) {
    if (name == "mu_y") continue;         // does not act: friction is isotropic
    if (!truth.contains(name)) continue;  // process noise, of which there was none
    if (name.rfind("measured_", 0) == 0) continue;
    const double expected = truth[name];
    // The truth moves in the axes of the file, the fit sees people along their pushes.
    EXPECT_NEAR(value.get<double>(), expected, 3e-4 * std::max(1.0, std::abs(expected))) << name;
  }
  const AppRun report =
      RunApp("pushid-report", {"--model=" + Path("model.json"), "--truth=" + manifest});
  EXPECT_TRUE(Contains(report.out, "8 of 8 intervals cover the truth"));
}

// Rows of people who touch, as preset group fits them.
TEST_F(SimulateAppTest, TheTruthOfGroupsIsFound) {
  const std::string manifest =
      Simulate("made", {"--people=6", "--group_size=3", "--recordings_per_person=3", "--noise=0"});
  EXPECT_TRUE(Contains(run_.out, "18 recordings of 6 people in rows of 3"));
  EXPECT_TRUE(Contains(run_.out, "contact_stiffness"));
  Succeeded(RunApp("pushid-fit", {"--recordings=" + manifest, "--setting=groups", "--preset=group",
                                  "--pool=none", "--preset_priors=false", "--settling_weight=0",
                                  "--model_out=" + Path("model.json")}));
  const nlohmann::ordered_json truth = Json(manifest)["synthetic"]["truth"];
  const auto model = Json(Path("model.json"));
  for (const char* name : {"mu", "Kp_theta", "contact_stiffness", "contact_distance",
                           "contact_kappa", "contact_damping", "tail_exponent"}) {
    const double expected = truth[name];
    EXPECT_NEAR(model["values"][name].get<double>(), expected, 1e-3 * std::abs(expected)) << name;
  }
  EXPECT_TRUE(Refused(RunApp("pushid-simulate", {"--out=" + Path("no"), "--group_size=9"}),
                      {"--group_size is 9", "between 1 and 4"}));
  // A model of people alone does not make people touch.
  const AppRun alone = Succeeded(RunApp(
      "pushid-simulate", {"--model=" + FitModel(), "--group_size=2", "--out=" + Path("apart")}));
  EXPECT_TRUE(Contains(alone.err, "do not act on each other"));
}

// Noise is no term of the preset's fit: --set had said that sigma_x does nothing.
TEST_F(SimulateAppTest, NoiseHasItsNumbers) {
  Simulate("made", {"--truth_noise=diagonal", "--set=sigma_x=12", "--people=2"});
  EXPECT_TRUE(Contains(run_.out, "sigma_x"));
}

// Feet that hold and step, with default flags: errors of the fit hold the truth of most parameters.
TEST_F(SimulateAppTest, TheTruthMayStand) {
  const std::string manifest = Simulate("made", {"--stance=steps", "--people=5"});
  EXPECT_EQ(Json(manifest)["synthetic"]["stance"], "steps");
  Succeeded(RunApp("pushid-fit", {"--recordings=" + manifest, "--stance=steps",
                                  "--model_out=" + Path("model.json")}));
  const AppRun report =
      RunApp("pushid-report", {"--model=" + Path("model.json"), "--truth=" + manifest});
  const size_t covered = report.out.find(" of 12 intervals cover the truth");
  ASSERT_TRUE(covered != std::string::npos && covered > 2) << report.out;
  EXPECT_GE(std::stoi(report.out.substr(covered - 2, 2)), 10) << report.out;
  EXPECT_TRUE(Refused(RunApp("pushid-simulate", {"--model=" + Path("model.json"), "--stance=slide",
                                                 "--out=" + Path("again")}),
                      {"--stance"}));
}

TEST_F(SimulateAppTest, TheSameSeedWritesTheSameFiles) {
  const auto bvh = [this](const std::string& name, const std::string& seed) {
    const auto first = Json(Simulate(name, {"--people=1", seed}))["recordings"][0];
    return ReadText(Path(name + "/" + first["bvh"][0].get<std::string>()));
  };
  const std::string once = bvh("once", "--seed=7");
  EXPECT_EQ(bvh("again", "--seed=7"), once);
  EXPECT_NE(bvh("other", "--seed=8"), once);
}

TEST_F(SimulateAppTest, ParametersMayVary) {
  Simulate("made", {"--people=1", "--subject_spread=0.05"});
  EXPECT_TRUE(Contains(run_.out, "0.05 between people"));
}

TEST_F(SimulateAppTest, ReplacesItsOwnOutputOnlyAndOnlyWhenTold) {
  const std::string manifest = Simulate("made", {"--people=2"});
  const std::string before = ReadText(manifest);
  EXPECT_TRUE(Refused(RunApp("pushid-simulate", {"--out=" + Path("made"), "--people=1"}),
                      {manifest, "--overwrite"}));
  EXPECT_EQ(ReadText(manifest), before);
  Simulate("made", {"--people=1", "--overwrite"});
  EXPECT_NE(ReadText(manifest), before);
  WriteText("real/manifest.json", R"({"recordings": []})");
  for (const char* folder : {"real", "manifest.json", "real/manifest.json"}) {
    SCOPED_TRACE(folder);
    EXPECT_TRUE(Refused(RunApp("pushid-simulate", {"--out=" + Path(folder), "--overwrite"}),
                        {Path(folder)}));
  }
  EXPECT_EQ(ReadText(Path("real/manifest.json")), R"({"recordings": []})");
}

class PushAppTest : public AppTest {
 protected:
  AppRun MakePush(std::vector<std::string> flags) {
    flags.insert(flags.end(), {Recordings(), "--id=" + id_, "--out=" + Path("made/push.csv")});
    std::filesystem::create_directories(Path("made"));
    return RunApp("pushid-push", flags);
  }

  // Puts the lines that the program printed into the manifest, as its user does, and fits.
  AppRun FitWithPrintedLines(const AppRun& made) {
    const size_t begin = made.out.find("\"push_kind\"");
    EXPECT_NE(begin, std::string::npos) << made.out;
    const auto lines = nlohmann::ordered_json::parse("{" + made.out.substr(begin) + "}");
    const std::string recordings = ChangedManifest([&lines](nlohmann::ordered_json& json) {
      json["recordings"][0].erase("push_csv");
      for (const auto& [key, value] : lines.items()) json["recordings"][0][key] = value;
    });
    return RunApp("pushid-fit", {recordings});
  }
};

TEST_F(PushAppTest, InverseDynamicsGivesLinesForTheManifest) {
  const AppRun made = Succeeded(MakePush({}));
  EXPECT_TRUE(Contains(made.out, "smoothed over 9 frames"));
  EXPECT_TRUE(Contains(made.out, "\"net\""));
  Succeeded(FitWithPrintedLines(made));
}

TEST_F(PushAppTest, TheWindowMayBeNamed) {
  const AppRun made = Succeeded(MakePush({"--frames=2:9"}));
  EXPECT_TRUE(Contains(made.out, "7 rows from frame 2"));
  EXPECT_TRUE(Contains(made.out, "\"start_frame\": 2"));
}

TEST_F(PushAppTest, TheImpulseIsSaidByItsDirection) {
  const std::string sensor =
      "--sensor=" + WriteText("force.csv", "time,force\n0.1,0\n0.2,200\n0.3,0\n");
  const AppRun made = MakePush({sensor, "--direction=-1,-1,0", "--height=0.9"});
  EXPECT_TRUE(Contains(made.out, "impulse 14.1 N s backwards, 14.1 N s to the right")) << made.out;
}

TEST_F(PushAppTest, ASensorsForceGivesLinesForTheManifest) {
  const std::string sensor =
      "--sensor=" + WriteText("force.csv", "time,force\n0.1,0\n0.2,200\n0.3,0\n");
  // Along x + y, so half the square of its 20 N s goes each way.
  const AppRun made = Succeeded(MakePush({sensor, "--direction=1,1,0", "--height=0.9"}));
  EXPECT_TRUE(Contains(made.out, "impulse 14.1 N s forwards, 14.1 N s to the left"));
  EXPECT_TRUE(Contains(made.out, "\"external\""));
  EXPECT_TRUE(Contains(made.out, "\"csv\": \"made/push.csv\""));
  Succeeded(FitWithPrintedLines(made));
  // The sensor's clock: the same push at frame 0.
  EXPECT_TRUE(
      Contains(MakePush({sensor, "--sensor_start=0.1", "--overwrite"}).out, "\"start_frame\": 0"));
}

TEST_F(PushAppTest, FlagsOfTheOtherWayAreRefused) {
  const std::string sensor = "--sensor=" + WriteText("f.csv", "time,force\n0.1,0\n0.2,9\n0.3,0\n");
  EXPECT_TRUE(Refused(MakePush({"--height=0.9"}), {"--height", "--sensor"}));
  EXPECT_TRUE(Refused(MakePush({sensor, "--frames=5:9"}), {"--frames", "--sensor"}));
  EXPECT_TRUE(Refused(MakePush({sensor, "--height=50"}), {"--height"}));
  EXPECT_FALSE(std::filesystem::exists(Path("made/push.csv")));
}

TEST_F(PushAppTest, APushIsNotReplacedUnasked) {
  ASSERT_EQ(MakePush({}).exit_code, 0);
  const std::string before = ReadText(Path("made/push.csv"));
  EXPECT_TRUE(Refused(MakePush({"--frames=2:9"}), {Path("made/push.csv"), "--overwrite"}));
  EXPECT_EQ(ReadText(Path("made/push.csv")), before);
}

TEST_F(PushAppTest, AWindowInsideAMotionStartsWithItsVelocity) {
  const AppRun usual = Succeeded(MakePush({"--frames=15:30"}));
  EXPECT_TRUE(Contains(usual.out, "m/s at its start"));
  EXPECT_FALSE(Contains(usual.err, "stands out")) << usual.err;
}

TEST_F(PushAppTest, EntriesOfSeveralRecordings) {
  const auto before = Json(manifest_)["recordings"];
  const std::string ids =
      before[0]["id"].get<std::string>() + "," + before[1]["id"].get<std::string>();
  const std::vector<std::string> flags = {Recordings(), "--ids=" + ids, "--update",
                                          "--out=" + Path("made/{id}.csv")};
  std::filesystem::create_directories(Path("made"));
  // Both have a push already.
  EXPECT_TRUE(Refused(RunApp("pushid-push", flags), {manifest_, "already", "--overwrite"}));
  EXPECT_FALSE(std::filesystem::exists(Path("made/" + id_ + ".csv")));
  std::vector<std::string> told = flags;
  told.push_back("--overwrite");
  const AppRun run = Succeeded(RunApp("pushid-push", told));
  EXPECT_TRUE(Contains(run.out, "2 entries written to"));
  const auto after = Json(manifest_)["recordings"];
  for (int i : {0, 1}) {
    EXPECT_FALSE(after[i].contains("push_csv"));
    ASSERT_EQ(after[i]["pushes"].size(), 1u);
    EXPECT_EQ(after[i]["pushes"][0]["csv"], "made/" + after[i]["id"].get<std::string>() + ".csv");
  }
  EXPECT_EQ(after[2], before[2]);
  // Without ids all recordings of the manifest are meant.
  const AppRun all = Succeeded(
      RunApp("pushid-push", {Recordings(), "--overwrite", "--out=" + Path("all/{id}.csv")}));
  for (const auto& entry : before) {
    const std::string id = entry["id"].get<std::string>();
    EXPECT_TRUE(std::filesystem::exists(Path("all/" + id + ".csv"))) << all.out;
  }
  Succeeded(RunApp("pushid-fit", {Recordings()}));
  EXPECT_TRUE(
      Refused(RunApp("pushid-push", {Recordings(), "--ids=" + ids, "--out=" + Path("x.csv")}),
              {"--out", "{id}"}));
}

// Two manifests are one set of recordings; what they both name is told.
TEST_F(PushAppTest, ManifestsMerge) {
  const auto split = [this](const std::string& name, int first, int count) {
    nlohmann::ordered_json json = Json(manifest_);
    nlohmann::ordered_json some = nlohmann::ordered_json::array();
    for (int i = first; i < first + count; ++i) {
      some.push_back(json["recordings"][i]);
      for (auto& file : some.back()["bvh"]) file = "../" + file.get<std::string>();
      some.back()["push_csv"] = "../" + some.back()["push_csv"].get<std::string>();
    }
    json["recordings"] = some;
    return WriteText(name, json.dump(1));
  };
  const std::string a = split("one/a.json", 0, 6), b = split("two/b.json", 6, 6);
  const AppRun whole = RunApp("pushid-fit", {Recordings(), "--model_out=" + Path("whole.json")});
  Succeeded(
      RunApp("pushid-fit", {"--recordings=" + a + "," + b, "--model_out=" + Path("merged.json")}));
  EXPECT_EQ(Json(Path("merged.json"))["values"], Json(Path("whole.json"))["values"]);
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--recordings=" + a + "," + manifest_}),
                      {"manifest.json:", id_, "this id is in " + a}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--recordings=" + a + "," + b, "--model_out=" + b}),
                      {"--recordings and --model_out both name"}));
}

}  // namespace
}  // namespace pushid
