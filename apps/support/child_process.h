// apps: a program started as a child: its output in files, its limits, how it ended. The child dies
// with its parent (Linux).
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

struct ChildSpec {
  std::vector<std::string> command;  // program and arguments
  std::string out, err;              // files; appended to
  int memory_limit_mb = 0;           // of address space; 0: none
};

// Errors: the program or a file cannot be opened, no process can be had.
Result<pid_t> StartChild(const ChildSpec& spec);

// The folder of the running program.
std::string OwnFolder();
// Where a program of pushid is: beside the running one, else on the PATH; empty: nowhere.
std::string FindProgram(const std::string& name);
// Runs it instead of the running one, with these arguments. Returns only where that fails.
Error RunInstead(const std::string& name, const std::vector<std::string>& arguments);

// What a command prints on stdout; errors: it cannot be started, or fails.
Result<std::string> OutputOf(const std::vector<std::string>& command);

// A command as a shell takes it, every word quoted.
std::string ShellText(const std::vector<std::string>& command);

// How a child ended.
struct ChildEnd {
  pid_t pid = 0;
  int exit_code = -1;  // -1: killed
  int signal = 0;
};

// The next child that ended, or one with pid 0 when none has.
ChildEnd NextEnded();

// With everything it started.
void KillChild(pid_t pid, int signal);

}  // namespace pushid
