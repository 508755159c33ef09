// How often do the 95 % intervals cover the truth when people do not push back twice the same way?
//
//   pushid-coverage-study --datasets=1000 --refined=200 --num_threads=2
//
// Every data set holds 32 recordings (4 people, 8 pushes each) whose gains vary from recording to
// recording by the factor exp(spread N), so that all frames of a recording err together and naive
// intervals fail. Priors, settling and stability are off. All data sets get clustered and naive
// intervals, the first `refined` also profile and bootstrap ones. A run of many minutes, not a unit
// test; tests/studies/coverage.py makes a table of what it found.
#include <gflags/gflags.h>

#include <cmath>
#include <cstdio>
#include <mutex>

#include "ident/figures/text_table.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/parallel.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/bootstrap.h"
#include "ident/uncertainty/profile.h"
#include "tests/ident/fit_samples.h"
#include "tests/studies/study.h"

DEFINE_int32(datasets, 1000, "data sets with clustered and naive intervals");
DEFINE_int32(refined, 200, "data sets, the first ones, with profile and bootstrap intervals too");
DEFINE_int32(replicas, 199, "of the bootstrap");
DEFINE_double(spread, 0.1, "of the gains between recordings, on a log scale");
DEFINE_double(noise, 0.001, "of hip and ankles, m");
DEFINE_uint64(seed, 1, "of the first data set; the others follow");
DEFINE_int32(num_threads, 2, "threads");

namespace pushid {
namespace {

// By kind of interval, how many held the truth.
struct Tally {
  int clustered = 0, naive = 0, datasets = 0, profile = 0, bootstrap = 0, refined = 0;
  double mean = 0.0, squares = 0.0, error = 0.0;  // of estimate - truth; of the stated errors
};

SyntheticOptions Study(int dataset) {
  SyntheticOptions study;
  study.subjects = 4;
  study.recordings_per_subject = 8;
  study.frames = 70;
  study.recording_spread = FLAGS_spread;
  study.joint_noise_m = FLAGS_noise;
  study.noise_at_first_frame = false;  // errors in rod and posture are another study
  study.seed = FLAGS_seed * 100000 + static_cast<uint64_t>(dataset);
  return study;
}

void Judge(int dataset, std::mutex* mutex, std::vector<Tally>* tallies) {
  const SyntheticOptions study = Study(dataset);
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  options.sigmas = ResidualSigmas();  // the robust loss as a user has it
  const FitProblem problem(recordings, options);
  const Solution solution = Solve(problem);
  if (!solution.ok()) return;
  const FitPoint& estimate = solution.start.to;
  const Uncertainty uncertainty = ComputeUncertainty(problem, estimate);

  const bool refined = dataset < FLAGS_refined;
  std::vector<Profile> profiles;
  Bootstrap bootstrap;
  if (refined) {
    profiles = ComputeProfiles(problem, estimate, uncertainty, {}, 1).value();
    BootstrapOptions asked;
    asked.replicas = FLAGS_replicas;
    asked.seed = study.seed;
    bootstrap = ComputeBootstrap(problem, estimate, asked).value();
  }
  const std::lock_guard<std::mutex> lock(*mutex);
  for (size_t p = 0; p < tallies->size(); ++p) {
    const double truth = study.parameters[problem.map().fitted[p].parameter];
    const Estimate& e = uncertainty.estimates[p];
    const auto holds = [truth](double lower, double upper) {
      return lower <= truth && truth <= upper;
    };
    Tally& tally = (*tallies)[p];
    ++tally.datasets;
    tally.clustered += holds(e.lower95, e.upper95);
    const double naive = 1.96 * e.standard_error_naive;
    tally.naive += holds(e.value - naive, e.value + naive);
    tally.mean += e.value - truth;
    tally.squares += (e.value - truth) * (e.value - truth);
    tally.error += e.standard_error;
    if (!refined) continue;
    ++tally.refined;
    tally.profile += holds(profiles[p].lower95, profiles[p].upper95);
    tally.bootstrap += holds(bootstrap.lower95[p], bootstrap.upper95[p]);
  }
}

int Run() {
  const std::vector<Parameter> free = UnbiasedFit(Study(0)).table.Free();
  std::vector<Tally> tallies(free.size());
  std::mutex mutex;
  ParallelFor(
      FLAGS_datasets, FLAGS_num_threads, [&](int i) { Judge(i, &mutex, &tallies); },
      [](int done, int total) {
        if (done % 50 == 0) std::fprintf(stderr, "data set %d of %d\n", done, total);
      });
  TextTable table({"coverage, %", ">clustered", ">naive", ">profile", ">bootstrap",
                   ">bias / spread", ">stated / real error"});
  for (size_t p = 0; p < free.size(); ++p) {
    const Tally& t = tallies[p];
    const double n = std::max(1, t.datasets);
    const double bias = t.mean / n;
    const double spread = std::sqrt(std::max(0.0, t.squares / n - bias * bias));
    char ratio[2][16];
    std::snprintf(ratio[0], sizeof ratio[0], "%.2f", bias / spread);
    std::snprintf(ratio[1], sizeof ratio[1], "%.2f", t.error / n / spread);
    table.Add({std::string(kParameterNames[free[p]]), Percent(t.clustered, t.datasets),
               Percent(t.naive, t.datasets), Percent(t.profile, t.refined),
               Percent(t.bootstrap, t.refined), ratio[0], ratio[1]});
  }
  std::printf(
      "%s%d data sets, %d with profile and bootstrap (%d replicas); spread %g, noise %g m, "
      "seed %d\n",
      table.ToString().c_str(), tallies[0].datasets, tallies[0].refined, FLAGS_replicas,
      FLAGS_spread, FLAGS_noise, static_cast<int>(FLAGS_seed));
  return 0;
}

}  // namespace
}  // namespace pushid

int main(int argc, char** argv) {
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  return pushid::Run();
}
