// apps: what every executable does the same way: flags, help, exit codes, progress.
//
// stdout carries the result, stderr log and progress. Exit codes: 0 done, 1 bad usage or data, 2
// the fit failed.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

inline constexpr int kDone = 0, kBadInput = 1, kFitFailed = 2;

// Parses flags (--help and --version answer themselves), refuses outputs that would replace an
// input or each other, then calls run. usage: one paragraph and an example. Words that are no flags
// go to `words`; without it they are an error.
int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words = nullptr);

// "pushid-fit: error: ..." on stderr; returns kBadInput.
int Fail(const Error& error);
int Fail(const std::string& message);
void Warn(const std::string& message);

// "--recordings is missing ..." when a flag that is needed is empty.
MaybeError Require(const std::string& flag, const std::string& value, const std::string& what);

// Whether a flag was given at all, even with its default's value.
bool Given(const char* flag);

// The effective flags of this executable that are part of a result: not outputs, threads,
// verbosity.
std::map<std::string, std::string> EffectiveFlags();

// Names of those that are not at their defaults.
std::vector<std::string> ChangedFlags();

std::string Version();
std::string HostName();

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
