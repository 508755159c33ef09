// ident: what a fit spends, and on what: evaluations of its problem, and time.
#pragma once

#include <string>
#include <vector>

#include "ident/problem/parallel.h"

namespace pushid {

// Evaluations of all residual blocks of a problem.
struct Evaluations {
  int jacobians = 0;  // residuals and their Jacobian
  int costs = 0;      // residuals alone
};

// Counts evaluations that are about to be made, in any thread.
void CountEvaluations(const Evaluations& more);
// The sum over all threads of the process so far.
Evaluations EvaluationsSoFar();

struct Work {
  std::string purpose;  // "start", "horizons", "weights", ...
  Evaluations evaluations;
  double seconds = 0.0;
};

// Splits the time from its construction on by purpose. Where several fits run at a time their
// evaluations are counted together.
class WorkLog {
 public:
  // Adds what was spent since the last call, or since construction, to a purpose.
  void Add(const std::string& purpose);
  const std::vector<Work>& parts() const { return parts_; }  // in order of their first mention

 private:
  std::vector<Work> parts_;
  Evaluations from_ = EvaluationsSoFar();
  double since_ = Now();
};

}  // namespace pushid
