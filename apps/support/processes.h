// apps: other processes: programs started as children, with their output in files
// (they die with their parent), programs run in place of this one, one process at a time in a
// folder, signals as things to read (Linux).
#pragma once

#include <sys/types.h>

#include <csignal>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

struct ChildSpec {
  std::vector<std::string> command;  // program and arguments
  std::string out, err;              // files; appended to
};

// Errors: the program or a file cannot be opened, no process can be had.
Result<pid_t> StartChild(const ChildSpec& spec);

// The folder of the running program.
std::string OwnFolder();
// Runs a program of pushid, beside the running one or else on the PATH, instead of it, with these
// arguments. Returns only where that fails.
Error RunInstead(const std::string& name, const std::vector<std::string>& arguments);

// A command for a shell, words quoted where they need it.
std::string ShellText(const std::vector<std::string>& command);

struct ChildEnd {
  pid_t pid = 0;
  int exit_code = -1;  // -1: killed
  int signal = 0;
};

// The next child that ended, or one with pid 0 when none has.
ChildEnd NextEnded();

// Kills a child with everything it started.
void KillChild(pid_t pid, int signal);

// A lock that lets one process at a time use a folder. It ends with the process, however that ends,
// and leaves no file. It does not exclude processes on other machines.
class FolderLock {
 public:
  FolderLock() = default;
  FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~FolderLock();

  // Returns false where another process has it. Errors: the folder cannot be opened.
  Result<bool> Take(const std::string& folder);

 private:
  int descriptor_ = -1;
};

// Reads SIGINT, SIGTERM and SIGCHLD. Nothing happens between two calls of Wait: the signals are
// blocked as long as this lives.
class SignalReader {
 public:
  SignalReader() {
    sigemptyset(&taken_);
    for (int number : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&taken_, number);
    sigprocmask(SIG_BLOCK, &taken_, &before_);
  }
  ~SignalReader() {
    Wait(0);  // an interrupt that came twice would end the process where signals are free again
    sigprocmask(SIG_SETMASK, &before_, nullptr);
  }

  // Waits until a child ends, an interrupt comes, or the time is up.
  void Wait(int milliseconds) {
    timespec time{milliseconds / 1000, milliseconds % 1000 * 1000000L};
    for (int taken = sigtimedwait(&taken_, nullptr, &time); taken > 0;
         taken = sigtimedwait(&taken_, nullptr, &time)) {
      if (taken != SIGCHLD) interrupted_ = true;
      time = {};  // what else has come is taken without waiting
    }
  }
  bool interrupted() const { return interrupted_; }

 private:
  sigset_t taken_, before_;
  bool interrupted_ = false;
};

}  // namespace pushid
