// ident: replicas and what they say.
#include "ident/uncertainty/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/problem/statistics.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {
namespace {

// Function tolerance: what a smaller one would change is a hundredth of what replicas differ by.
constexpr double kReplicaTolerance = 1e-6;

// The sums of each recording's rows at the estimate, so that no replica need evaluate them there;
// empty where replicas are not solved by such sums.
std::vector<RecordingSums> SumEach(const FitProblem& problem, FitPoint estimate) {
  if (problem.options().likelihood != Likelihood::kTrajectory) return {};
  const FitProblem::Built built = problem.Build(&estimate, 0);
  if (!built.shortened.empty()) return {};
  const ResidualRows score = EvaluateRows(built);
  if (score.jacobian.cols() > kDenseColumns) return {};
  std::vector<RecordingSums> each;
  for (int i = 0; i < static_cast<int>(problem.recordings().size()); ++i) {
    each.push_back(SumRows(score, estimate, score.RowsOf(i)));
  }
  return each;
}

// The sum over the recordings as a replica counts them; none counts those that the fit leaves out.
RecordingSums SumAsDrawn(const std::vector<RecordingSums>& each, const FitProblem& drawn) {
  if (each.empty()) return {};
  RecordingSums all{each[0].at, 0.0, SecondOrder::Zero(each[0].at.size())};
  for (size_t i = 0; i < each.size(); ++i) {
    const int count = drawn.Count(static_cast<int>(i));
    all.squares += count * each[i].squares;
    all.sums.information += count * each[i].sums.information;
    all.sums.gradient += count * each[i].sums.gradient;
  }
  return all;
}

// Free parameters, then combinations; empty for a fit that failed.
std::vector<double> FitReplica(const FitProblem& problem, const FitPoint& estimate,
                               const std::vector<RecordingSums>& each,
                               const std::vector<int>& counts,
                               const std::vector<CombinationSpec>& combinations) {
  FitOptions options = problem.options();
  options.num_threads = 1;
  options.function_tolerance = std::max(kReplicaTolerance, options.function_tolerance);
  const FitProblem drawn(problem.recordings(), options, counts);
  SolveStart fit = Refit(drawn, estimate, 1, SumAsDrawn(each, drawn));
  if (!fit.usable) fit = SolveFrom(drawn, drawn.NominalPoint(), "nominal", nullptr);
  if (!fit.converged || !fit.failed.empty()) return {};
  const ParameterSet<double> parameters = drawn.Parameters(fit.to, "");
  std::vector<double> values = drawn.SharedValues(fit.to);
  for (const CombinationSpec& spec : combinations) {
    double sum = 0.0;
    for (const Term& term : spec.terms) sum += term.coefficient * parameters[term.parameter];
    values.push_back(sum);
  }
  return values;
}

constexpr double kDriftErrors = 2.0;

std::vector<double> Errors(const Uncertainty& uncertainty, size_t count) {
  std::vector<double> errors;
  for (size_t i = 0; i < count; ++i) errors.push_back(uncertainty.estimates[i].standard_error);
  return errors;
}

HorizonFit FitFirst(const FitProblem& whole, int frames) {
  HorizonFit fit{frames, {}, {}, ""};
  std::vector<PendulumRecording> first = whole.recordings();
  for (PendulumRecording& r : first) {
    // Frame 0 and the steps to `frames`. The pushes stay whole: a tail knows the mean of its push.
    const auto cut = [last = static_cast<size_t>(PushFrame(r) + frames + 1)](auto* people) {
      for (auto& person : *people) person.resize(std::min(person.size(), last));
    };
    cut(&r.states);
    cut(&r.rod_length);
    cut(&r.hip);
    cut(&r.weight);
  }
  FitOptions options = whole.options();
  options.num_threads = 1;
  const FitProblem problem(first, options);
  const Solution solution = Solve(problem);
  if (!solution.ok()) {
    fit.failure = "it could not be solved";
  } else if (!solution.start.failed.empty()) {
    fit.failure = "some rollouts leave the model's domain";
  } else {
    const FitPoint& point = solution.start.to;
    fit.value = problem.SharedValues(point);
    fit.standard_error = Errors(ComputeUncertainty(problem, point), fit.value.size());
  }
  return fit;
}

std::string ValueText(double value, double error) {
  return Rounded(value, 4) + " +- " + Rounded(error, 2);
}

}  // namespace

