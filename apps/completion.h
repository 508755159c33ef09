// apps: shell completion of every program, from the programs' own tables of flags.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

// A program, pushid-NAME; `pushid NAME` runs it.
struct Command {
  std::string name;
  std::string line;  // what it does
};

// What `pushid help completion` prints: how each shell takes its script.
std::string CompletionHelp();

// A script for bash, zsh or fish that completes commands, flags and the words that flags take.
// Programs that are not installed are left out. Errors: another shell; a program that cannot be
// asked.
Result<std::string> CompletionScript(const std::string& shell,
                                     const std::vector<Command>& commands);

}  // namespace pushid
