// ident: candidate pushes, their information and their table.
#include "ident/validation/experiment_design.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/prediction/evaluation.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/uncertainty/assumptions.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/model_verdict.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

using Eigen::MatrixXd;

constexpr double kDirections[] = {0.0, 45.0, 90.0, 180.0};  // degrees
constexpr const char* kDirectionNames[] = {"forwards", "to the front left", "to the left",
                                           "backwards"};

// J'J of a candidate, weighted as a recording of the fit.
MatrixXd Information(const FitProblem& problem, const FitPoint& estimate,
                     const PendulumRecording& candidate, const std::vector<int>& known) {
  FitOptions options = problem.options();
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.settling_weight = 0.0;
  const std::vector<PendulumRecording> one = {candidate};
  const FitProblem alone(one, options);
  FitPoint point = alone.NominalPoint();
  point.shared = estimate.shared;
  const MatrixXd jacobian = EvaluateRows(alone, point).jacobian(Eigen::all, known);
  return jacobian.transpose() * jacobian;
}

// T of the header, without the directions where noise is all there is.
MatrixXd SpreadOf(const MatrixXd& clustered, const MatrixXd& naive, int groups) {
  const Eigen::VectorXd error = clustered.diagonal().cwiseSqrt(), inverse = error.cwiseInverse();
  const SymmetricEigen scaled = DecomposeSymmetric(
      groups * (inverse.asDiagonal() * (clustered - naive) * inverse.asDiagonal()));
  const MatrixXd root =
      error.asDiagonal() * scaled.vectors * scaled.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return root * root.transpose();
}

// The column of errors of a parameter, of which "all" has the last; one more where there is none.
size_t IndexOf(const ExperimentDesign& design, const std::string& parameter) {
  const std::vector<std::string>& names = design.parameters;
  const auto at = std::find(names.begin(), names.end(), parameter);
  return (at - names.begin()) + (at == names.end() && parameter != "all" ? 1 : 0);
}

}  // namespace

std::vector<CandidatePush> DefaultCandidates(const std::vector<PendulumRecording>& recordings) {
  ValueRange strength, duration, mass;
  int measured = 0;  // more pushes that are than those that are not
  for (const PendulumRecording& r : recordings) {
    double peak = 0.0;
    for (const ScenePush& push : r.scene.pushes) {
      measured += push.kind == PushKind::kExternal ? 1 : -1;
      for (const Vector4<double>& row : push.force) {
        peak = std::max(peak, row.head<2>().norm() / r.scene.people[push.person].body.mass);
      }
    }
    strength.Add(peak);
    duration.Add(r.scene.pushes.empty()
                     ? 0.1
                     : static_cast<double>(r.scene.pushes[0].force.size()) * r.scene.dt);
    mass.Add(r.scene.people[r.pushed_person].body.mass);
  }
  std::vector<CandidatePush> candidates;
  for (double direction : kDirections) {
    for (double a : {strength.lower, 0.5 * (strength.lower + strength.upper), strength.upper}) {
      for (double height : {0.8, 1.0}) {
        for (double s : {duration.lower, duration.upper}) {
          for (double kg : {mass.lower, mass.upper}) {
            if (measured <= 0) candidates.push_back({direction, a, height, s, kg, false});
            candidates.push_back({direction, a, height, measured > 0 ? s : 2.0 * s, kg, true});
          }
        }
      }
    }
  }
  return candidates;
}

PendulumRecording MakeCandidate(const FitProblem& problem, const FitPoint& estimate,
                                const CandidatePush& push) {
  int frames = 60;
  for (const PendulumRecording& r : problem.recordings()) frames = std::max(frames, r.num_frames());
  PendulumRecording candidate;
  candidate.id = "candidate";
  candidate.subject_ids = {"candidate"};
  candidate.scene.dt = problem.recordings()[0].scene.dt;
  candidate.scene.people.resize(1);
  const Body& body = candidate.scene.people[0].body = {push.mass_kg, kReferenceRod, 0.0};
  // A whole half-sine where it is measured, its rising half where a tail goes on with it.
  const int rows = std::max(2, static_cast<int>(std::lround(push.duration_s / candidate.scene.dt)));
  const double angle = push.direction_deg * M_PI / 180.0, span = push.sensor ? M_PI : 0.5 * M_PI;
  std::vector<Vector4<double>> force;
  for (int i = 0; i < rows; ++i) {
    const double size = push.acceleration * body.mass * std::sin(span * (i + 0.5) / rows);
    const Vector3<double> f(size * std::cos(angle), size * std::sin(angle), 0.0);
    force.push_back(GeneralizedForce<double>(body, Vector4<double>::Zero(), f, push.height));
  }
  candidate.scene.pushes = {
      MakeScenePush(0, 0, push.sensor ? PushKind::kExternal : PushKind::kNet, force)};
  IdentifiedModel model;
  model.options = problem.options().model;
  model.parameters = problem.Parameters(estimate, "");
  const Prediction expected = Predict(model, candidate, frames);
  if (!expected.status.ok || AnybodyFalls(expected)) return candidate;
  candidate.hip = expected.hip;
  candidate.states.emplace_back();
  for (int t = 0; t < frames; ++t) candidate.states[0].push_back(expected.path.At(t, 0));
  candidate.rod_length = {std::vector<double>(frames, kReferenceRod)};
  return candidate;
}

