// ident: bootstrap over clusters: the fit repeated on people (or recordings) drawn with
// replacement, as many as there are. What errs together is drawn together: all recordings of a
// person, or all frames of a recording (clusters.h). Every replica starts from the estimate; one
// that does not converge from there is tried from the nominal values through all horizons.
//
// Where people share recordings nobody can be drawn alone, and the published groups are all tied
// together: there recordings are drawn, which leaves out what a person does in all of them.
//
// Replica k depends on the seed and k alone, so any number of threads ends with the same rows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"
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
  ClusterBy drawn_by = ClusterBy::kRecording;
  int drawn_from = 0;          // people or recordings to draw from; 0: an older file does not say
  bool people_shared = false;  // recordings were drawn because people share them
};

struct BootstrapOptions {
  int replicas = 199;  // 199 for standard errors; 999 where quantiles matter
  uint64_t seed = 1;
  int num_threads = 1;
  ClusterBy by = ClusterBy::kAuto;  // auto: as standard errors are clustered
};

// Errors: fewer than two people or recordings to draw.
Result<Bootstrap> ComputeBootstrap(const FitProblem& problem, const FitPoint& estimate,
                                   const BootstrapOptions& options,
                                   const JobProgress& progress = nullptr);

// What is drawn: recordings that go together, each in one unit.
struct ResamplingUnits {
  ClusterBy by = ClusterBy::kRecording;
  bool people_shared = false;
  std::vector<std::vector<int>> units;
};
ResamplingUnits MakeResamplingUnits(const std::vector<PendulumRecording>& recordings, ClusterBy by);

// How often each recording is drawn in replica k.
std::vector<int> DrawRecordings(const ResamplingUnits& from, uint64_t seed, int replica);

// The recordings of replica k, those drawn several times standing there several times; of replica 0
// as they are.
std::vector<PendulumRecording> Resampled(const std::vector<PendulumRecording>& recordings,
                                         ClusterBy by, uint64_t seed, int replica);

// Resamples that differ, whatever the order: (2n - 1 choose n) of n units.
inline double DistinctResamples(int units) {
  double number = 1.0;
  for (int i = 1; i < units; ++i) number *= static_cast<double>(units + i) / i;
  return number;
}

}  // namespace pushid
