// ident: fits of fewer frames.
#include "ident/uncertainty/horizon_check.h"

#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {
namespace {

template <typename T>
void Cut(int frames, std::vector<std::vector<T>>* people) {
  for (std::vector<T>& person : *people) {
    if (static_cast<int>(person.size()) > frames) person.resize(frames);
  }
}

// The pushes stay whole: a tail knows the mean of its push.
std::vector<PendulumRecording> FirstFrames(std::vector<PendulumRecording> recordings, int frames) {
  for (PendulumRecording& r : recordings) {
    Cut(frames, &r.states);
    Cut(frames, &r.rod_length);
    Cut(frames, &r.hip);
    Cut(frames, &r.weight);
  }
  return recordings;
}

RefitRow FitFirst(const FitProblem& whole, int frames) {
  RefitRow row{"horizon", std::to_string(frames) + " frames", {}, {}, "", frames};
  // Frame 0 and the steps to `frames`.
  const std::vector<PendulumRecording> first = FirstFrames(whole.recordings(), frames + 1);
  FitOptions options = whole.options();
  options.num_threads = 1;
  const FitProblem problem(first, options);
  const Solution solution = Solve(problem);
  if (solution.best < 0) {
    row.failure = "no start could be solved";
    return row;
  }
  Take(problem, solution.Best(), &row);
  if (row.value.empty()) return row;
  const Uncertainty uncertainty = ComputeUncertainty(problem, solution.Best().to);
  for (size_t i = 0; i < row.value.size(); ++i) {
    row.standard_error.push_back(uncertainty.estimates[i].standard_error);
  }
  return row;
}

}  // namespace

RefitTable CheckHorizons(const FitProblem& problem, const FitPoint& estimate,
                         const Uncertainty& uncertainty, int num_threads,
                         const JobProgress& progress) {
  int longest = 0;
  for (const PendulumRecording& r : problem.recordings()) {
    longest = std::max(longest, r.num_frames() - 1);
  }
  std::vector<int> horizons;
  for (int horizon : problem.options().horizons) {
    if (horizon > 0 && horizon < longest) horizons.push_back(horizon);
  }
  std::sort(horizons.begin(), horizons.end());
  RefitTable table = RefitTableOf(problem, estimate, uncertainty);
  table.rows.resize(horizons.size());
  ParallelFor(
      static_cast<int>(horizons.size()), num_threads,
      [&](int i) { table.rows[i] = FitFirst(problem, horizons[i]); }, progress);
  return table;
}

}  // namespace pushid
