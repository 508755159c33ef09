// apps: pushid: one command in front of all programs: `pushid fit ...` runs `pushid-fit ...`.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "apps/support/app_support.h"
#include "apps/support/processes.h"
#include "datasets/files/names.h"

namespace {

using namespace pushid;

// A program, pushid-NAME, which `pushid NAME` runs.
struct Command {
  const char* job;  // that it is for
  const char* name;
  const char* line;  // its purpose
};
constexpr Command kCommands[] = {
    {"recordings", "inspect", "what is in a file: joints, rate, unit, axes, onset, problems"},
    {"recordings", "manifest", "write down which files belong together"},
    {"recordings", "push", "compute a push from a force sensor, or by inverse dynamics"},
    {"recordings", "simulate", "make recordings of synthetic people, alone or in groups"},
    {"identification", "fit", "identify the parameters of a model from recordings"},
    {"identification", "check",
     "question a fitted model: profiles, bootstrap, other pushes and priors"},
    {"identification", "report", "a model in words and tables, or as a page"},
    {"identification", "evaluate", "errors of a model on recordings"},
    {"identification", "crossvalidate",
     "errors of models on recordings that they were not fitted to"},
    {"identification", "batch", "many fits from a plan"},
    {"prediction", "predict", "the motion after a push"},
    {"prediction", "animate", "a page of moving bodies, forces told in words"},
    {"prediction", "formation", "how far a push travels through people who stand together"},
    {"prediction", "path", "the most probable motion between two ends, or through a recording"},
    {"learned parts", "train-restoration", "learn whole bodies from pendulums"},
    {"learned parts", "train-generator", "learn to generate motion"},
    {"learned parts", "generate", "motion from a generator, and its scores"},
};

int Help() {
  std::printf("pushid COMMAND [flags] runs the program pushid-COMMAND.\n");
  std::string job;
  for (const Command& command : kCommands) {
    if (job != command.job) std::printf("\n%s:\n", command.job);
    job = command.job;
    std::printf("  %-18s %s\n", command.name, command.line);
  }
  std::printf(
      "\npushid help COMMAND shows an example of one, which works where apps/quickstart.sh wrote "
      "its "
      "files,\nand its flags; pushid --version prints the version.\n");
  return kDone;
}

// word: a command, or its program's name.
int Run(const std::string& word, const std::vector<std::string>& arguments) {
  const std::string command = word.rfind("pushid-", 0) == 0 ? word.substr(7) : word;
  std::vector<std::string> known = {"help"};
  for (const Command& one : kCommands) {
    if (one.name == command) return Fail(RunInstead("pushid-" + command, arguments));
    known.push_back(one.name);
  }
  std::string meant = ClosestName(command, known);
  for (const std::string& one : known) {  // "fitt" and "sim"
    const bool begins = command.rfind(one, 0) == 0 || one.rfind(command, 0) == 0;
    if (meant.empty() && begins && !command.empty()) meant = one;
  }
  return Fail("there is no command '" + word + "'; " +
              (meant.empty() ? "" : "did you mean '" + meant + "'? Or ") + "see pushid help");
}

}  // namespace

int main(int argc, char** argv) {
  StartLog(argv[0]);
  const std::string command = argc > 1 ? argv[1] : "help";
  const std::vector<std::string> arguments(argv + std::min(argc, 2), argv + argc);
  if (command == "--version") {
    std::printf("pushid %s\n", Version().c_str());
    return kDone;
  }
  if (command == "help" || command == "--help" || command == "-h") {
    const bool all = arguments.empty() || arguments[0] == "help";
    return all ? Help() : Run(arguments[0], {"--help"});
  }
  return Run(command, arguments);
}
