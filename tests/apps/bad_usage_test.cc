// Flags that make no sense, outputs that cannot be written, models that are none: exit 1, one line,
// before any fit starts.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using BadUsageTest = AppTest;

struct UsageCase {
  std::vector<std::string> flags;
  std::vector<std::string> says;
};

TEST_F(BadUsageTest, FitFlags) {
  const std::string all_free = "mu,Kp_theta,Kd_theta,a_x,tail_gain,tail_torque,tail_time,tail_base";
  const std::vector<UsageCase> cases = {
      {{"--fix=mew"}, {"--fix", "'mew'", "not a parameter", "Kp_theta"}},
      {{"--free=mew"}, {"--free", "'mew'"}},
      {{"--fix=mu=fast"}, {"--fix", "'mu=fast'", "number"}},
      {{"--fix=mu=nan"}, {"--fix", "'mu=nan'", "number"}},
      {{"--fix=mu=3,mu=4"}, {"--fix names mu twice"}},
      {{"--fix=mu", "--free=mu"}, {"mu is both fixed (--fix) and free (--free)"}},
      {{"--free=Kp_theta=0"}, {"--free", "Kp_theta = 0", "bounds"}},
      {{"--free=Kp_theta=-5"}, {"--free", "Kp_theta = -5", "bounds"}},
      {{"--fix=tail_time=0"}, {"--fix", "tail_time = 0", "bounds"}},
      {{"--fix=tail_gain=-1"}, {"--fix", "tail_gain = -1", "bounds"}},
      {{"--prior=mu:100"}, {"--prior", "name:mean:sigma"}},
      {{"--prior=mu:100:0"}, {"--prior", "sigma > 0"}},
      {{"--pool=Kp_x"}, {"--pool", "Kp_x", "fixed"}},
      {{"--fix=" + all_free}, {"every parameter is fixed"}},
      {{"--preset=best"}, {"--preset", "'best'", "tail, robot, ldp, ldp_published"}},
      {{"--self_force=rnn"}, {"--self_force", "'rnn'"}},
      {{"--self_force=mlp:0"}, {"--self_force", "'mlp:0'"}},
      {{"--self_force=mlp:4,ldp:4"}, {"--self_force", "more than one network"}},
      {{"--self_force=mlp:2", "--network_prior=-1"}, {"--network_prior", "at least 0"}},
      {{"--posture=lying"}, {"--posture", "'lying'"}},
      {{"--push_tail=long"}, {"--push_tail", "'long'"}},
      {{"--setting=double"}, {"--setting=double", "manifest.json", "single"}},
      {{"--setting=groups"}, {"--setting=groups", "more than one person"}},
      {{"--ids=nobody"}, {"'nobody'", "manifest.json"}},
      {{"--length_unit=inch"}, {"--length_unit", "'inch'", "mm, cm or m"}},
      {{"--length_scale=-1"}, {"--length_scale is -1", "metres of one file unit"}},
      {{"--length_scale=0.01", "--length_unit=cm"},
       {"--length_scale", "together with --length_unit"}},
      {{"--marker_noise=0"}, {"--marker_noise", "positive"}},
      {{"--marker_noise=inf"}, {"--marker_noise", "positive"}},
      {{"--settling_weight=nan"}, {"--settling_weight"}},
      {{"--num_threads=0"}, {"--num_threads"}},
      {{"--max_iterations=0"}, {"--max_iterations"}},
      {{"--settling_weight=-2"}, {"--settling_weight"}},
      {{"--preset=ldp", "--pool_by=subject"}, {"--pool_by", "preset ldp pools none", "--pool=all"}},
      {{"--interaction=contact,contact"}, {"--interaction", "'contact' twice"}},
      {{"--interaction=contact,spring"}, {"--interaction", "'spring' twice"}},
      {{"--interaction=contact,none"}, {"--interaction", "none stands alone"}},
      {{"--interaction=hug"}, {"--interaction", "hug", "contact"}},
      {{"--interaction=network"}, {"--interaction", "network:4"}},
      {{"--interaction=contact", "--pool=contact_distance", "--pool_by=subject"},
       {"contact_distance", "--pool_by"}},
      {{"--seed=abc"}, {"seed", "abc"}},
  };
  const int files = CountFiles();
  for (const UsageCase& one : cases) {
    SCOPED_TRACE(one.flags[0]);
    EXPECT_TRUE(
        Refused(RunApp("pushid-fit",
                       With({Recordings(), "--model_out=" + Path("out.json")}, one.flags), 30),
                one.says));
  }
  EXPECT_EQ(CountFiles(), files) << "something was written";
}

