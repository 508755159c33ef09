// apps: what every executable does the same way: what it says on stderr while stdout carries the
// result, errors thrown, the threads of the BLAS; no program replaces what it reads, nor one of its
// outputs by another.
//
// Messages are glog's with its severities, progress, Ctrl-C:
//
//   LOG(INFO) << "report written to r.html";   as it is; nothing with --quiet
//   LOG(WARNING) << "no push";                 pushid-fit: warning: no push
//   return Fail("no such file");               LOG(ERROR): pushid-fit: error: no such file
//
// With --v=1 every step of long work is shown, and what the solver logs, which otherwise our own
// messages tell of.
#pragma once

#include <glog/logging.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/names.h"
#include "ident/problem/parallel.h"

namespace pushid {

// The fit failed: also what leaves the model's domain.
inline constexpr int kDone = 0, kBadInput = 1, kFitFailed = 2;

// Called before anything is logged. path: argv[0], whose last part is the name that messages begin
// with.
void StartLog(const char* path);
const std::string& ProgramName();

// Return the code.
int Fail(const std::string& message, int code = kBadInput);
int Fail(const Error& error);
// Warnings that differ only in the recording are printed as one.
void WarnGrouped(const Warnings& warnings);

// Progress of what takes more than a second, on stderr: on a terminal a bar that is redrawn, with
// the elapsed time; elsewhere a line every ten seconds.
class ProgressLine {
 public:
  ~ProgressLine();
  // share: what is done of it; negative: unknown.
  void Show(const std::string& text, double share = -1.0);
  void Finish();  // ends the line; also done by the destructor

  // Progress of many jobs: "recording 3 of 32". The line must outlive it.
  JobProgress OfJobs(const std::string& what);

 private:
  const double begin_ = Now();
  double last_shown_ = begin_;
  size_t width_ = 0;
};

inline constexpr int kInterrupted = 130;  // as shells count SIGINT

// Makes SIGINT end the process with "pushid-fit: interrupted; WHAT". what: what is kept, and
// how to start again; a second call replaces it.
void SayWhenInterrupted(const std::string& what);

// Progress of a training: "window, epoch 12: 43 %, 12 s left", where the time left follows from the
// share done so far. Steps differ in what stands before their last word.
class TrainingLine {
 public:
  void Show(const std::string& step, double done);
  void Finish() { line_.Finish(); }
  double Seconds() const { return Now() - made_; }  // since it was made

 private:
  ProgressLine line_;
  std::string step_;
  double made_ = Now(), start_ = 0.0, done_at_start_ = 0.0;
};

// Returns the value, or throws the Error, which RunApp prints once everything that was open is
// closed. The libraries under the programs return their errors.
template <typename T>
T OrFail(Result<T> result) {
  if (!result.ok()) throw result.error();
  return std::move(result).value();
}
inline void OrFail(const MaybeError& error) {
  if (error) throw *error;
}

std::string Version();

// The threads of the system's BLAS, which sparse normal equations and training ask for
// products; does nothing where the BLAS is another one, or the user has said
// OPENBLAS_NUM_THREADS.
//
// OpenBLAS starts a thread for every core when it is loaded, and these look for work in a loop for
// 0.1 s before they sleep: a third of what a fit of 32 recordings takes, on a core that another job
// may need. Products that threads share also round otherwise, so that results would depend on how
// many cores a machine has.
void SetBlasThreads(int num_threads);

// Called first of all by programs that train. An OpenBLAS older than the processor takes its oldest
// kernels, "Prescott", and training takes twice the time. It chooses when it is loaded, so the
// program starts once more with OPENBLAS_CORETYPE set; nothing where the user has set that.
void RestartWithBlasOfProcessor(char** argv);

// Outputs are known by their flags' names (out, *_out), inputs by the list in
// app_support.cc; so the check holds for every program at once.

// Whether a flag of this name is an output. It is here so that plans are read without flags.
inline bool IsOutputFlag(const std::string& name) {
  return name == "out" || (EndsWith(name, "_out") && name != "leave_out" && name != "held_out");
}

// Checks, before a long run, that the named outputs (not empty) can be written.
MaybeError CheckOutputFiles(std::initializer_list<std::string> files);

// Checks that no output would replace an input or another output. RunApp calls it before anything
// is done.
MaybeError CheckOutputs();

// Checks that no output flag names an input that no flag names: `reader` is who reads it
// ("--sensor", "the command line").
MaybeError CheckNotRead(const std::string& reader, const std::string& path);

}  // namespace pushid