Result<ExperimentDesign> DesignExperiments(const FitProblem& problem, const FitPoint& estimate,
                                           const Uncertainty& uncertainty,
                                           const Covariance& by_recording,
                                           const std::vector<CandidatePush>& candidates) {
  ExperimentDesign design;
  std::vector<int> known;
  for (int i = 0; i < problem.map().num_shared(); ++i) {
    const Estimate& e = uncertainty.estimates[i];
    using Status = EstimateStatus;
    if (e.status == Status::kUnidentifiable || e.status == Status::kAtBound) continue;
    known.push_back(i);
    design.parameters.push_back(e.name);
    design.units.push_back(e.unit);
    design.standard_error.push_back(e.standard_error);
  }
  const int size = static_cast<int>(known.size());
  const int groups = static_cast<int>(problem.recordings().size());
  if (size == 0 || groups <= size) {
    return Error{"a design needs more recordings (" + std::to_string(groups) +
                 ") than free parameters (" + std::to_string(size) + ")"};
  }
  const MatrixXd now = by_recording.scatter.Covariance()(known, known), present = Inverse(now);
  const MatrixXd spread = SpreadOf(now, by_recording.naive(known, known), groups);
  for (const CandidatePush& push : candidates) {
    const PendulumRecording candidate = MakeCandidate(problem, estimate, push);
    if (candidate.states.empty()) continue;
    const MatrixXd information = Information(problem, estimate, candidate, known) /
                                 (by_recording.sigma * by_recording.sigma);
    // (I^-1 + T)^-1 = (1 + I T)^-1 I, also where I is singular.
    const MatrixXd told =
        SolveGeneral(MatrixXd::Identity(size, size) + information * spread, information);
    const MatrixXd then = Inverse(present + told);
    DesignRow row{push, {}};
    for (int i = 0; i < size; ++i) row.error_ratio.push_back(std::sqrt(then(i, i) / now(i, i)));
    row.error_ratio.push_back(std::pow(then.determinant() / now.determinant(), 0.5 / size));
    design.rows.push_back(row);
  }
  return design;
}

Result<ExperimentDesign> DesignExperiments(const std::vector<PendulumRecording>& recordings,
                                           const FitResult& result) {
  const FitProblem problem(recordings, result.options);
  const auto estimate = problem.PointAt(result.starts[result.best_start].to.Flat());
  if (!estimate) return Error{"a design needs the recordings that were fitted, as they were then"};
  const ScoredFit fit = ScoreAt(problem, *estimate);
  return DesignExperiments(
      problem, *estimate, result.uncertainty,
      ComputeCovariance(fit.score, fit.unit, {ClusterByRecording(fit.score), {}, 0, false}),
      DefaultCandidates(recordings));
}

Result<std::vector<DesignRow>> RankedRows(const ExperimentDesign& design,
                                          const std::string& parameter) {
  const size_t index = IndexOf(design, parameter);
  if (index > design.parameters.size()) {
    return Error{"there is no error of '" + parameter + "' to reduce; choose from all, " +
                 Joined(design.parameters, ", ")};
  }
  std::vector<DesignRow> rows = design.rows;
  std::stable_sort(rows.begin(), rows.end(), [index](const DesignRow& a, const DesignRow& b) {
    return a.error_ratio[index] < b.error_ratio[index];
  });
  return rows;
}

Result<std::string> DesignText(const Result<ExperimentDesign>& result,
                               const std::string& parameter) {
  constexpr size_t kBest = 10;
  if (!result.ok()) return "no further push is proposed: " + result.error().message + "\n";
  const ExperimentDesign& design = result.value();
  const Result<std::vector<DesignRow>> ranked = RankedRows(design, parameter);
  if (!ranked.ok()) return ranked.error();
  const size_t index = IndexOf(design, parameter), all = design.parameters.size();
  std::vector<std::string> header = {"one more push", "m/s^2", "height", "s", "kg", "sensor"};
  if (index != all) header.push_back("error of " + parameter);
  header.push_back("mean of all errors");
  TextTable table = TextTable::OfNumbers(header);
  const std::vector<DesignRow>& rows = ranked.value();
  for (size_t i = 0; i < rows.size(); ++i) {
    if (i == kBest) table.AddGap(), i = rows.size() - 1;  // and the last
    const CandidatePush& push = rows[i].push;
    const auto direction =
        std::find(std::begin(kDirections), std::end(kDirections), push.direction_deg) - kDirections;
    const auto change = [](double ratio) { return Rounded(100.0 * (ratio - 1.0), 2) + " %"; };
    std::vector<std::string> cells = {kDirectionNames[direction], Rounded(push.acceleration, 3),
                                      Rounded(push.height, 2),    Rounded(push.duration_s, 2),
                                      Rounded(push.mass_kg, 3),   push.sensor ? "yes" : "no"};
    if (index != all) cells.push_back(change(rows[i].error_ratio[index]));
    cells.push_back(change(rows[i].error_ratio[all]));
    table.Add(cells);
  }
  const std::string text =
      "effect of one more recording, best first; last row: the least useful of " +
      std::to_string(rows.size()) + " candidates\n" + table.ToString();
  if (index == all) return text;
  return text + "now, by the data alone: " + parameter + " +- " +
         Rounded(design.standard_error[index], 3) + " " + design.units[index] + "\n";
}

}  // namespace pushid