TEST_F(BadUsageTest, OutputsThatCannotBeWrittenAreRefusedBeforeTheFit) {
  WriteText("not_a_folder", "");
  const std::string model = "--model=" + FitModel();
  for (const std::string& out :
       {Path("missing/model.json"), folder_.string(), Path("not_a_folder/model.json"),
        std::string("/proc/model.json")}) {
    SCOPED_TRACE(out);
    // No progress on stderr: Refused wants the error alone.
    EXPECT_TRUE(Refused(RunApp("pushid-fit", {Recordings(), "--model_out=" + out}), {out}));
    EXPECT_TRUE(
        Refused(RunApp("pushid-crossvalidate", {Recordings(), "--json_out=" + out}), {out}));
    EXPECT_TRUE(
        Refused(RunApp("pushid-evaluate", {model, Recordings(), "--json_out=" + out}), {out}));
    EXPECT_TRUE(Refused(
        RunApp("pushid-predict", {model, Recordings(), "--id=" + id_, "--out=" + out}), {out}));
  }
}

TEST_F(BadUsageTest, OutputsAreWhatTheirNamesSay) {
  const std::string model = "--model=" + FitModel();
  EXPECT_TRUE(Refused(RunApp("pushid-formation", {model, "--formation=line", "--push=40",
                                                  "--svg_out=" + Path("wave.html")}),
                      {"--svg_out writes .svg", "wave.html ends in .html"}));
  EXPECT_TRUE(Refused(
      RunApp("pushid-animate", {model, Recordings(), "--id=" + id_, "--out=" + Path("poses.svg")}),
      {"--out writes .html", "poses.svg ends in .svg"}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {Recordings(), "--out=" + Path("m.json")}),
                      {"there is no flag --out", "did you mean --", "--model_out"}));
}

TEST_F(BadUsageTest, ExchangedAnklesAreDoubted) {
  const std::string exchanged = ChangedManifest([](nlohmann::ordered_json& json) {
    json["recordings"][0]["joints"] = {
        {"hip", "Hips"}, {"left_ankle", "RightAnkle"}, {"right_ankle", "LeftAnkle"}};
  });
  const AppRun run = RunApp("pushid-fit", {exchanged, "--quiet"});
  EXPECT_TRUE(Contains(run.err, "people do not face forward in 1 case"));
}

