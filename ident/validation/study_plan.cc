// ident: errors split into people, recordings and noise, and put together for other studies.
#include "ident/validation/study_plan.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "ident/parameters/parameter_table.h"
#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/clusters.h"
#include "ident/uncertainty/covariance.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

using Eigen::MatrixXd;

constexpr int kPeople[] = {4, 10, 20, 40};
constexpr double kMorePushes = 2.0;  // times as many of each
constexpr int kIterations = 200;     // of EM: more change no ratio by a percent

// What a recording says of its own parameters: J'J and J'r of its rows.
struct OwnInformation {
  MatrixXd hessian;
  Eigen::VectorXd gradient;
};

// The mixed model r_g = J_g d_g + e, d_g ~ N(0, spread), e ~ N(0, noise).
struct MixedModel {
  MatrixXd spread;
  double noise = 0.0;  // variance of a row
};

MixedModel FitMixedModel(const std::vector<OwnInformation>& own, const MatrixXd& start,
                         double squares, double rows) {
  const Eigen::Index size = start.rows();
  const double groups = static_cast<double>(own.size());
  MixedModel model{start, squares / rows};
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    MatrixXd moments = MatrixXd::Zero(size, size);
    double left = squares;
    for (const OwnInformation& g : own) {
      // (H / noise + spread^-1)^-1, also where the spread is singular.
      const MatrixXd covariance = SolveGeneral(
          MatrixXd::Identity(size, size) + model.spread * g.hessian / model.noise, model.spread);
      const Eigen::VectorXd deviation = covariance * g.gradient / model.noise;
      moments += deviation * deviation.transpose() + covariance;
      left += deviation.dot(g.hessian * deviation) - 2.0 * deviation.dot(g.gradient) +
              (g.hessian * covariance).trace();
    }
    model.spread = 0.5 * (moments + moments.transpose()) / groups;
    model.noise = left / rows;
  }
  return model;
}

// The covariance of the shared parameters `columns` (among those of the model), found together from
// recordings whose own ones differ.
MatrixXd SharedCovariance(const MixedModel& model, const std::vector<OwnInformation>& own,
                          const MatrixXd& hessian, const std::vector<int>& columns) {
  const MatrixXd inverse = Inverse(hessian(columns, columns));
  const MatrixXd spread = model.spread(columns, columns);
  MatrixXd scores = MatrixXd::Zero(spread.rows(), spread.cols());
  for (const OwnInformation& g : own) {
    const MatrixXd h = g.hessian(columns, columns);
    scores += model.noise * h + h * spread * h;
  }
  return inverse * scores * inverse;
}

bool IsTail(Parameter id) { return id >= kTailGain && id <= kTailBase; }

void AddSensor(const FitProblem& problem, const std::vector<int>& known, const ErrorParts& parts,
               StudyPlan* plan) {
  std::vector<int> all(known.size()), rest;  // among the known
  std::iota(all.begin(), all.end(), 0);
  for (int i : all) {
    if (!IsTail(problem.map().fitted[known[i]].parameter)) rest.push_back(i);
  }
  if (rest.size() == known.size()) plan->no_sensor = "no push has a fitted tail";
  if (rest.empty()) plan->no_sensor = "only the tail is fitted";
  if (parts.score.clusters.size() <= known.size()) {
    plan->no_sensor = "it needs more recordings than parameters";
  }
  if (!plan->no_sensor.empty()) return;
  const MatrixXd jacobian = parts.score.jacobian(Eigen::all, known);
  std::vector<OwnInformation> own;
  double squares = 0.0;
  for (int recording : parts.score.clusters) {
    const std::vector<int> rows = parts.score.RowsOf(recording);
    const MatrixXd j = jacobian(rows, Eigen::all);
    const Eigen::VectorXd r = parts.score.residuals(rows);
    own.push_back({j.transpose() * j, j.transpose() * r});
    squares += r.squaredNorm();
  }
  const Eigen::VectorXd start =
      parts.by_recording(known, known).diagonal() * parts.num_recordings();
  const MixedModel model =
      FitMixedModel(own, start.asDiagonal(), squares, parts.score.num_data_rows);
  const MatrixXd hessian = jacobian.transpose() * jacobian;
  const MatrixXd now = SharedCovariance(model, own, hessian, all);
  const MatrixXd then = SharedCovariance(model, own, hessian, rest);
  plan->sensor_ratio.assign(known.size(), std::numeric_limits<double>::quiet_NaN());
  for (size_t k = 0; k < rest.size(); ++k) {
    const int at = static_cast<int>(k);
    plan->sensor_ratio[rest[k]] = std::sqrt(then(at, at) / now(rest[k], rest[k]));
  }
}

double PositiveRoot(double variance) { return std::sqrt(std::max(0.0, variance)); }

