// pushid in front of the programs: commands, help, misspelt commands, completion.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using FrontTest = AppTest;

TEST_F(FrontTest, ACommandIsTheProgramWithItsExitCode) {
  EXPECT_EQ(RunApp("pushid", {"report", "--help"}).out, RunApp("pushid-report", {"--help"}).out);
  EXPECT_EQ(RunApp("pushid", {"help", "report"}).out, RunApp("pushid-report", {"--help"}).out);
  const AppRun fit =
      Succeeded(RunApp("pushid", {"fit", Recordings(), "--model_out=" + Path("model.json")}));
  EXPECT_TRUE(Contains(fit.out, "model written to"));
  EXPECT_TRUE(Refused(RunApp("pushid", {"fit"}), {"pushid-fit: error: --recordings is missing"}));
  EXPECT_TRUE(Contains(RunApp("pushid", {"--version"}).out, "pushid 0."));
  EXPECT_EQ(RunApp("pushid", {"pushid-fit", "--version"}).out,
            RunApp("pushid-fit", {"--version"}).out);
  EXPECT_EQ(RunApp("pushid", {"help", "help"}).out, RunApp("pushid", {"help"}).out);
  const AppRun shells = Succeeded(RunApp("pushid", {"help", "completion"}));
  EXPECT_TRUE(Contains(shells.out, "in ~/.bashrc: source <(pushid completion bash)"));
}

TEST_F(FrontTest, MisspeltCommands) {
  EXPECT_TRUE(Refused(RunApp("pushid", {"reprot"}), {"'reprot'", "did you mean 'report'?"}));
  EXPECT_TRUE(Refused(RunApp("pushid", {"help", "fitt"}), {"did you mean 'fit'?"}));
  EXPECT_TRUE(Refused(RunApp("pushid", {"--fit"}), {"'--fit'", "pushid help"}));
  EXPECT_TRUE(Refused(RunApp("pushid", {"completion", "csh"}), {"bash, zsh and fish", "'csh'"}));
}

// Every program that was built is a command.
TEST_F(FrontTest, HelpListsAllPrograms) {
  const std::string help = RunApp("pushid", {"help"}).out;
  EXPECT_EQ(RunApp("pushid", {}).out, help);
  for (const auto& entry : std::filesystem::directory_iterator(PUSHID_BIN_DIR)) {
    const std::string name = entry.path().filename().string();
    const bool study = name.find("study") != std::string::npos || name == "pushid-benchmarks";
    if (name.rfind("pushid-", 0) != 0 || study) continue;
    EXPECT_TRUE(Contains(help, "\n  " + name.substr(7) + " ")) << name;
  }
}

// All that is asked of the scripts, as writing one asks every program for its flags. In zsh a colon
// or a bracket would end a description.
TEST_F(FrontTest, ShellsCompleteFlagsAndTheirWords) {
  std::map<std::string, std::string> scripts;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    SCOPED_TRACE(shell);
    const AppRun run = Succeeded(RunApp("pushid", {"completion", shell}));
    EXPECT_TRUE(Contains(run.out, "settling_weight"));
    EXPECT_TRUE(Contains(run.out, "slide steps"));  // --stance
    EXPECT_FALSE(Contains(run.out, "minloglevel"));
    scripts[shell] = run.out;
  }
  EXPECT_TRUE(Contains(scripts["zsh"], "'check:question a fitted model\\: profiles, bootstrap, "));
  EXPECT_TRUE(
      Contains(scripts["zsh"], "--setting=[recordings to use\\: settings of the manifest, comma-"));
  EXPECT_TRUE(Contains(scripts["fish"], "-d 'question a fitted model: profiles, bootstrap, "));
  EXPECT_TRUE(Contains(scripts["fish"], "each recording\\'s effect'"));
  // What bash itself makes of its script.
  const std::string functions = WriteText("functions", scripts["bash"]);
  const auto completed = [&](const std::string& words, int at) {
    const std::string script = "source " + functions + "\nCOMP_WORDS=(" + words +
                               ")\nCOMP_CWORD=" + std::to_string(at) +
                               "\ncompopt() { [[ \"$1 $#\" == \"-o 2\" ]] || echo compopt $*; "
                               "}\n_pushid\necho \"${COMPREPLY[@]}\"\n";
    return RunProgram("/bin/bash", {WriteText("complete.sh", script)});
  };
  EXPECT_EQ(completed("pushid fi", 1).out, "fit\n");
  EXPECT_EQ(completed("pushid fit --settling_", 2).out, "--settling_weight=\n");
  EXPECT_EQ(completed("pushid-fit --stance = ste", 3).out, "steps\n");
  EXPECT_EQ(completed("pushid check --prior", 2).out, "--prior_check\n");
  EXPECT_EQ(completed("pushid-fit --prof", 1).out, "\n") << "a flag that moved";
}

// Every program has its page, which man and groff read without a warning.
TEST_F(FrontTest, PagesOfTheManual) {
  const bool groff = RunProgram("/bin/sh", {"-c", "command -v groff"}).exit_code == 0;
  const bool man = RunProgram("/bin/sh", {"-c", "command -v man"}).exit_code == 0;
  for (const auto& entry : std::filesystem::directory_iterator(PUSHID_BIN_DIR)) {
    const std::string name = entry.path().filename().string();
    const bool study = name.find("study") != std::string::npos || name == "pushid-benchmarks";
    if (name.rfind("pushid", 0) != 0 || study) continue;
    SCOPED_TRACE(name);
    const std::vector<std::string> asked =
        name == "pushid" ? std::vector<std::string>{"man"} : std::vector<std::string>{"man", name};
    const AppRun run = Succeeded(RunApp("pushid", asked));
    const std::string page = WriteText(name + ".1", run.out);
    EXPECT_TRUE(Contains(
        run.out, ".SH NAME\n" + std::regex_replace(name, std::regex("-"), "\\-") + " \\- "));
    if (groff) {
      const AppRun read = Succeeded(
          RunProgram("/bin/sh", {"-c", "groff -man -ww -Tutf8 '" + page + "' >/dev/null"}));
      EXPECT_EQ(read.err, "");
    }
    if (!man || name == "pushid") continue;
    const AppRun read =
        Succeeded(RunProgram("/bin/sh", {"-c", "MANWIDTH=100 man --warnings -l '" + page + "'"}));
    EXPECT_EQ(read.err, "");
    EXPECT_TRUE(Contains(read.out, "--flagfile=FILE"));
  }
  EXPECT_TRUE(Refused(RunApp("pushid", {"man", "fitt"}), {"did you mean 'fit'?"}));
}

}  // namespace
}  // namespace pushid
