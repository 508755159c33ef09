// apps: other processes: programs started as children, with their output in files and their limits
// (they die with their parent), programs run in place of this one, one process at a time in a
// folder, signals as things to read (Linux).
#pragma once

#include <poll.h>
#include <sys/signalfd.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <utility>
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
    descriptor_ = signalfd(-1, &taken_, SFD_NONBLOCK | SFD_CLOEXEC);
  }
  ~SignalReader() {
    Wait(0);  // an interrupt that came twice would end the process where signals are free again
    close(descriptor_);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
  }

  // Waits until a child ends, an interrupt comes, or the time is up.
  void Wait(int milliseconds) {
    pollfd waiting{descriptor_, POLLIN, 0};
    poll(&waiting, 1, milliseconds);
    signalfd_siginfo info;
    while (read(descriptor_, &info, sizeof info) == sizeof info) {
      if (info.ssi_signo != SIGCHLD) interrupted_ = true;
    }
  }
  bool interrupted() const { return interrupted_; }

 private:
  sigset_t taken_, before_;
  int descriptor_ = -1;
  bool interrupted_ = false;
};

}  // namespace pushid
