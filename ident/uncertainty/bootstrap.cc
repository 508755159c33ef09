// ident: replicas and what they say.
#include "ident/uncertainty/bootstrap.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "datasets/files/random.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/bootstrap_file.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {
namespace {

// The combinations that move with a free parameter.
std::vector<CombinationSpec> MovingCombinations(const FitProblem& problem) {
  std::vector<CombinationSpec> moving;
  for (const CombinationSpec& spec : DerivedCombinations(problem.options().model)) {
    const bool moves = std::any_of(
        spec.terms.begin(), spec.terms.end(),
        [&problem](const Term& term) { return problem.options().table[term.parameter].free; });
    if (moves) moving.push_back(spec);
  }
  return moving;
}

ReplicaValues ValuesAt(const FitProblem& problem, const FitPoint& point,
                       const std::vector<CombinationSpec>& combinations) {
  const ParameterSet<double> parameters = problem.Parameters(point, "");
  ReplicaValues values;
  for (const FittedParameter& f : problem.map().fitted) values.push_back(parameters[f.parameter]);
  for (const CombinationSpec& spec : combinations) {
    double sum = 0.0;
    for (const Term& term : spec.terms) sum += term.coefficient * parameters[term.parameter];
    values.push_back(sum);
  }
  return values;
}

ReplicaValues FitReplica(const FitProblem& problem, const FitPoint& estimate, uint64_t seed,
                         int replica, const std::vector<CombinationSpec>& combinations) {
  const int total = static_cast<int>(problem.recordings().size());
  FitOptions options = problem.options();
  options.num_threads = 1;
  const FitProblem drawn(problem.recordings(), options, DrawRecordings(total, seed, replica));
  SolveStart fit = Refit(drawn, estimate);
  if (!fit.usable) fit = SolveFrom(drawn, drawn.NominalPoint(), "nominal", "", nullptr);
  if (!fit.converged || !fit.failed.empty()) return {};
  return ValuesAt(drawn, fit.to, combinations);
}

void Summarize(Bootstrap* bootstrap) {
  const size_t rows = bootstrap->values.size();
  for (size_t p = 0; p < bootstrap->names.size(); ++p) {
    std::vector<double> column;
    for (const std::vector<double>& row : bootstrap->values) column.push_back(row[p]);
    double mean = 0.0, squares = 0.0;
    for (double value : column) mean += value / static_cast<double>(rows);
    for (double value : column) squares += (value - mean) * (value - mean);
    bootstrap->standard_error.push_back(std::sqrt(squares / std::max(1.0, rows - 1.0)));
    bootstrap->lower95.push_back(Quantile(column, 0.025));
    bootstrap->upper95.push_back(Quantile(column, 0.975));
  }
}

}  // namespace

std::vector<int> DrawRecordings(int total, uint64_t seed, int replica) {
  Random random(seed * 1000003u + static_cast<uint64_t>(replica));
  std::vector<int> counts(total, 0);
  for (int i = 0; i < total; ++i) {
    ++counts[std::min(total - 1, static_cast<int>(random.Unit() * total))];
  }
  return counts;
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double last = static_cast<double>(values.size()) - 1.0;
  const double at = std::clamp(share * static_cast<double>(values.size() + 1) - 1.0, 0.0, last);
  const size_t below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

Result<Bootstrap> ComputeBootstrap(const FitProblem& problem, const FitPoint& estimate,
                                   const BootstrapOptions& options, const JobProgress& progress) {
  if (problem.recordings().size() < 2) {
    return Error{"a bootstrap over recordings needs at least two of them"};
  }
  const std::vector<CombinationSpec> combinations = MovingCombinations(problem);
  Bootstrap bootstrap;
  bootstrap.replicas = options.replicas;
  bootstrap.seed = options.seed;
  for (const FittedParameter& f : problem.map().fitted) {
    bootstrap.names.push_back(problem.options().table[f.parameter].name);
    bootstrap.units.push_back(problem.options().table[f.parameter].unit);
  }
  for (const CombinationSpec& spec : combinations) {
    bootstrap.names.push_back(spec.name);
    bootstrap.units.push_back(spec.unit);
  }

  BootstrapFile file;
  if (MaybeError error = file.Open(problem, options, bootstrap.names)) return *error;
  std::vector<ReplicaValues> replicas(options.replicas);
  std::mutex writing;
  std::atomic<bool> stopped{false};
  MaybeError failed;
  ParallelFor(
      options.replicas, options.num_threads,
      [&](int k) {
        if (stopped) return;
        const auto kept = file.finished().find(k);
        if (kept != file.finished().end()) {
          replicas[k] = kept->second;
          return;
        }
        replicas[k] = FitReplica(problem, estimate, options.seed, k, combinations);
        const std::lock_guard<std::mutex> lock(writing);
        if (stopped) return;
        failed = file.Append(k, replicas[k]);
        stopped = failed.has_value();
      },
      progress);
  if (failed) return *failed;
  for (const ReplicaValues& values : replicas) {
    if (values.empty()) {
      ++bootstrap.failed;
    } else {
      bootstrap.values.push_back(values);
    }
  }
  Summarize(&bootstrap);
  return bootstrap;
}

}  // namespace pushid
