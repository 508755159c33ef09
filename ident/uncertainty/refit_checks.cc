// ident: what refits are compared with.
#include "ident/uncertainty/refit_checks.h"

#include <algorithm>
#include <cmath>

#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

std::vector<double> SharedValues(const FitProblem& problem, const FitPoint& point) {
  const ParameterSet<double> parameters = problem.Parameters(point, "");
  std::vector<double> values;
  for (const FittedParameter& f : problem.map().fitted) values.push_back(parameters[f.parameter]);
  return values;
}

void Take(const FitProblem& problem, const SolveStart& refit, RefitRow* row) {
  if (!refit.usable && refit.failed.empty()) {
    row->failure = "the refit did not converge: " + refit.message;
  } else if (!refit.failed.empty()) {
    row->failure = "some rollouts leave the model's domain";
  } else {
    row->value = SharedValues(problem, refit.to);
  }
}

RefitTable RefitTableOf(const FitProblem& problem, const FitPoint& estimate,
                        const Uncertainty& uncertainty) {
  RefitTable table;
  table.value = SharedValues(problem, estimate);
  for (size_t i = 0; i < table.value.size(); ++i) {
    table.parameters.push_back(uncertainty.estimates[i].name);
    table.units.push_back(uncertainty.estimates[i].unit);
    table.standard_error.push_back(uncertainty.estimates[i].standard_error);
  }
  return table;
}

namespace {

template <typename T>
void Cut(int frames, std::vector<std::vector<T>>* people) {
  for (std::vector<T>& person : *people) {
    if (static_cast<int>(person.size()) > frames) person.resize(frames);
  }
}

// So many from the first push on. The pushes stay whole: a tail knows the mean of its push.
std::vector<PendulumRecording> FirstFrames(std::vector<PendulumRecording> recordings, int frames) {
  for (PendulumRecording& r : recordings) {
    const int last = PushFrame(r) + frames;
    Cut(last, &r.states);
    Cut(last, &r.rod_length);
    Cut(last, &r.hip);
    Cut(last, &r.weight);
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

// Every step of every recording on its own, by the innovation likelihood.
RefitRow FitOneStep(const FitProblem& whole) {
  RefitRow row{"horizon", "one step", {}, {}, "", kOneStep};
  FitOptions options = whole.options();
  options.num_threads = options.num_starts = 1;
  SetLikelihood(Likelihood::kInnovation, &options);
  FreeNoise(&options);
  FitProblem problem(whole.recordings(), options);
  const LikelihoodSolution found = SolveByLikelihood(&problem);
  if (found.solution.best < 0 || !found.stays) {
    row.failure = found.solution.best < 0
                      ? found.solution.starts.front().message
                      : "the likelihood still increased in the last round of solving";
    return row;
  }
  const FitPoint& best = found.solution.Best().to;
  const ParameterSet<double> values = problem.Parameters(best, "");
  const Uncertainty uncertainty = ComputeUncertainty(problem, best);
  const auto& fitted = problem.map().fitted;
  for (const FittedParameter& of : whole.map().fitted) {
    const auto at = std::find_if(fitted.begin(), fitted.end(), [&of](const FittedParameter& f) {
      return f.parameter == of.parameter;
    });
    row.value.push_back(values[of.parameter]);
    row.standard_error.push_back(uncertainty.estimates[at - fitted.begin()].standard_error);
  }
  return row;
}

bool KnowsSingleSteps(const FitProblem& problem) {
  const auto& recordings = problem.recordings();
  return MemoryOf(problem.options().model).empty() &&
         std::none_of(recordings.begin(), recordings.end(), [](const PendulumRecording& r) {
           return r.initial_velocity == InitialVelocity::kFree;
         });
}

}  // namespace

RefitTable CheckHorizons(const FitProblem& problem, const FitPoint& estimate,
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
  RefitTable table = RefitTableOf(problem, estimate, uncertainty);
  if (KnowsSingleSteps(problem)) horizons.insert(horizons.begin(), kOneStep);
  table.rows.resize(horizons.size());
  ParallelFor(
      static_cast<int>(horizons.size()), num_threads,
      [&](int i) {
        table.rows[i] =
            horizons[i] == kOneStep ? FitOneStep(problem) : FitFirst(problem, horizons[i]);
      },
      progress);
  return table;
}

namespace {

// Where priors hold a number, the way from another estimate is long, and where feet step it is
// rough: the priors' own centres are a second start. A demand to settle that is contradicted there
// is dropped, as by a fit.
SolveStart RefitFromAfar(const FitProblem& problem, const FitPoint& estimate) {
  SolveStart refit = Refit(problem, estimate);
  if (problem.options().likelihood != Likelihood::kTrajectory || !estimate.weights.empty()) {
    return refit;
  }
  FitProblem without = problem;
  without.set_settling_weight(0.0);
  const SolveStart free = SolveFrom(without, without.NominalPoint(), "nominal", "", nullptr);
  if (!free.usable || !free.failed.empty()) return refit;
  SolveStart held = Refit(problem, free.to);
  if (held.usable && (!refit.usable || held.cost < refit.cost)) refit = std::move(held);
  const bool drops = !refit.usable || Contradicted(2.0 * (CostAt(without, refit.to) - free.cost),
                                                   without.SettlingUnits(free.to).size());
  return drops ? free : refit;
}

RefitRow RefitWith(const FitProblem& problem, const FitPoint& estimate, const std::string& name,
                   double factor) {
  RefitRow row{"priors", name, {}, {}, "", 0};
  FitOptions options = problem.options();
  for (ParameterSpec& spec : options.table.specs) {
    if (!spec.prior || !spec.free) continue;
    spec.prior = Prior{factor * spec.prior->mean, factor * spec.prior->sigma};
    spec.nominal = std::clamp(spec.prior->mean, spec.lower, spec.upper);
  }
  const FitProblem other(problem.recordings(), options, problem.counts());
  Take(other, RefitFromAfar(other, estimate), &row);
  return row;
}

}  // namespace

RefitTable CheckPriors(const FitProblem& problem, const FitPoint& estimate,
                       const Uncertainty& uncertainty) {
  RefitTable table = RefitTableOf(problem, estimate, uncertainty);
  const auto& fitted = problem.map().fitted;
  const bool any = std::any_of(fitted.begin(), fitted.end(), [&problem](const FittedParameter& f) {
    return problem.options().table[f.parameter].prior.has_value();
  });
  if (!any) return table;
  table.rows = {RefitWith(problem, estimate, "halved", 0.5),
                RefitWith(problem, estimate, "doubled", 2.0)};
  return table;
}

bool PriorsLeaveInside(const RefitTable& check, size_t index, const Uncertainty& uncertainty) {
  const Estimate& e = uncertainty.estimates[index];
  return std::all_of(check.rows.begin(), check.rows.end(), [&](const RefitRow& row) {
    return !row.value.empty() && e.lower95 <= row.value[index] && row.value[index] <= e.upper95;
  });
}

}  // namespace pushid
