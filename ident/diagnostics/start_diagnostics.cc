// ident: what can be said before a solve.
#include <algorithm>
#include <cmath>

#include "datasets/files/random.h"
#include "ident/diagnostics/diagnostics.h"
#include "ident/problem/residual_rows.h"
#include "ident/solver/solver.h"

namespace pushid {
namespace {

constexpr double kNearbyWeight = 0.1;
constexpr double kNoEffect = 1e-12;  // of the largest column, in typical sizes
constexpr double kNearby = 2.0;      // factor of the second look
constexpr uint64_t kNearbySeed = 7;  // fixed: the check is part of no random choice

// Norms of the shared columns over the rows of data, per typical size of each parameter.
std::vector<double> ColumnNorms(const FitProblem& problem, const FitPoint& point,
                                const ResidualRows& score) {
  std::vector<double> norms(point.shared.size(), 0.0);
  for (size_t i = 0; i < norms.size(); ++i) {
    const FittedParameter& f = problem.map().fitted[i];
    const double natural = ToNatural(f.transform, point.shared[i]);
    const double unit =
        problem.options().table[f.parameter].scale / TransformSlope(f.transform, natural);
    for (Eigen::Index row = 0; row < score.residuals.size(); ++row) {
      if (score.cluster_of_row[row] < 0) continue;
      const double entry = unit * score.jacobian(row, static_cast<Eigen::Index>(i));
      norms[i] += entry * entry;
    }
    norms[i] = std::sqrt(norms[i]);
  }
  return norms;
}

std::vector<std::string> WithoutEffect(const FitProblem& problem, const FitPoint& point,
                                       const ResidualRows& score) {
  const std::vector<double> norms = ColumnNorms(problem, point, score);
  double largest = 0.0;
  for (double norm : norms) largest = std::max(largest, norm);
  std::vector<std::string> names;
  for (size_t i = 0; i < norms.size(); ++i) {
    if (norms[i] > kNoEffect * largest) continue;
    names.push_back(problem.options().table[problem.map().fitted[i].parameter].name);
  }
  return names;
}

}  // namespace

bool TailCannotAct(const std::vector<PendulumRecording>& recordings) {
  for (const PendulumRecording& recording : recordings) {
    for (const ScenePush& push : recording.scene.pushes) {
      if (push.kind != PushKind::kExternal) return false;
    }
  }
  return true;
}

void HoldUnusedTail(const std::vector<PendulumRecording>& recordings, FitOptions* options) {
  if (!TailCannotAct(recordings)) return;
  for (Parameter id : {kTailGain, kTailTorque, kTailTime, kTailExponent, kTailBase}) {
    options->table[id].free = options->table[id].pooled = false;
  }
}

namespace {

// The nominal point with every free gain multiplied by kNearby^u, u uniform in [-1, 1].
FitPoint NearbyPoint(const FitProblem& problem) {
  Random random(kNearbySeed);
  FitPoint point = problem.NominalPoint();
  for (size_t i = 0; i < point.shared.size(); ++i) {
    const Transform transform = problem.map().fitted[i].transform;
    const double natural =
        ToNatural(transform, point.shared[i]) * std::pow(kNearby, random.Uniform(-1.0, 1.0));
    point.shared[i] = ToFitted(transform, natural);
  }
  return point;
}

}  // namespace

MaybeError CheckEffects(const FitProblem& problem) {
  const FitPoint nominal = problem.NominalPoint();
  std::vector<std::string> names = WithoutEffect(problem, nominal, EvaluateRows(problem, nominal));
  if (names.empty()) return std::nullopt;
  // A term may rest at the nominal values (a contact not reached, a network that begins without
  // any output) and act beside them.
  FitPoint nearby = NearbyPoint(problem);
  Random random(kNearbySeed);
  for (double& weight : nearby.weights) weight += random.Uniform(-kNearbyWeight, kNearbyWeight);
  MoveOffBounds(problem, &nearby);
  const std::vector<std::string> still =
      WithoutEffect(problem, nearby, EvaluateRows(problem, nearby));
  std::string list;
  for (const std::string& name : names) {
    if (std::find(still.begin(), still.end(), name) == still.end()) continue;
    list += (list.empty() ? "" : ",") + name;
  }
  if (list.empty()) return std::nullopt;
  const bool alone = std::all_of(problem.recordings().begin(), problem.recordings().end(),
                                 [](const PendulumRecording& r) { return r.num_people() == 1; });
  if (alone && problem.options().model.interaction.Any()) {
    return Error{"every recording has one person, and " + list +
                 " act only between people who touch; use --preset=tail"};
  }
  return Error{list + (list.find(',') == std::string::npos ? " has" : " have") +
               " no effect on any of these recordings and cannot be fitted; use --fix=" + list};
}

StartDiagnostics DiagnoseStart(const FitProblem& problem, const SolveStart& start) {
  const ResidualRows score = EvaluateRows(problem, start.from);
  const Conditioning at_start = ComputeConditioning(problem, start.from, score);
  return {at_start.condition_number, at_start.null_directions,
          WithoutEffect(problem, start.from, score), start.notes,
          FitFindings(FindingsOf(problem.recordings()))};
}

}  // namespace pushid
