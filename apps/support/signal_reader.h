// apps: SIGINT, SIGTERM and SIGCHLD as things to read (Linux).
#pragma once

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

namespace pushid {

// Nothing happens between two looks: the signals are blocked as long as this lives.
class SignalReader {
 public:
  SignalReader() {
    sigemptyset(&taken_);
    for (int number : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&taken_, number);
    sigprocmask(SIG_BLOCK, &taken_, &before_);
    descriptor_ = signalfd(-1, &taken_, SFD_NONBLOCK | SFD_CLOEXEC);
  }
  ~SignalReader() {
    close(descriptor_);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
  }

  // Until a child ends, an interrupt comes, or the time is up.
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
