// apps: pushid: one command in front of all programs: `pushid fit ...` runs `pushid-fit ...`.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/completion.h"
#include "apps/flags/command_line.h"
#include "apps/support/app_support.h"
#include "apps/support/processes.h"
#include "datasets/files/names.h"
#include "ident/model/model_json.h"

namespace {

using namespace pushid;

struct Job {
  const char* title;
  std::vector<Command> commands;
};

// Every program, by the job that it is for.
const std::vector<Job>& Jobs() {
  static const std::vector<Job> jobs = {
      {"recordings",
       {{"inspect", "what is in a file: joints, rate, unit, axes, onset, problems"},
        {"manifest", "write down which files belong together"},
        {"push", "compute a push from a force sensor, or by inverse dynamics"},
        {"simulate", "make recordings of synthetic people, alone or in groups"},
        {"export", "write recordings as Motion-BIDS or for PedPy"}}},
      {"identification",
       {{"fit", "identify the parameters of a model from recordings"},
        {"check", "question a fitted model: profiles, bootstrap, other pushes and priors"},
        {"report", "a model in words and tables, or as a page"},
        {"evaluate", "errors of a model on recordings"},
        {"crossvalidate", "errors of models on recordings that they were not fitted to"},
        {"batch", "many fits from a plan"}}},
      {"prediction",
       {{"predict", "the motion after a push"},
        {"animate", "a page of moving bodies, forces told in words"},
        {"formation", "how far a push travels through people who stand together"},
        {"path", "the most probable motion between two ends, or through a recording"}}},
      {"learned parts",
       {{"train-restoration", "learn whole bodies from pendulums"},
        {"train-generator", "learn to generate motion"},
        {"generate", "motion from a generator, and its scores"}}},
  };
  return jobs;
}

std::vector<Command> AllCommands() {
  std::vector<Command> all;
  for (const Job& job : Jobs()) all.insert(all.end(), job.commands.begin(), job.commands.end());
  return all;
}

int Help() {
  std::printf("pushid COMMAND [flags] runs the program pushid-COMMAND.\n");
  for (const Job& job : Jobs()) {
    std::printf("\n%s:\n", job.title);
    for (const Command& command : job.commands) {
      std::printf("  %-18s %s\n", command.name.c_str(), command.line.c_str());
    }
  }
  std::printf(
      "\npushid help COMMAND lists the flags of one; pushid completion bash|zsh|fish prints a "
      "script for\nthe shell; pushid man COMMAND prints a page of the manual; pushid schema prints "
      "the JSON Schema of a model's file; pushid "
      "--version prints the "
      "version.\n");
  return kDone;
}

// word: a command, or its program's name.
int Run(const std::string& word, const std::vector<std::string>& arguments) {
  const std::string command = word.rfind("pushid-", 0) == 0 ? word.substr(7) : word;
  std::vector<std::string> known = {"help", "completion", "man", "schema"};
  bool found = false;
  for (const Command& one : AllCommands()) {
    known.push_back(one.name);
    found = found || one.name == command;
  }
  if (found) return Fail(RunInstead("pushid-" + command, arguments));
  std::string meant = MeantBy(command, known);
  for (const std::string& one : known) {  // "fitt" and "sim"
    const bool begins = command.rfind(one, 0) == 0 || one.rfind(command, 0) == 0;
    if (meant.empty() && begins && !command.empty()) meant = one;
  }
  return Fail("there is no command '" + word + "'; " +
              (meant.empty() ? "" : "did you mean '" + meant + "'? Or ") + "see pushid help");
}

int HelpOn(const std::string& command) {
  if (command == "help") return Help();
  if (command != "completion") return Run(command, {"--help"});
  std::printf("%s", CompletionHelp().c_str());
  return kDone;
}

// The manual's page of one command, or of all.
int Manual(const std::vector<std::string>& arguments) {
  if (!arguments.empty()) return Run(arguments[0], {kManPage});
  std::vector<HelpSection> sections;
  for (const Job& job : Jobs()) {
    sections.push_back({job.title, {}});
    for (const Command& command : job.commands) {
      sections.back().entries.push_back({command.name, command.line});
    }
  }
  sections.push_back({"about pushid",
                      {{"help COMMAND", "the flags of a command"},
                       {"man COMMAND", "its page of the manual, for man -l -"},
                       {"completion bash|zsh|fish", "a script for the shell"},
                       {"schema", "the JSON Schema of a model's file"},
                       {"--version", "the version"}}});
  std::printf("%s", ManPage("pushid estimates how people balance and recover from pushes, from "
                            "motion capture.\npushid COMMAND [flags] runs the program "
                            "pushid-COMMAND, which has a page of its own.\n\n"
                            "  pushid fit --recordings=M/manifest.json --model_out=model.json",
                            "COMMAND [--flag=value ...]", "COMMANDS", sections)
                        .c_str());
  return kDone;
}

int Complete(const std::vector<std::string>& arguments) {
  if (!arguments.empty() && (arguments[0] == "--help" || arguments[0] == "-h")) {
    return HelpOn("completion");
  }
  if (arguments.size() != 1) return Fail("name the shell: pushid completion bash, zsh or fish");
  const Result<std::string> script = CompletionScript(arguments[0], AllCommands());
  if (!script.ok()) return Fail(script.error());
  std::printf("%s", script.value().c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  SetProgramName(argv[0]);
  std::string command = argc > 1 ? argv[1] : "help";
  const std::vector<std::string> arguments(argv + std::min(argc, 2), argv + argc);
  if (command == "--version") {
    std::printf("pushid %s\n", Version().c_str());
    return kDone;
  }
  if (command == "help" || command == "--help" || command == "-h") {
    return arguments.empty() ? Help() : HelpOn(arguments[0]);
  }
  if (command == "schema") {
    if (!arguments.empty() && arguments[0] != "model") {
      return Fail(
          "pushid schema prints the schema of a model's file alone; those of other files are "
          "in share/pushid/schemas (in the source: apps/schemas)");
    }
    std::printf("%s\n", ModelSchema().dump(1).c_str());
    return kDone;
  }
  if (command == "man") return Manual(arguments);
  return command == "completion" ? Complete(arguments) : Run(command, arguments);
}