// slope: of each parameter's natural value on the fitted scale.
void AddSizes(const ErrorParts& parts, const std::vector<int>& known,
              const std::vector<double>& slope, StudyPlan* plan) {
  const double recordings = static_cast<double>(parts.num_recordings());
  std::map<int, int> counts;
  for (int person : parts.person) ++counts[person];
  double f = 0.0;
  for (const auto& [person, count] : counts) f += std::pow(count / recordings, 2);
  const double in_recordings = (1.0 - f) / (recordings - 1.0);
  for (size_t i = 0; i < slope.size(); ++i) {
    const int at = known[i];
    const double by_recording = parts.by_recording(at, at), by_person = parts.by_person(at, at);
    const double noise = recordings * parts.naive(at, at);
    // Bounded: people cannot differ by less than nothing, nor explain more than there is.
    const double between = std::clamp((by_person - by_recording) / (f - in_recordings), 0.0,
                                      std::max(0.0, by_recording / in_recordings));
    const double within = recordings * (by_recording - in_recordings * between);
    plan->between_people.push_back(slope[i] * PositiveRoot(between));
    plan->between_recordings.push_back(slope[i] * PositiveRoot(within - noise));
    plan->noise.push_back(slope[i] * PositiveRoot(noise));
  }
  const double pushes = recordings / static_cast<double>(counts.size());
  const auto add = [&](int size, double each) {
    StudySize row{size, each, {}};
    for (size_t i = 0; i < slope.size(); ++i) {
      row.standard_error.push_back(ExpectedError(*plan, i, size, each));
    }
    plan->sizes.push_back(row);
  };
  add(static_cast<int>(counts.size()), pushes);
  add(static_cast<int>(counts.size()), kMorePushes * pushes);
  for (int size : kPeople) {
    if (size <= static_cast<int>(counts.size())) continue;
    add(size, pushes);
    add(size, kMorePushes * pushes);
  }
}

// Why errors cannot be split into people and recordings; empty: they can.
std::string WhyNoSizes(const FitProblem& problem, const ErrorParts& parts) {
  const auto& recordings = problem.recordings();
  if (std::any_of(recordings.begin(), recordings.end(),
                  [](const PendulumRecording& r) { return r.num_people() > 1; })) {
    return "several people share a recording";
  }
  if (problem.map().num_deviations > 0 && !HoldsForRecording(problem.map().pool_by)) {
    return "parameters are pooled by person, so the fit already includes the variation between "
           "people";
  }
  const int people = 1 + *std::max_element(parts.person.begin(), parts.person.end());
  if (people < 2) return "the variation between people needs at least two of them (subject_id)";
  if (people == parts.num_recordings()) {
    return "nobody was recorded twice, so the variation between people and between recordings "
           "cannot be separated";
  }
  return "";
}

}  // namespace

double ExpectedError(const StudyPlan& plan, size_t parameter, double people, double pushes) {
  const double b = plan.between_people[parameter], w = plan.between_recordings[parameter],
               n = plan.noise[parameter];
  return std::sqrt(b * b / people + (w * w + n * n) / (people * pushes));
}

StudyPlan PlanStudies(const FitProblem& problem, const FitPoint& estimate, const ErrorParts& parts,
                      std::vector<int> known) {
  // What settings or conditions differ by no further person and no sensor makes smaller.
  known.erase(std::remove_if(known.begin(), known.end(),
                             [&problem](int i) { return problem.map().fitted[i].deviation >= 0; }),
              known.end());
  StudyPlan plan;
  std::vector<double> slope;
  for (int i : known) {
    const FittedParameter& f = problem.map().fitted[i];
    const ParameterSpec& spec = problem.options().table[f.parameter];
    plan.parameters.push_back(spec.name);
    plan.units.push_back(spec.unit);
    slope.push_back(TransformSlope(f.transform, ToNatural(f.transform, estimate.shared[i])));
  }
  if (known.empty() || parts.num_recordings() < 2) {
    plan.no_sensor = plan.no_sizes = "it needs two recordings, and a parameter that they identify";
    return plan;
  }
  AddSensor(problem, known, parts, &plan);
  plan.equipment = PlanEquipment(problem, estimate, parts, known);
  plan.no_sizes = WhyNoSizes(problem, parts);
  if (plan.no_sizes.empty()) AddSizes(parts, known, slope, &plan);
  return plan;
}

namespace {

// Who is pushed in each recording, as consecutive numbers.
std::vector<int> PushedPeople(const std::vector<PendulumRecording>& recordings) {
  std::map<std::string, int> known;
  std::vector<int> people;
  for (const PendulumRecording& r : recordings) {
    people.push_back(
        known.emplace(r.subject_ids[r.pushed_person], static_cast<int>(known.size())).first->second);
  }
  return people;
}

JacobianBlocks Clustered(JacobianBlocks score, const std::vector<int>& cluster_of_recording) {
  for (int& cluster : score.cluster_of_row) {
    if (cluster >= 0) cluster = cluster_of_recording[cluster];
  }
  score.clusters.clear();
  for (int cluster : score.cluster_of_row) {
    if (cluster >= 0) score.clusters.push_back(cluster);
  }
  std::sort(score.clusters.begin(), score.clusters.end());
  score.clusters.erase(std::unique(score.clusters.begin(), score.clusters.end()),
                       score.clusters.end());
  return score;
}

// By the clusters that the rows name.
Covariance ByClusters(const JacobianBlocks& score, const Eigen::VectorXd& unit) {
  return ComputeCovariance(score, unit, {ClusterByRecording(score), {}, 0, false});
}

}  // namespace

ErrorParts ErrorPartsAt(const FitProblem& problem, const FitPoint& estimate) {
  ScoredFit fit = ScoreAt(problem, estimate);
  ErrorParts parts;
  parts.person = PushedPeople(problem.recordings());
  const Covariance by_person = ByClusters(Clustered(fit.score, parts.person), fit.unit);
  std::vector<int> each(parts.person.size());
  std::iota(each.begin(), each.end(), 0);
  parts.score = Clustered(std::move(fit.score), each);
  const Covariance by_recording = ByClusters(parts.score, fit.unit);
  parts.sigma = by_recording.sigma;
  parts.naive = by_recording.naive;
  parts.by_recording = by_recording.scatter.Covariance();
  parts.by_person = by_person.scatter.Covariance();
  return parts;
}

}  // namespace pushid
