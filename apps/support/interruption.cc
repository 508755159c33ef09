// apps: Ctrl-C.
#include "apps/support/interruption.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>

#include "apps/support/app_support.h"

namespace pushid {
namespace {

// A handler may neither allocate nor lock: the message stands ready. Old ones are kept, as the
// signal may come while one is replaced; there are three at most.
std::atomic<const char*> g_message{nullptr};

void End(int) {
  const char* message = g_message.load();
  const ssize_t ignored = write(STDERR_FILENO, message, std::strlen(message));
  static_cast<void>(ignored);
  _exit(kInterrupted);
}

}  // namespace

void SayWhenInterrupted(const std::string& what) {
  const auto* text = new std::string("\n" + ProgramName() + ": interrupted; " + what + "\n");
  g_message.store(text->c_str());
  struct sigaction ending = {};
  ending.sa_handler = End;
  sigaction(SIGINT, &ending, nullptr);
}

}  // namespace pushid
