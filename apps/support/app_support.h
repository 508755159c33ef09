// apps: what every executable does the same way: exit codes, errors and warnings, progress.
//
// stdout carries the result, stderr log and progress. Exit codes: 0 done, 1 bad usage or data, 2
// the fit failed.
#pragma once

#include <string>

#include "datasets/files/error.h"

namespace pushid {

inline constexpr int kDone = 0, kBadInput = 1, kFitFailed = 2;

// The program's name, as messages begin with it; path: argv[0].
void SetProgramName(const std::string& path);
const std::string& ProgramName();

// "pushid-fit: error: ..." on stderr; returns kBadInput.
int Fail(const Error& error);
int Fail(const std::string& message);
void Warn(const std::string& message);

std::string Version();
std::string HostName();

// No ProgressLine shows anything from now on (--quiet).
void HideProgress();

// One line that is redrawn on a terminal, plain lines (at most one a second) elsewhere; on stderr.
class ProgressLine {
 public:
  ~ProgressLine();
  void Show(const std::string& text);
  void Finish();  // ends the line; also done by the destructor

 private:
  double last_shown_ = -1.0;
  size_t width_ = 0;
};

}  // namespace pushid
