// pushid in front of the programs: commands, help, misspelt commands.
#include <gtest/gtest.h>

#include <filesystem>
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
  EXPECT_TRUE(Contains(fit.out, "model.json"));
  EXPECT_TRUE(Refused(RunApp("pushid", {"fit"}), {"pushid-fit: error: --recordings is missing"}));
  EXPECT_TRUE(Contains(RunApp("pushid", {"--version"}).out, "pushid 0."));
  EXPECT_EQ(RunApp("pushid", {"pushid-fit", "--version"}).out,
            RunApp("pushid-fit", {"--version"}).out);
  EXPECT_EQ(RunApp("pushid", {"help", "help"}).out, RunApp("pushid", {"help"}).out);
}

TEST_F(FrontTest, MisspeltCommands) {
  EXPECT_TRUE(Refused(RunApp("pushid", {"reprot"}), {"'reprot'", "did you mean 'report'?"}));
  EXPECT_TRUE(Refused(RunApp("pushid", {"help", "fitt"}), {"did you mean 'fit'?"}));
  EXPECT_TRUE(Refused(RunApp("pushid", {"--fit"}), {"'--fit'", "pushid help"}));
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

}  // namespace
}  // namespace pushid