// The file that is read must still be there, byte for byte.
TEST_F(BadUsageTest, OutputsNeverReplaceInputs) {
  const std::string model = FitModel();
  const std::string force = WriteText("force.csv", "time,force\n0,1\n0.2,90\n0.5,1\n");
  const std::string sensors = WriteText("sensors.json", "[{\"file\": \"force.csv\"}]");
  const std::string masses = WriteText("masses.csv", "id,mass_kg\ns1,70\n");
  const std::string mapping = WriteText("mapping.json", "{\"length_unit\": \"cm\"}");
  const std::string bvh = Path(Json(manifest_)["recordings"][0]["bvh"][0]);
  const std::string other = Path(Json(manifest_)["recordings"][1]["bvh"][0]);
  const std::string pushed = Path(Json(manifest_)["recordings"][0]["push_csv"]);
  std::filesystem::create_symlink(model, Path("link.json"));
  // --overwrite replaces no input either.
  const std::vector<std::string> make = {"--folder=" + folder_.string(), "--pattern={take}.bvh",
                                         "--overwrite"};
  const std::vector<std::string> found = {"--folder=" + folder_.string(), "--mass=70",
                                          "--pattern=bvh/{take}.bvh", "--overwrite"};
  struct Use {
    std::string program, input;
    std::vector<std::string> flags;
  };
  const std::vector<std::string> predict = {Recordings(), "--id=" + id_, "--model=" + model};
  const std::vector<std::string> push = {Recordings(), "--id=" + id_, "--overwrite"};
  const std::vector<Use> uses = {
      {"pushid-inspect", bvh, {bvh, "--svg_out=" + bvh}},
      {"pushid-push", force, With(push, {"--sensor=" + force, "--out=" + force})},
      {"pushid-push", force, With(push, {"--sensor=" + sensors, "--out=" + force})},
      {"pushid-push", sensors, With(push, {"--sensor=" + sensors, "--out=" + sensors})},
      {"pushid-push", manifest_, With(push, {"--out=" + manifest_})},
      {"pushid-manifest", masses, With(make, {"--masses=" + masses, "--out=" + masses})},
      {"pushid-manifest", mapping, With(make, {"--mapping=" + mapping, "--out=" + mapping})},
      {"pushid-push", other, With(push, {"--out=" + other})},
      {"pushid-manifest", bvh, With(found, {"--out=" + bvh})},
      {"pushid-manifest", pushed,
       With(found, {"--push_pattern=push/{take}.csv", "--out=" + pushed})},
      {"pushid-evaluate", model, {Recordings(), "--model=" + model, "--json_out=" + model}},
      {"pushid-report", model, {"--model=" + model, "--html_out=" + model}},
      {"pushid-report", model, {"--model=" + Path("link.json"), "--html_out=" + model}},
      {"pushid-predict", model, With(predict, {"--out=" + folder_.string() + "/./model.json"})},
      {"pushid-evaluate", bvh, {Recordings(), "--model=" + model, "--json_out=" + bvh}},
      {"pushid-animate", model, With(predict, {"--out=" + model})},
  };
  for (const Use& use : uses) {
    SCOPED_TRACE(use.program + " " + use.input);
    const std::string before = ReadText(use.input);
    EXPECT_TRUE(Refused(RunApp(use.program, use.flags), {"both name"}));
    EXPECT_EQ(ReadText(use.input), before);
  }
}

TEST_F(BadUsageTest, Models) {
  const std::string good = ReadText(FitModel());
  auto json = [&good](auto change) {
    nlohmann::ordered_json model = nlohmann::ordered_json::parse(good);
    change(model);
    return model.dump(1);
  };
  const std::vector<std::pair<std::string, std::string>> models = {
      {"", "empty"},
      {good.substr(0, good.size() / 2), "JSON"},
      {"[]\n", "model"},
      {"{}\n", "not a pushid model"},
      {ReadText(manifest_), "not a pushid model"},
      {json([](auto& m) { m["format_version"] = 999; }), "newer"},
      {json([](auto& m) { m["schema"] = "pushid-model/2"; }), "newer"},
      {json([](auto& m) { m["values"]["mu"] = 300; }), "'parameters/mu'"},
      {json([](auto& m) { m["values"].erase("mu"); }), "'values/mu'"},
      {json([](auto& m) { m["values"]["mu"] = "much"; }), "'values/mu'"},
      {json([](auto& m) { m["values"]["mu"] = nullptr; }), "'values/mu'"},
      {json([](auto& m) { m["model"]["posture"] = "lying"; }), "posture"},
      {json([](auto& m) { m.erase("table"); }), "table"},
      {json([](auto& m) { m["parameters"] = 3; }), "'parameters'"},
      {json([](auto& m) { m["format"] = 3; }), "not a pushid model"},
      {json([](auto& m) { m["format_version"] = "new"; }), "not a pushid model"},
      {json([](auto& m) { m["values"]["tail_time"] = 0; }), "tail_time"},
      {json([](auto& m) { m["fit"]["best_start"] = 7; }), "best_start"},
      {json([](auto& m) { m["parameters"].erase(m["parameters"].begin()); }), "correlation"},
  };
  for (const auto& [text, says] : models) {
    SCOPED_TRACE("a model that must be refused for its " + says);
    const std::string model = "--model=" + WriteText("damaged.json", text);
    EXPECT_TRUE(Refused(RunApp("pushid-report", {model}), {"damaged.json", says}));
    EXPECT_TRUE(Refused(RunApp("pushid-evaluate", {model, Recordings()}), {"damaged.json", says}));
    EXPECT_TRUE(Refused(
        RunApp("pushid-predict", {model, Recordings(), "--id=" + id_, "--out=" + Path("out.csv")}),
        {"damaged.json", says}));
  }
  EXPECT_TRUE(
      Refused(RunApp("pushid-report", {"--model=" + Path("none")}), {"none", "no such file"}));
}

