// apps: exit codes, errors and warnings, progress.
#include "apps/support/app_support.h"

#include <unistd.h>

#include <cstdio>

#include "ident/problem/parallel.h"

namespace pushid {
namespace {

std::string g_program = "pushid";
bool g_show_progress = true;

}  // namespace

void SetProgramName(const std::string& path) {
  g_program = path.substr(path.find_last_of('/') + 1);
}

const std::string& ProgramName() { return g_program; }

int Fail(const Error& error) { return Fail(error.ToString()); }

int Fail(const std::string& message) {
  std::fprintf(stderr, "%s: error: %s\n", g_program.c_str(), message.c_str());
  return kBadInput;
}

void Warn(const std::string& message) {
  std::fprintf(stderr, "%s: warning: %s\n", g_program.c_str(), message.c_str());
}

std::string Version() { return PUSHID_VERSION; }

std::string HostName() {
  char name[256] = "";
  if (gethostname(name, sizeof name - 1) != 0) return "";
  return name;
}

void HideProgress() { g_show_progress = false; }

ProgressLine::~ProgressLine() { Finish(); }

void ProgressLine::Show(const std::string& text) {
  if (!g_show_progress) return;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const double now = Now();
  if (last_shown_ >= 0.0 && now - last_shown_ < (terminal ? 0.05 : 1.0)) return;
  last_shown_ = now;
  if (!terminal) {
    std::fprintf(stderr, "%s\n", text.c_str());
    return;
  }
  const std::string padding(width_ > text.size() ? width_ - text.size() : 0, ' ');
  std::fprintf(stderr, "\r%s%s", text.c_str(), padding.c_str());
  std::fflush(stderr);
  width_ = text.size();
}

void ProgressLine::Finish() {
  if (width_ > 0) std::fprintf(stderr, "\r%s\r", std::string(width_, ' ').c_str());
  width_ = 0;
}

}  // namespace pushid
