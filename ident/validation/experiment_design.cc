// ident: candidate pushes and their information.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ident/prediction/prediction.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/jacobian_blocks.h"
#include "ident/validation/study_plan.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr double kDirections[] = {0.0, 45.0, 90.0, 180.0};  // degrees
constexpr double kHeights[] = {0.8, 1.0};
constexpr int kMinFrames = 60;

struct Range {
  double lower, upper;
};

template <typename F>
Range RangeOf(const std::vector<PendulumRecording>& recordings, F value) {
  Range range{value(recordings[0]), value(recordings[0])};
  for (const PendulumRecording& r : recordings) {
    range.lower = std::min(range.lower, value(r));
    range.upper = std::max(range.upper, value(r));
  }
  return range;
}

double PeakAcceleration(const PendulumRecording& r) {
  double peak = 0.0;
  for (const ScenePush& push : r.scene.pushes) {
    for (const Vector4<double>& row : push.force) {
      peak = std::max(peak, row.head<2>().norm() / r.scene.people[push.person].body.mass);
    }
  }
  return peak;
}

double PushSeconds(const PendulumRecording& r) {
  return r.scene.pushes.empty() ? 0.1
                                : static_cast<double>(r.scene.pushes[0].force.size()) * r.scene.dt;
}

PushKind UsualKind(const std::vector<PendulumRecording>& recordings) {
  int external = 0, pushes = 0;
  for (const PendulumRecording& r : recordings) {
    for (const ScenePush& push : r.scene.pushes) {
      external += push.kind == PushKind::kExternal;
      ++pushes;
    }
  }
  return 2 * external > pushes ? PushKind::kExternal : PushKind::kNet;
}

// Rows of the generalized force: the rising quarter of a sine where a tail goes on with it, a whole
// half-sine where the push is all there is.
std::vector<Vector4<double>> PushRows(const CandidatePush& push, PushKind kind, const Body& body,
                                      double dt) {
  const int rows = std::max(2, static_cast<int>(std::lround(push.duration_s / dt)));
  const double angle = push.direction_deg * M_PI / 180.0;
  const double span = kind == PushKind::kExternal ? M_PI : 0.5 * M_PI;
  std::vector<Vector4<double>> force;
  for (int i = 0; i < rows; ++i) {
    const double size = push.acceleration * body.mass * std::sin(span * (i + 0.5) / rows);
    const Vector3<double> f(size * std::cos(angle), size * std::sin(angle), 0.0);
    force.push_back(GeneralizedForce<double>(body, Vector4<double>::Zero(), f, push.height));
  }
  return force;
}

// Shared columns of a candidate's Jacobian, weighted as a recording of the fit.
Eigen::MatrixXd CandidateJacobian(const FitProblem& problem, const FitPoint& estimate,
                                  const PendulumRecording& candidate) {
  FitOptions options = problem.options();
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.settling_weight = options.mode_weight = 0.0;
  const std::vector<PendulumRecording> one = {candidate};
  const FitProblem alone(one, options);
  FitPoint point = alone.NominalPoint();
  point.shared = estimate.shared;
  const FitProblem::Built built = alone.Build(&point, 0);
  return EvaluateJacobianBlocks(built).jacobian.leftCols(problem.map().num_shared());
}

}  // namespace

std::vector<CandidatePush> DefaultCandidates(const std::vector<PendulumRecording>& recordings) {
  const Range strength = RangeOf(recordings, PeakAcceleration);
  const Range duration = RangeOf(recordings, PushSeconds);
  const Range mass = RangeOf(recordings, [](const PendulumRecording& r) {
    return r.scene.people[r.pushed_person].body.mass;
  });
  std::vector<CandidatePush> candidates;
  for (double direction : kDirections) {
    for (double a : {strength.lower, 0.5 * (strength.lower + strength.upper), strength.upper}) {
      for (double height : kHeights) {
        for (double seconds : {duration.lower, duration.upper}) {
          for (double kg : {mass.lower, mass.upper}) {
            candidates.push_back({direction, a, height, seconds, kg});
          }
        }
      }
    }
  }
  return candidates;
}

PendulumRecording MakeCandidate(const FitProblem& problem, const FitPoint& estimate,
                                const CandidatePush& push, PushKind kind) {
  const PendulumRecording& like = problem.recordings()[0];
  int frames = kMinFrames;
  for (const PendulumRecording& r : problem.recordings()) frames = std::max(frames, r.num_frames());
  PendulumRecording candidate;
  candidate.id = "candidate";
  candidate.subject_ids = {"candidate"};
  candidate.scene.dt = like.scene.dt;
  ScenePerson person;
  person.body = {push.mass_kg, kReferenceRod, 0.0};
  candidate.scene.people = {person};
  candidate.scene.pushes = {
      MakeScenePush(0, 0, kind, PushRows(push, kind, person.body, like.scene.dt))};
  IdentifiedModel model;
  model.options = problem.options().model;
  model.parameters = problem.Parameters(estimate, "");
  const Prediction expected = Predict(model, candidate, frames);
  if (!expected.status.ok) return candidate;
  candidate.hip = expected.hip;
  candidate.states.resize(1);
  for (int t = 0; t < frames; ++t) candidate.states[0].push_back(expected.path.At(t, 0));
  candidate.rod_length = {std::vector<double>(frames, kReferenceRod)};
  return candidate;
}