// Contact of people who touch nobody.
TEST_F(BadUsageTest, ContactNeedsPeopleWhoTouch) {
  const std::string model = "--model=" + FitModel("m.json", {"--quiet"});
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {Recordings(), "--fix=contact_stiffness=2000",
                                            "--model_out=" + Path("n.json")}),
                      {"--fix", "contact_stiffness", "no contact"}));
  EXPECT_TRUE(
      Refused(RunApp("pushid-formation", {model, "--formation=line", "--set=contact_damping=10"}),
              {"--set", "contact_damping", "no contact"}));
}

TEST_F(BadUsageTest, WhatDoesNothingIsWarnedAbout) {
  FitModel("m.json", {"--fix=mu_y=10", "--quiet"});
  EXPECT_TRUE(Contains(fit_.err, "warning: --fix=mu_y=10 does nothing"));
  FitModel("m.json", {"--pool_by=subject", "--quiet"});
  EXPECT_TRUE(Contains(fit_.err, "--pool_by=subject without --pool lets only tail_base differ"));
  FitModel("m.json", {"--interaction=ldp_published", "--quiet"});
  EXPECT_TRUE(Contains(fit_.err, "warning: --interaction=ldp_published"));
}

TEST_F(BadUsageTest, WhatIfsAndIds) {
  const std::string model = "--model=" + FitModel();
  const std::string out = "--out=" + Path("out.csv");
  const std::vector<UsageCase> cases = {
      {{"--set=mew=1"}, {"--set", "'mew'"}},
      {{"--set=Kp_thta=1"}, {"--set", "'Kp_thta'", "did you mean Kp_theta?\n"}},
      {{"--set=mu"}, {"--set", "mu"}},
      {{"--set=mu=fast"}, {"--set", "'mu=fast'"}},
      {{"--set=tail_time=0"}, {"--set", "tail_time = 0"}},
      {{"--set=Kp_theta=-1"}, {"--set", "Kp_theta = -1"}},
      {{"--id=nobody"}, {"'nobody'"}},
      {{"--frames=-1"}, {"--frames"}},
      {{"--frames=1"}, {"--frames"}},
      {{"--frames=2000000000"}, {"--frames"}},
  };
  for (const UsageCase& one : cases) {
    SCOPED_TRACE(one.flags[0]);
    EXPECT_TRUE(Refused(
        RunApp("pushid-predict", With({model, Recordings(), "--id=" + id_, out}, one.flags), 30),
        one.says));
    EXPECT_FALSE(std::filesystem::exists(Path("out.csv")));
  }
}

TEST_F(BadUsageTest, SimulationFlags) {
  const std::vector<UsageCase> cases = {
      {{"--people=0"}, {"is 0; it must"}},
      {{"--frames=2"}, {"frames is 2; it must"}},
      {{"--fps=nan"}, {"fps is nan; it must"}},
      {{"--noise=-1"}, {"is -1; it must"}},
      {{"--push_kind=soft"}, {"--push_kind", "'soft'", "net or external"}},
      {{"--set=mew=1"}, {"--set", "'mew'"}},
      {{"--set=tail_time=0"}, {"--set", "tail_time = 0"}},
  };
  for (const UsageCase& one : cases) {
    SCOPED_TRACE(one.flags[0]);
    EXPECT_TRUE(
        Refused(RunApp("pushid-simulate", {"--out=" + Path("made"), one.flags[0]}, 30), one.says));
    EXPECT_FALSE(std::filesystem::exists(Path("made")));
  }
}

