// The behaviour that all executables share: help, version, flag files, exit codes, output on both
// streams.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using CommandLineTest = AppTest;

struct App {
  const char* name;
  const char* flag;  // one that its help must name
};
const std::vector<App> kApps = {
    {"pushid-fit", "--model_out"},        {"pushid-report", "--model"},
    {"pushid-evaluate", "--json_out"},    {"pushid-predict", "--id"},
    {"pushid-simulate", "--out"},         {"pushid-push", "--sensor"},
    {"pushid-crossvalidate", "--scheme"}, {"pushid-check", "--bootstrap"},
    {"pushid-formation", "--spacing"}};

// One screen with the flags that people use, and all of them on demand.
TEST_F(CommandLineTest, HelpNamesTheFlagsAndIsNoError) {
  for (const App& app : kApps) {
    SCOPED_TRACE(app.name);
    const AppRun run = RunApp(app.name, {"--help"}), all = RunApp(app.name, {"--help=all"});
    for (const AppRun& one : {run, all}) {
      EXPECT_EQ(one.exit_code, 0);
      EXPECT_TRUE(Contains(one.out, "\n  " + std::string(app.name) + " --")) << "an example call";
      EXPECT_TRUE(Contains(one.out, app.flag));
      EXPECT_FALSE(Contains(one.out, "minloglevel")) << "flags of other libraries";
      EXPECT_EQ(one.err, "");
      std::stringstream lines(one.out);
      for (std::string line; std::getline(lines, line);) {
        EXPECT_TRUE(line.size() <= 100 || Contains(line, app.name)) << line;
      }
    }
    EXPECT_LE(std::count(run.out.begin(), run.out.end(), '\n'), 45);
    EXPECT_TRUE(Contains(run.out, "--help=all"));
    EXPECT_TRUE(Contains(all.out, "--flagfile"));
    EXPECT_TRUE(Contains(all.out, "--version"));
    EXPECT_TRUE(Contains(all.out, "--quiet"));
    EXPECT_EQ(RunApp(app.name, {"-h"}).out, run.out);
    EXPECT_EQ(RunApp(app.name, {"--helpfull"}).out, all.out);
  }
}

// The second line of --help.
std::string ExampleOf(const std::string& app) {
  const std::string help = Succeeded(RunApp(app, {"--help"})).out;
  const size_t begin = help.find('\n') + 1;
  EXPECT_EQ(help.rfind(app + " ", 0), 0u) << "what it is for";
  EXPECT_LT(help.find(app + " ", begin), help.find('\n', begin)) << help;
  return help.substr(begin, help.find('\n', begin) - begin);
}

// In a folder with the files of apps/quickstart.sh, one after the other.
TEST_F(CommandLineTest, ExamplesOfHelpWork) {
  const std::string enter =
      "set -e; cd '" + Path("") + "'; export PATH='" PUSHID_BIN_DIR "':$PATH; ";
  const auto run = [&enter](const std::string& command) {
    Succeeded(RunProgram("/bin/bash", {"-c", enter + command}));
  };
  run("pushid-simulate --out=recordings --people=4 --recordings_per_person=3 --seed=1; "
      "pushid-simulate --out=held-out --people=2 --recordings_per_person=3 --seed=2");
  for (const char* app :
       {"fit", "check", "report", "evaluate", "crossvalidate", "predict", "animate", "formation",
        "path", "simulate", "inspect", "manifest", "push"}) {
    SCOPED_TRACE(app);
    run(ExampleOf(std::string("pushid-") + app));
  }
  // These need a plan, recorded motion or LibTorch: their flags exist.
  for (const std::string app :
       {"pushid-batch", "pushid-generate", "pushid-train-restoration", "pushid-train-generator"}) {
    if (!std::filesystem::exists(PUSHID_BIN_DIR "/" + app)) continue;
    const std::string example = ExampleOf(app), help = RunApp(app, {"--help=all"}).out;
    for (size_t at = example.find("--"); at != std::string::npos; at = example.find("--", at + 2)) {
      const std::string flag = example.substr(at, example.find('=', at) - at);
      EXPECT_TRUE(Contains(help, "  " + flag + "\n") || Contains(help, "  " + flag + "=")) << flag;
    }
  }
}

