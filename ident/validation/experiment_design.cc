#include "ident/validation/experiment_design.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/prediction/evaluation.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/uncertainty/assumptions.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/model_verdict.h"
#include "models/decompositions.h"
#include "models/formation.h"

namespace pushid {
namespace {

using Eigen::MatrixXd;

const std::map<double, const char*> kDirections = {
    {0.0, "forwards"}, {45.0, "to the front left"}, {90.0, "to the left"}, {180.0, "backwards"}};

// Pushes like the recordings' own; without a sensor too where most have none.
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
    duration.Add(r.scene.pushes.empty() ? 0.1 : r.scene.pushes[0].force.size() * r.scene.dt);
    mass.Add(r.scene.people[r.pushed_person].body.mass);
  }
  std::vector<CandidatePush> candidates;
  const auto add = [&](double direction, double a, double height, double s, double kg) {
    if (measured <= 0) candidates.push_back({direction, a, height, s, kg, false});
    candidates.push_back({direction, a, height, measured > 0 ? s : 2.0 * s, kg, true});
  };
  for (const auto& [direction, name] : kDirections) {
    for (double a : {strength.lower, 0.5 * (strength.lower + strength.upper), strength.upper}) {
      for (double height : {0.8, 1.0}) {
        for (double s : {duration.lower, duration.upper}) {
          for (double kg : {mass.lower, mass.upper}) add(direction, a, height, s, kg);
        }
      }
    }
  }
  return candidates;
}

}  // namespace

PendulumRecording MakeCandidate(const FitProblem& problem, const FitPoint& estimate,
                                const CandidatePush& push) {
  int frames = 60;
  for (const PendulumRecording& r : problem.recordings()) frames = std::max(frames, r.num_frames());
  PendulumRecording candidate;
  candidate.id = "candidate";
  candidate.subject_ids = {"candidate"};
  const Body body = {push.mass_kg, kReferenceRod, 0.0};
  candidate.scene = FormationScene({{0.0, 0.0}}, body, problem.recordings()[0].scene.dt);
  // A whole half-sine where it is measured, its rising half where a tail goes on with it.
  const int rows = std::max(2, static_cast<int>(std::lround(push.duration_s / candidate.scene.dt)));
  const double angle = push.direction_deg * M_PI / 180.0, span = push.sensor ? M_PI : 0.5 * M_PI;
  const Vector3<double> along(std::cos(angle), std::sin(angle), 0.0);
  std::vector<Vector4<double>> force;
  for (int i = 0; i < rows; ++i) {
    const double size = push.acceleration * body.mass * std::sin(span * (i + 0.5) / rows);
    force.push_back(GeneralizedForce<double>(body, Vector4<double>::Zero(),
                                             Vector3<double>(size * along), push.height));
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
                                           std::vector<CandidatePush> candidates) {
  ExperimentDesign design;
  std::vector<int> known;
  for (int i = 0; i < problem.map().num_shared(); ++i) {
    const Estimate& e = uncertainty.estimates[i];
    const bool bound = e.status == EstimateStatus::kAtBound;
    if (bound || e.status == EstimateStatus::kUnidentifiable) continue;
    known.push_back(i);
    design.parameters.push_back(e);
  }
  const int size = static_cast<int>(known.size());
  const int groups = static_cast<int>(problem.recordings().size());
  if (size == 0 || groups <= size) {
    return Error{"a design needs more recordings (" + std::to_string(groups) +
                 ") than free parameters (" + std::to_string(size) + ")"};
  }
  const MatrixXd now = by_recording.scatter.Covariance()(known, known), present = Inverse(now);
  // T without the directions where noise is all there is, in units of the errors.
  const Eigen::VectorXd error = now.diagonal().cwiseSqrt(), inverse = error.cwiseInverse();
  const SymmetricEigen scaled =
      DecomposeSymmetric(groups * (inverse.asDiagonal() * (now - by_recording.naive(known, known)) *
                                   inverse.asDiagonal()));
  const MatrixXd root =
      error.asDiagonal() * scaled.vectors * scaled.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const MatrixXd spread = root * root.transpose();
  if (candidates.empty()) candidates = DefaultCandidates(problem.recordings());
  FitOptions options = problem.options();
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.settling_weight = 0.0;
  for (const CandidatePush& push : candidates) {
    const std::vector<PendulumRecording> candidate = {MakeCandidate(problem, estimate, push)};
    if (candidate[0].states.empty()) continue;
    // J'J / sigma^2, weighted as a recording of the fit.
    const FitProblem alone(candidate, options);
    FitPoint point = alone.NominalPoint();
    point.shared = estimate.shared;
    const MatrixXd jacobian = EvaluateRows(alone, point).jacobian(Eigen::all, known);
    MatrixXd information = jacobian.transpose() * jacobian;
    information /= by_recording.sigma * by_recording.sigma;
    // (I^-1 + T)^-1 = (1 + I T)^-1 I, also where I is singular.
    const MatrixXd then = Inverse(
        present + SolveGeneral(MatrixXd::Identity(size, size) + information * spread, information));
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
      ComputeCovariance(fit.score, fit.unit, {ClusterByRecording(fit.score), {}, 0, false}));
}

Result<std::string> DesignText(const std::string& parameter, Result<ExperimentDesign>* result) {
  if (!result->ok()) return "no further push is proposed: " + result->error().message + "\n";
  auto& [parameters, rows] = result->value();
  const size_t all = parameters.size();  // the column of their mean
  size_t own = 0;
  std::string known = "all";
  for (; own < all && parameters[own].name != parameter; ++own)
    known += ", " + parameters[own].name;
  if (own == all && parameter != "all") {
    return Error{"there is no error of '" + parameter + "' to reduce; choose from " + known};
  }
  std::stable_sort(rows.begin(), rows.end(), [own](const DesignRow& a, const DesignRow& b) {
    return a.error_ratio[own] < b.error_ratio[own];
  });
  std::vector<std::string> header = {"one more push", "m/s^2", "height", "s", "kg", "sensor"};
  if (own != all) header.push_back("error of " + parameter);
  header.push_back("mean of all errors");
  TextTable table = TextTable::OfNumbers(header);
  for (size_t i = 0; i < rows.size(); ++i) {
    if (i == 10) table.Add(std::vector<std::string>()), i = rows.size() - 1;
    const CandidatePush& push = rows[i].push;
    std::vector<std::string> cells = {kDirections.at(push.direction_deg),
                                      Rounded(push.acceleration, 3),
                                      Rounded(push.height, 2),
                                      Rounded(push.duration_s, 2),
                                      Rounded(push.mass_kg, 3),
                                      push.sensor ? "yes" : "no"};
    for (size_t column : own == all ? std::vector{all} : std::vector{own, all}) {
      cells.push_back(Rounded(100.0 * (rows[i].error_ratio[column] - 1.0), 2) + " %");
    }
    table.Add(cells);
  }
  return "effect of one more recording, best first; last row: the least useful of " +
         std::to_string(rows.size()) + " candidates\n" + table.ToString() +
         (own == all
              ? ""
              : "now, by the data alone: " + parameter + " +- " +
                    Rounded(parameters[own].standard_error, 3) + " " + parameters[own].unit + "\n");
}

}  // namespace pushid
