// apps: what programs say on stderr while stdout carries the result: glog with its severities,
// progress, Ctrl-C.
//
//   LOG(INFO) << "report written to r.html";   as it is; nothing with --quiet
//   LOG(WARNING) << "no push";                 pushid-fit: warning: no push
//   return Fail("no such file");               LOG(ERROR): pushid-fit: error: no such file
//
// With --v=1 every step of long work is shown, and what the solver logs, which otherwise our own
// messages tell of.
#pragma once

#include <glog/logging.h>

#include <string>

#include "datasets/files/error.h"
#include "ident/problem/parallel.h"

namespace pushid {

// The fit failed: also what leaves the model's domain.
inline constexpr int kDone = 0, kBadInput = 1, kFitFailed = 2;

// Before anything is logged. path: argv[0], whose last part is the name that messages begin with.
void StartLog(const char* path);
const std::string& ProgramName();

// Return the code.
int Fail(const std::string& message, int code = kBadInput);
int Fail(const Error& error);
// Warnings that differ only in the recording are printed as one.
void WarnGrouped(const Warnings& warnings);

// One line that is redrawn on a terminal, plain lines (at most one a second) elsewhere; on stderr.
class ProgressLine {
 public:
  ~ProgressLine();
  void Show(const std::string& text);
  void Finish();  // ends the line; also done by the destructor

  // Progress of many jobs: "recording 3 of 32". The line must outlive it.
  JobProgress OfJobs(const std::string& what);

 private:
  double last_shown_ = -1.0;
  size_t width_ = 0;
};

inline constexpr int kInterrupted = 130;  // as shells count SIGINT

// From now on SIGINT ends the process with "pushid-fit: interrupted; WHAT". what: what is kept, and
// how to start again; a second call replaces it.
void SayWhenInterrupted(const std::string& what);

// The message of a training into this folder that Ctrl-C stops.
std::string KeptCheckpoints(const std::string& folder);

// Progress of a training: "window, epoch 12: 43 %, 12 s left", where the time left follows from the
// share done so far. Steps differ in what stands before their last word.
class TrainingLine {
 public:
  TrainingLine();
  void Show(const std::string& step, double done);
  void Finish() { line_.Finish(); }
  double Seconds() const;  // since it was made

 private:
  ProgressLine line_;
  std::string step_;
  double made_, start_ = 0.0, done_at_start_ = 0.0;
};

}  // namespace pushid