// A bootstrap that takes longer is interrupted after four seconds. Elsewhere than on a terminal the
// first line comes after ten.
TEST_F(CommandLineTest, ProgressIsABarOnATerminalAndRareElsewhere) {
  const std::string check = "timeout --signal=INT 4 '" PUSHID_BIN_DIR "/pushid-check' " +
                            Recordings() + " --model=" + FitModel() +
                            " --bootstrap=5000 --bootstrap_by=recording";
  EXPECT_FALSE(Contains(RunProgram("/bin/bash", {"-c", check}).err, "bootstrap draw"));
  const auto seen = [](const std::string& command) {
    return RunProgram("/usr/bin/script", {"-qec", command, "/dev/null"}).out;
  };
  const std::string bar = seen(check), quiet = seen(check + " --quiet");
  EXPECT_TRUE(Contains(bar, ".] ") && Contains(bar, "bootstrap draw")) << bar;
  EXPECT_FALSE(Contains(bar, "] 0 s")) << bar;
  EXPECT_FALSE(Contains(quiet, "bootstrap draw")) << quiet;
}

TEST_F(CommandLineTest, VersionIsTheProgramAndANumber) {
  for (const App& app : kApps) {
    const AppRun run = Succeeded(RunApp(app.name, {"--version"}));
    EXPECT_TRUE(Contains(run.out, std::string(app.name) + " 0.")) << run.err;
  }
}

TEST_F(CommandLineTest, UnknownFlagsAndLooseWordsAreRefused) {
  for (const App& app : kApps) {
    EXPECT_TRUE(
        Refused(RunApp(app.name, {"--no_such_flag=1"}),
                {std::string(app.name) + ": error: there is no flag --no_such_flag", "--help"}));
    const AppRun bare = RunApp(app.name, {"manifest.json"});
    EXPECT_TRUE(Refused(bare, {"'manifest.json'", "--help"}));
    EXPECT_FALSE(Contains(bare.err, "?;")) << bare.err;
  }
}

TEST_F(CommandLineTest, OutputsOfFormatsThatNothingWrites) {
  EXPECT_TRUE(
      Refused(RunApp("pushid-predict", {Recordings(), "--model=" + FitModel(), "--id=" + id_,
                                        "--restoration=rigid", "--out=" + Path("body.fbx")}),
              {"body.fbx", "no program writes .fbx", ".bvh"}));
}

TEST_F(CommandLineTest, CtrlCSaysWhatIsKept) {
  const auto interrupted = [](const std::string& program, std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"--preserve-status", "--signal=INT", "2",
                                 std::string(PUSHID_BIN_DIR) + "/" + program});
    return RunProgram("/usr/bin/timeout", flags);
  };
  const AppRun run = interrupted("pushid-fit", {Recordings(), "--self_force=mlp:64", "--quiet",
                                                "--model_out=" + Path("m.json")});
  EXPECT_EQ(run.exit_code, 130) << run.err;
  EXPECT_TRUE(Contains(run.err, "pushid-fit: interrupted; no partial file is left"));
  EXPECT_FALSE(std::filesystem::exists(Path("m.json")));
}

// Steps are counted in lines.
TEST_F(CommandLineTest, TheLogHasSeveritiesAndSaysEveryStep) {
  const auto log = [this](const std::string& how) {
    return RunApp("pushid-fit", {Recordings(), "--fix=mu_y=10", how}).err;
  };
  const std::string quiet = log("--quiet"), all = log("--v=1");
  for (const std::string& text : {quiet, all}) {
    EXPECT_TRUE(Contains(text, "pushid-fit: warning: --fix=mu_y=10 does nothing")) << text;
  }
  EXPECT_FALSE(Contains(quiet, "fitting")) << quiet;
  EXPECT_TRUE(Contains(all, "iteration 1, cost")) << all;
  EXPECT_GT(std::count(all.begin(), all.end(), '\n'), 8) << all;
}

TEST_F(CommandLineTest, RepeatedCandidatesAreAllCompared) {
  const AppRun run = RunApp(
      "pushid-crossvalidate",
      {Recordings(), "--folds=2", "--yardsticks=false", "--compare=one: --preset=ldp", "--details",
       "--group_by=subject", "--compare", "two: --self_force=linear; three: --fix=mu"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"one", "two", "three", "\nsubject S01 ", "\nsubject S02 "}) {
    EXPECT_TRUE(Contains(run.out, name));
  }
  EXPECT_FALSE(Contains(run.out, "\nstrength "));
  for (const char* by : {"subject,,setting", "subject,subject", "shoes"}) {
    EXPECT_TRUE(
        Refused(RunApp("pushid-crossvalidate", {Recordings(), std::string("--group_by=") + by}),
                {"--group_by"}))
        << by;
  }
}