ResamplingUnits MakeResamplingUnits(const std::vector<PendulumRecording>& recordings,
                                    ClusterBy by) {
  const Clusters clusters = MakeClusters(recordings, by);
  ResamplingUnits from;
  from.people_shared = clusters.two_way;
  from.by = from.people_shared ? ClusterBy::kRecording : clusters.by;
  from.units.resize(from.people_shared ? recordings.size() : clusters.names.size());
  for (size_t i = 0; i < recordings.size(); ++i) {
    const size_t unit = from.people_shared ? i : static_cast<size_t>(clusters.of[i][0]);
    from.units[unit].push_back(static_cast<int>(i));
  }
  return from;
}

std::vector<int> DrawRecordings(const ResamplingUnits& from, uint64_t seed, int replica) {
  Random random(seed * 1000003u + static_cast<uint64_t>(replica));
  const size_t total = from.units.size();
  size_t recordings = 0;
  for (const std::vector<int>& unit : from.units) recordings += unit.size();
  std::vector<int> counts(recordings, 0);
  for (size_t i = 0; i < total; ++i) {
    const size_t drawn =
        std::min(total - 1, static_cast<size_t>(random.Unit() * static_cast<double>(total)));
    for (int recording : from.units[drawn]) ++counts[recording];
  }
  return counts;
}

std::vector<PendulumRecording> Resampled(const std::vector<PendulumRecording>& recordings,
                                         ClusterBy by, uint64_t seed, int replica) {
  if (replica == 0) return recordings;
  const std::vector<int> counts =
      DrawRecordings(MakeResamplingUnits(recordings, by), seed, replica);
  std::vector<PendulumRecording> drawn;
  for (size_t i = 0; i < recordings.size(); ++i) {
    drawn.insert(drawn.end(), counts[i], recordings[i]);
  }
  return drawn;
}

Result<Bootstrap> ComputeBootstrap(const FitProblem& problem, const FitPoint& estimate,
                                   const BootstrapOptions& options, const JobProgress& progress) {
  const ResamplingUnits from = MakeResamplingUnits(problem.recordings(), options.by);
  const bool people = from.by == ClusterBy::kSubject;
  if (from.units.size() < 2) {
    return Error{"a bootstrap over " + std::string(people ? "people" : "recordings") +
                 " needs at least two of them" +
                 (people ? "; --bootstrap_by=recording draws recordings" : "")};
  }
  std::vector<CombinationSpec> combinations = DerivedCombinations(problem.options().model);
  const auto stays = [&problem](const CombinationSpec& spec) {
    return std::none_of(spec.terms.begin(), spec.terms.end(), [&problem](const Term& term) {
      return problem.options().table[term.parameter].free;
    });
  };
  combinations.erase(std::remove_if(combinations.begin(), combinations.end(), stays),
                     combinations.end());
  Bootstrap bootstrap;
  bootstrap.replicas = options.replicas;
  bootstrap.seed = options.seed;
  bootstrap.drawn_by = from.by;
  bootstrap.drawn_from = static_cast<int>(from.units.size());
  bootstrap.people_shared = from.people_shared;
  for (size_t i = 0; i < problem.map().fitted.size(); ++i) {
    bootstrap.names.push_back(problem.Spec(i).name);
    bootstrap.units.push_back(problem.Spec(i).unit);
  }
  for (const CombinationSpec& spec : combinations) {
    bootstrap.names.push_back(spec.name);
    bootstrap.units.push_back(spec.unit);
  }

  // Replicas that are the same fit: of few people there are few different draws.
  std::map<std::vector<int>, std::vector<int>> replicas_of;
  for (int k = 0; k < options.replicas; ++k) {
    replicas_of[DrawRecordings(from, options.seed, k)].push_back(k);
  }
  const std::vector<std::pair<std::vector<int>, std::vector<int>>> draws(replicas_of.begin(),
                                                                         replicas_of.end());
  std::vector<std::vector<double>> replicas(options.replicas);
  const std::vector<RecordingSums> each = SumEach(problem, estimate);
  ParallelFor(
      static_cast<int>(draws.size()), options.num_threads,
      [&](int i) {
        const auto& [counts, same] = draws[i];
        const auto values = FitReplica(problem, estimate, each, counts, combinations);
        for (int k : same) replicas[k] = values;
      },
      progress);
  for (std::vector<double>& values : replicas) {
    if (!values.empty()) bootstrap.values.push_back(std::move(values));
  }
  bootstrap.failed = options.replicas - static_cast<int>(bootstrap.values.size());
  for (size_t p = 0; p < bootstrap.names.size(); ++p) {
    std::vector<double> column;
    for (const std::vector<double>& row : bootstrap.values) column.push_back(row[p]);
    bootstrap.standard_error.push_back(MeanOf(column).error * std::sqrt(column.size()));
    bootstrap.lower95.push_back(Quantile(column, 0.025));
    bootstrap.upper95.push_back(Quantile(column, 0.975));
  }
  return bootstrap;
}