TEST_F(BadUsageTest, PushFlags) {
  const std::string good_sensor =
      "--sensor=" + WriteText("good.csv", "time,force\n0,1\n0.2,90\n0.5,1\n");
  const std::string sensor = "--sensor=" + WriteText("sensor.csv", "time,force\n0,1\n0.5,nan\n");
  const std::vector<UsageCase> cases = {
      {{"--frames=5:3"}, {id_, "from frame 5 to 3"}},
      {{"--frames=500:600"}, {id_, "frames 0 to"}},
      {{"--person=4"}, {id_, "no person 4"}},
      {{"--sensor=" + Path("none.csv")}, {"none.csv", "no such file"}},
      {{sensor}, {"sensor.csv:3", "force is missing"}},
      {{good_sensor, "--direction=a,b"}, {"--direction", "'a,b'"}},
  };
  for (const UsageCase& one : cases) {
    SCOPED_TRACE(one.flags[0]);
    EXPECT_TRUE(Refused(
        RunApp("pushid-push",
               With({Recordings(), "--id=" + id_, "--out=" + Path("push.csv")}, one.flags), 30),
        one.says));
    EXPECT_FALSE(std::filesystem::exists(Path("push.csv")));
  }
}

TEST_F(BadUsageTest, CrossValidationFlags) {
  WriteText("folds.json", "{\"folds\": [{\"name\": \"1\", \"held_out\": [\n\n\"nobody\"]}]}");
  const std::vector<UsageCase> cases = {
      {{"--scheme=random"}, {"--scheme", "'random'"}},
      {{"--folds=1"}, {"--folds"}},
      {{"--folds=13"}, {"--folds"}},
      {{"--repeats=0"}, {"--repeats"}},
      {{"--folds_file=" + Path("none.json")}, {"none.json", "no such file"}},
      {{"--folds_file=" + Path("folds.json")}, {"folds.json:3", "\"nobody\""}},
      {{"--compare=ldp"}, {"--compare", "'ldp'", "name:"}},
      {{"--compare=pd: preset=ldp"}, {"--compare", "'preset=ldp'"}},
      {{"--compare=pd: --preset=best"}, {"--compare", "'best'"}},
      {{"--compare=pd: --model_out=x"}, {"--compare", "'--model_out=x'"}},
      {{"--compare=pd: --json_out=x"}, {"--compare", "'--json_out=x'"}},
      {{"--compare=a: --seed=2; a: --seed=3"}, {"--compare", "'a'"}},
      {{"--compare=held: --fix=mu,Kp_theta,Kd_theta,a_x,tail_gain,tail_torque,tail_time,tail_base"},
       {"--compare", "'held'", "nothing is left"}},
  };
  for (const UsageCase& one : cases) {
    SCOPED_TRACE(one.flags[0]);
    EXPECT_TRUE(
        Refused(RunApp("pushid-crossvalidate", {Recordings(), one.flags[0]}, 30), one.says));
  }
  const std::string one_subject = ChangedManifest([](nlohmann::ordered_json& json) {
    for (auto& r : json["recordings"]) r["subjects"][0]["id"] = "s1";
  });
  EXPECT_TRUE(
      Refused(RunApp("pushid-crossvalidate", {one_subject, "--scheme=subject"}), {"subject"}));
  const std::string no_strong = ChangedManifest([](nlohmann::ordered_json& json) {
    for (auto& r : json["recordings"]) r["magnitude"] = "weak";
  });
  EXPECT_TRUE(Refused(RunApp("pushid-crossvalidate", {no_strong, "--scheme=strong"}), {"strong"}));
}

}  // namespace
}  // namespace pushid