TEST_F(CommandLineTest, AMisspeltFlagIsGuessed) {
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--recording=m.json"}), {"mean --recordings?"}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--modl_out=m.json"}), {"mean --model_out?"}));
  const AppRun far = RunApp("pushid-fit", {"--no_such_flag=1"});
  EXPECT_FALSE(Contains(far.err, "mean")) << far.err;
}

TEST_F(CommandLineTest, AValueThatIsNoneIsAnOrdinaryError) {
  EXPECT_TRUE(Refused(RunApp("pushid-check", {"--bootstrap=abc"}),
                      {"pushid-check: error: --bootstrap=abc: 'abc' is not a whole number"}));
  EXPECT_TRUE(Refused(RunApp("pushid-check", {"--bootstrap", "1e3"}), {"'1e3'"}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--quiet=maybe"}), {"'maybe' is not true or false"}));
  EXPECT_TRUE(Refused(RunApp("pushid-simulate", {"--fps=x"}), {"'x' is not a number"}));
  EXPECT_TRUE(Refused(RunApp("pushid-check", {"--bootstrap"}), {"--bootstrap has no value"}));
  EXPECT_TRUE(
      Refused(RunApp("pushid-fit", {"M/manifest.json"}), {"--recordings=M/manifest.json?"}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--preset", "--check"}),
                      {"--preset has no value, as --check is a flag: --preset=..."}));
}

TEST_F(CommandLineTest, WhatIsMissingIsNamed) {
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {}), {"--recordings", "manifest.json"}));
  EXPECT_TRUE(Refused(RunApp("pushid-crossvalidate", {}), {"--recordings", "manifest.json"}));
  EXPECT_TRUE(Refused(RunApp("pushid-push", {}), {"--recordings", "manifest.json"}));
  EXPECT_TRUE(Refused(RunApp("pushid-simulate", {}), {"--out"}));
  for (const char* app : {"pushid-report", "pushid-evaluate", "pushid-predict"}) {
    EXPECT_TRUE(Refused(RunApp(app, {}), {"--model", "pushid-fit --model_out"}));
  }
  const std::string model = "--model=" + FitModel();
  EXPECT_TRUE(Refused(RunApp("pushid-evaluate", {model}), {"--recordings"}));
  EXPECT_TRUE(Refused(RunApp("pushid-push", {Recordings()}), {"--out"}));
  EXPECT_TRUE(Refused(RunApp("pushid-predict", {model, Recordings()}), {"--id"}));
  EXPECT_TRUE(Refused(RunApp("pushid-predict", {model, Recordings(), "--id=" + id_}), {"--out"}));
}

TEST_F(CommandLineTest, AFlagFileCountsLikeFlags) {
  const std::string flags =
      WriteText("fit.flags", Recordings() + "\n--fix=mu=33\n--model_out=" + Path("m.json") + "\n");
  Succeeded(RunApp("pushid-fit", {"--flagfile=" + flags}));
  EXPECT_EQ(Json(Path("m.json"))["values"]["mu"], 33.0);
}

TEST_F(CommandLineTest, AFitThatDoesNotConvergeExitsWithTwo) {
  const AppRun run = RunApp("pushid-fit", {Recordings(), "--max_iterations=1"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(Contains(run.out, "did NOT converge"));
}

TEST_F(CommandLineTest, APredictionThatFallsExitsWithTwoAndSaysWhere) {
  const std::string model = FitModel();
  const AppRun run =
      RunApp("pushid-predict", {"--model=" + model, Recordings(), "--id=" + id_, "--frames=600",
                                "--set=Kp_theta=1,a_x=0", "--out=" + Path("fall.csv")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(Contains(run.err, "theta of person 0"));
  EXPECT_TRUE(Contains(run.err, "frame "));
  EXPECT_FALSE(std::filesystem::exists(Path("fall.csv")));
}

}  // namespace
}  // namespace pushid
