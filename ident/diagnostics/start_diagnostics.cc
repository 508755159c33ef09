// ident: what can be said before a solve.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/diagnostics/diagnostics.h"
#include "ident/problem/jacobian_blocks.h"
#include "ident/solver/solver.h"

namespace pushid {
namespace {

constexpr double kNearbyWeight = 0.1;
constexpr double kNoEffect = 1e-12;                  // of the largest column, in typical sizes
constexpr double kNearby = 2.0;                      // factor of the second look
constexpr uint64_t kNearbySeed = 7;                  // fixed: the check is part of no random choice
constexpr double kMinMass = 15.0, kMaxMass = 250.0;  // kg
constexpr double kMinRod = 0.3, kMaxRod = 1.6;       // m
constexpr double kMinPush = 0.01, kMaxPush = 100.0;  // m/s^2, peak force over mass
constexpr double kSoonAfter = 0.25;                  // s
constexpr double kSeenToMove = 0.05;                 // m
constexpr double kAlong = 0.5;                       // of the way: within 60 degrees
constexpr double kMaxSpeed = 10.0;                   // m/s, of the hip
constexpr double kMinFps = 10.0, kMaxFps = 2000.0;

// Norms of the shared columns over the rows of data, per typical size of each parameter.
std::vector<double> ColumnNorms(const FitProblem& problem, FitPoint point) {
  const JacobianBlocks score = EvaluateJacobianBlocks(problem.Build(&point, 0));
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

std::vector<std::string> WithoutEffect(const FitProblem& problem, const FitPoint& point) {
  const std::vector<double> norms = ColumnNorms(problem, point);
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
  for (Parameter id : {kTailGain, kTailTorque, kTailTime, kTailExponent}) {
    options->table[id].free = options->table[id].pooled = false;
  }
}

MaybeError CheckEffects(const FitProblem& problem) {
  std::vector<std::string> names = WithoutEffect(problem, problem.NominalPoint());
  if (names.empty()) return std::nullopt;
  // A term may rest at the nominal values (a contact not reached, a network that begins without
  // any output) and act beside them.
  FitPoint nearby = RandomStart(problem, kNearby, kNearbySeed);
  Random random(kNearbySeed);
  for (double& weight : nearby.weights) weight += random.Uniform(-kNearbyWeight, kNearbyWeight);
  MoveOffBounds(problem, &nearby);
  const std::vector<std::string> still = WithoutEffect(problem, nearby);
  std::string list;
  for (const std::string& name : names) {
    if (std::find(still.begin(), still.end(), name) == still.end()) continue;
    list += (list.empty() ? "" : ",") + name;
  }
  if (list.empty()) return std::nullopt;
  return Error{list + (list.find(',') == std::string::npos ? " has" : " have") +
               " no effect on any of these recordings and cannot be fitted; use --fix=" + list};
}

namespace {

// How far the hip of a pushed person has gone when it is farthest from where the push found it,
// until shortly after the push, and along the push of that: where that is little, the axes, the
// push's sign or its start are wrong.
std::string AgainstThePush(const PendulumRecording& r, const ScenePush& push) {
  Eigen::Vector2d impulse = Eigen::Vector2d::Zero(), farthest = Eigen::Vector2d::Zero();
  for (const Vector4<double>& row : push.force) impulse += r.scene.dt * row.head<2>();
  if (!(impulse.norm() > 0.0)) return "";
  const int end = push.start_frame + static_cast<int>(push.force.size() + kSoonAfter / r.scene.dt);
  for (int t = push.start_frame; t < std::min(end + 1, r.num_frames()); ++t) {
    const Eigen::Vector2d way =
        (r.hip[push.person][t] - r.hip[push.person][push.start_frame]).head<2>();
    if (way.norm() > farthest.norm()) farthest = way;
  }
  const double along = farthest.dot(impulse.normalized());
  if (farthest.norm() < kSeenToMove || along >= kAlong * farthest.norm()) return "";
  return "pushed, the hip of person " + std::to_string(push.person) + " goes " +
         Rounded(farthest.norm(), 2) + " m, but " +
         (along < 0.0 ? "against the push" : "not along the push") +
         "; are up, forward and the push's sign and start right?";
}

}  // namespace

Warnings UnitWarnings(const std::vector<PendulumRecording>& recordings) {
  Warnings warnings;
  for (const PendulumRecording& r : recordings) {
    const auto tell = [&](const std::string& what) {
      warnings.emplace_back("recording " + r.id + ": " + what, r.id, what);
    };
    const auto warn = [&](double value, double lower, double upper, const std::string& what,
                          const std::string& hint) {
      if (value >= lower && value <= upper) return;
      tell(what + " is " + Rounded(value, 3) + "; " + hint);
    };
    const double fps = 1.0 / r.scene.dt;
    warn(fps, kMinFps, kMaxFps, "the frame rate in 1/s", "is fps really frames per second?");
    for (int n = 0; n < r.num_people(); ++n) {
      const std::string whose = " of person " + std::to_string(n);
      const Body& body = r.scene.people[n].body;
      warn(body.mass, kMinMass, kMaxMass, "the mass" + whose + " in kg", "is mass_kg in kg?");
      warn(body.rod_length, kMinRod, kMaxRod, "the rod" + whose + " (ankles to hip) in m",
           "is length_unit right?");
      double speed = 0.0;
      int fastest = 0;
      for (int t = 1; t < r.num_frames(); ++t) {
        const double now = (r.hip[n][t] - r.hip[n][t - 1]).norm() * fps;
        if (now > speed) speed = now, fastest = t;
      }
      warn(speed, 0.0, kMaxSpeed,
           "the hip's speed" + whose + " in m/s, at frame " + std::to_string(fastest) + ",",
           "are length_unit and fps right, or does a marker jump there?");
    }
    for (const ScenePush& push : r.scene.pushes) {
      double peak = 0.0;
      for (const Vector4<double>& row : push.force) peak = std::max(peak, row.head<2>().norm());
      warn(peak / r.scene.people[push.person].body.mass, kMinPush, kMaxPush,
           "the push's peak over the mass in m/s^2", "is the push in N?");
      const std::string against = AgainstThePush(r, push);
      if (!against.empty()) tell(against);
    }
  }
  return warnings;
}

StartDiagnostics DiagnoseStart(const FitProblem& problem, const SolveStart& start) {
  const Conditioning at_start = ComputeConditioning(problem, start.from);
  StartDiagnostics d;
  d.condition_number = at_start.condition_number;
  d.null_directions = at_start.null_directions;
  d.without_effect = WithoutEffect(problem, start.from);
  d.notes = start.notes;
  d.unit_warnings = UnitWarnings(problem.recordings());
  return d;
}

}  // namespace pushid