HorizonCheck CheckHorizons(const FitProblem& problem, const FitPoint& estimate,
                           const Uncertainty& uncertainty, int num_threads,
                           const JobProgress& progress) {
  int longest = 0;
  for (const PendulumRecording& r : problem.recordings()) {
    longest = std::max(longest, r.num_frames() - 1 - PushFrame(r));
  }
  std::vector<int> horizons;
  for (int horizon : problem.options().horizons) {
    if (horizon > 0 && horizon < longest) horizons.push_back(horizon);
  }
  std::sort(horizons.begin(), horizons.end());
  HorizonCheck check;
  check.value = problem.SharedValues(estimate);
  check.standard_error = Errors(uncertainty, check.value.size());
  for (size_t i = 0; i < check.value.size(); ++i) {
    check.parameters.push_back(uncertainty.estimates[i].name);
    check.units.push_back(uncertainty.estimates[i].unit);
  }
  check.refits.resize(horizons.size());
  ParallelFor(
      static_cast<int>(horizons.size()), num_threads,
      [&](int i) { check.refits[i] = FitFirst(problem, horizons[i]); }, progress);
  return check;
}

std::vector<Drift> Drifts(const HorizonCheck& check) {
  std::vector<Drift> drifts;
  for (size_t p = 0; p < check.parameters.size(); ++p) {
    Drift drift{p, 0, 0.0};
    for (size_t r = 0; r < check.refits.size(); ++r) {
      const HorizonFit& refit = check.refits[r];
      if (refit.value.empty()) continue;
      const double error = std::max(refit.standard_error[p], check.standard_error[p]);
      const double move = std::abs(refit.value[p] - check.value[p]) / error;
      if (std::isfinite(move) && move > drift.in_errors) drift = {p, r, move};
    }
    if (drift.in_errors > kDriftErrors) drifts.push_back(drift);
  }
  return drifts;
}

TextTable HorizonTable(const HorizonCheck& check) {
  std::vector<std::string> header = {"from the push on"};
  for (const HorizonFit& refit : check.refits) {
    header.push_back(std::to_string(refit.frames) + " frames");
  }
  header.insert(header.end(), {"all", "unit"});
  TextTable table(header);
  if (check.refits.empty()) return table;
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    std::vector<std::string> cells = {check.parameters[i]};
    for (const HorizonFit& refit : check.refits) {
      cells.push_back(refit.value.empty() ? "-"
                                          : ValueText(refit.value[i], refit.standard_error[i]));
    }
    cells.insert(cells.end(), {ValueText(check.value[i], check.standard_error[i]), check.units[i]});
    table.Add(cells);
  }
  return table;
}

std::string DriftText(const HorizonCheck& check) {
  if (check.refits.empty()) {
    return "no recording goes on for longer after its push than the shortest horizon\n";
  }
  std::string text;
  for (const Drift& drift : Drifts(check)) {
    const HorizonFit& refit = check.refits[drift.refit];
    const size_t p = drift.parameter;
    text += check.parameters[p] + " drifts: " + ValueText(refit.value[p], refit.standard_error[p]) +
            " in the first " + std::to_string(refit.frames) + " frames of the push, " +
            ValueText(check.value[p], check.standard_error[p]) + " in all, " +
            Rounded(drift.in_errors, 2) +
            " standard errors apart; it compensates for something that the model omits\n";
  }
  if (text.empty()) text = "no parameter drifts by more than twice its error\n";
  for (const HorizonFit& refit : check.refits) {
    if (refit.failure.empty()) continue;
    text += std::to_string(refit.frames) + " frames: " + refit.failure + "\n";
  }
  return text;
}

}  // namespace pushid
