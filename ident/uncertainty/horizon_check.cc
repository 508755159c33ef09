// ident: refits of fewer frames.
#include "ident/uncertainty/horizon_check.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {
namespace {

constexpr double kDriftErrors = 2.0;

std::vector<double> Errors(const Uncertainty& uncertainty, size_t count) {
  std::vector<double> errors;
  for (size_t i = 0; i < count; ++i) errors.push_back(uncertainty.estimates[i].standard_error);
  return errors;
}

template <typename T>
void Cut(int frames, std::vector<std::vector<T>>* people) {
  for (std::vector<T>& person : *people) {
    if (static_cast<int>(person.size()) > frames) person.resize(frames);
  }
}

HorizonFit FitFirst(const FitProblem& whole, int frames) {
  HorizonFit fit{frames, {}, {}, ""};
  std::vector<PendulumRecording> first = whole.recordings();
  for (PendulumRecording& r : first) {
    // Frame 0 and the steps to `frames`. The pushes stay whole: a tail knows the mean of its push.
    const int last = PushFrame(r) + frames + 1;
    Cut(last, &r.states);
    Cut(last, &r.rod_length);
    Cut(last, &r.hip);
    Cut(last, &r.weight);
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
