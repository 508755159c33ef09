// ident: bootstrap over recordings: the fit repeated on recordings drawn with replacement, as many
// as there are. Whole recordings are drawn because the frames of one err together. Every replica
// starts from the estimate; one that does not converge from there is tried from the nominal values
// through all horizons.
//
// Replica k depends on the seed and k alone, so a run may be interrupted and resumed, in any number
// of threads, and ends with the same rows. The file holds one line of JSON per replica after a
// header that says what was fitted; a line cut short by a kill is dropped.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/problem/fit_point.h"
#include "ident/problem/parallel.h"

namespace pushid {

class FitProblem;

struct Bootstrap {
  int replicas = 0;  // asked for
  uint64_t seed = 0;
  int failed = 0;                           // did not converge; they are in no row
  std::vector<std::string> names, units;    // free parameters, then derived combinations that move
  std::vector<std::vector<double>> values;  // one row per good replica, natural units
  // By parameter: standard deviation over replicas, and their 2.5 and 97.5 % quantiles.
  std::vector<double> standard_error, lower95, upper95;
};

struct BootstrapOptions {
  int replicas = 199;  // 199 for standard errors; 999 where quantiles matter
  uint64_t seed = 1;
  std::string file;  // keeps finished replicas; empty: nothing is kept
  int num_threads = 1;
};

// Errors: fewer than two recordings, a file that cannot be used or belongs to another fit.
Result<Bootstrap> ComputeBootstrap(const FitProblem& problem, const FitPoint& estimate,
                                   const BootstrapOptions& options,
                                   const JobProgress& progress = nullptr);

// How often each of `total` recordings is drawn in replica k.
std::vector<int> DrawRecordings(int total, uint64_t seed, int replica);

// Linear between the sorted values, the i-th of n standing for i / (n + 1).
double Quantile(std::vector<double> values, double share);

}  // namespace pushid