namespace {

// L with L L' = T = G (V - V_naive), without the directions where noise is all there is.
Eigen::MatrixXd SpreadRoot(const Eigen::MatrixXd& clustered, const Eigen::MatrixXd& naive,
                           int groups) {
  const Eigen::VectorXd error = clustered.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = error.cwiseInverse();
  const SymmetricEigen root = DecomposeSymmetric(
      groups * (inverse.asDiagonal() * (clustered - naive) * inverse.asDiagonal()));
  return error.asDiagonal() * root.vectors * root.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

// (I^-1 + L L')^-1, also where I is singular (Woodbury).
Eigen::MatrixXd WithSpread(const Eigen::MatrixXd& information, const Eigen::MatrixXd& spread) {
  const Eigen::MatrixXd mixed = information * spread;
  const Eigen::MatrixXd inner =
      Eigen::MatrixXd::Identity(spread.cols(), spread.cols()) + spread.transpose() * mixed;
  return information - mixed * SolveSymmetricTransposed(inner, mixed);
}

bool Falls(const PendulumRecording& candidate) {
  if (candidate.states.empty()) return true;
  return std::any_of(candidate.states[0].begin(), candidate.states[0].end(),
                     [](const PendulumState<double>& state) {
                       return state.q.tail<2>().cwiseAbs().maxCoeff() > kFallAngle;
                     });
}

// Shared parameters that the data determine: on a bound or undetermined there is no error to
// reduce.
std::vector<int> KnownParameters(const Uncertainty& uncertainty, int shared) {
  std::vector<int> known;
  for (int i = 0; i < shared; ++i) {
    const EstimateStatus status = uncertainty.estimates[i].status;
    if (status != EstimateStatus::kUnidentifiable && status != EstimateStatus::kAtBound) {
      known.push_back(i);
    }
  }
  return known;
}

}  // namespace

ExperimentDesign DesignExperiments(const FitProblem& problem, const FitPoint& estimate,
                                   const Uncertainty& uncertainty, const ErrorParts& parts,
                                   const std::vector<CandidatePush>& candidates) {
  const std::vector<int> known = KnownParameters(uncertainty, problem.map().num_shared());
  ExperimentDesign design;
  design.studies = PlanStudies(problem, estimate, parts, known);
  design.kind = UsualKind(problem.recordings());
  for (int i : known) {
    design.parameters.push_back(uncertainty.estimates[i].name);
    design.units.push_back(uncertainty.estimates[i].unit);
    design.standard_error.push_back(uncertainty.estimates[i].standard_error);
  }
  const int size = static_cast<int>(known.size()), groups = parts.num_recordings();
  if (size == 0 || groups - 1 < size) {
    design.refused = "a design needs more recordings (" + std::to_string(groups) +
                     ") than free parameters (" + std::to_string(size) + ") plus one";
    return design;
  }
  const Eigen::MatrixXd now = parts.by_recording(known, known);
  const Eigen::MatrixXd present = Inverse(now);
  const Eigen::MatrixXd spread = SpreadRoot(now, parts.naive(known, known), groups);
  for (const CandidatePush& push : candidates) {
    const PendulumRecording candidate = MakeCandidate(problem, estimate, push, design.kind);
    if (Falls(candidate)) continue;
    const Eigen::MatrixXd jacobian =
        CandidateJacobian(problem, estimate, candidate)(Eigen::all, known);
    const Eigen::MatrixXd information =
        jacobian.transpose() * jacobian / (parts.sigma * parts.sigma);
    const Eigen::MatrixXd then = Inverse(present + WithSpread(information, spread));
    DesignRow row;
    row.push = push;
    for (int i = 0; i < size; ++i) row.error_ratio.push_back(std::sqrt(then(i, i) / now(i, i)));
    row.volume_ratio = std::pow(then.determinant() / now.determinant(), 0.5 / size);
    design.rows.push_back(row);
  }
  return design;
}

ExperimentDesign DesignExperiments(const std::vector<PendulumRecording>& recordings,
                                   const FitResult& result) {
  const FitProblem problem(recordings, result.options);
  const FitPoint& estimate = result.starts[result.best_start].to;
  return DesignExperiments(problem, estimate, result.uncertainty, ErrorPartsAt(problem, estimate),
                           DefaultCandidates(recordings));
}

Result<std::vector<DesignRow>> RankedRows(const ExperimentDesign& design,
                                          const std::string& parameter) {
  if (!design.refused.empty()) return Error{design.refused};
  const auto at = std::find(design.parameters.begin(), design.parameters.end(), parameter);
  if (parameter != "all" && at == design.parameters.end()) {
    std::string known = "all";
    for (const std::string& name : design.parameters) known += ", " + name;
    return Error{"there is no error of '" + parameter + "' to reduce; choose from " + known};
  }
  const size_t index = static_cast<size_t>(at - design.parameters.begin());
  const auto score = [&](const DesignRow& row) {
    return parameter == "all" ? row.volume_ratio : row.error_ratio[index];
  };
  std::vector<DesignRow> rows = design.rows;
  std::stable_sort(rows.begin(), rows.end(), [&score](const DesignRow& a, const DesignRow& b) {
    return score(a) < score(b);
  });
  return rows;
}

}  // namespace pushid
