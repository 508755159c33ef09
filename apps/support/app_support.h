// apps: what every executable does the same way: errors thrown, the threads of the BLAS; no program
// replaces what it reads, nor one of its outputs by another.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "apps/support/log.h"
#include "datasets/files/error.h"
#include "datasets/files/names.h"

namespace pushid {

struct FittedModel;  // ident/model/fitted_model.h

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

// A model's file, with date, host, threads and the seconds since `begin` (of Now()).
MaybeError WriteModelFile(const std::string& path, const FittedModel& model, int num_threads,
                          double begin);

// The threads of the system's BLAS, which sparse normal equations and training ask for
// products; does nothing where the BLAS is another one, or the user has said
// OPENBLAS_NUM_THREADS.
//
// OpenBLAS starts a thread for every core when it is loaded, and these look for work in a loop for
// 0.1 s before they sleep: a third of what a fit of 32 recordings takes, on a core that another job
// may need. Products that threads share also round otherwise, so that results would depend on how
// many cores a machine has.
void SetBlasThreads(int num_threads);

// For programs that train, first of all. An OpenBLAS older than the processor takes its oldest
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

// The files that the output flags name.
class OutputFiles {
 public:
  OutputFiles();

  // Checks an input that no flag names: `reader` is who reads it ("--sensor", "the command line").
  MaybeError CheckNotRead(const std::string& reader, const std::string& path) const;

 private:
  friend MaybeError CheckOutputs();
  struct NamedPath {
    std::string name, path;
    std::string help;  // of the flag
  };
  std::vector<NamedPath> files_;
};

}  // namespace pushid
