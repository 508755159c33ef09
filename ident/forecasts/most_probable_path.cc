// ident: nodes, their action, and the solver.
#include "ident/forecasts/most_probable_path.h"

#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "ident/model/model_rollout.h"
#include "ident/solver/solver.h"
#include "residuals/cost_functions/likelihood_residual.h"

namespace pushid {
namespace {

constexpr int kLanes = 12;              // of Jets: three nodes of one person
constexpr double kFurthestEnd = 100.0;  // m, m/s, rad/s
constexpr const char* kEndNames[] = {"x", "y", "theta", "phi", "xd", "yd", "thetad", "phid"};

// Nodes: q of everybody, frame by frame.
using Nodes = std::vector<std::vector<double>>;

struct PathProblem {
  const Scene* scene;
  ModelOptions options;
  std::vector<ParameterSet<double>> parameters;
  ceres::Problem problem;

  void AddActions(Nodes* nodes) {
    const int people = scene->num_people();
    for (std::vector<double>& node : *nodes) {
      problem.AddParameterBlock(node.data(), static_cast<int>(node.size()));
    }
    for (size_t t = 1; t + 1 < nodes->size(); ++t) {
      using Cost = ceres::DynamicAutoDiffCostFunction<SceneAction, kLanes>;
      auto* cost = new Cost(new SceneAction{scene, &options, &parameters, static_cast<int>(t)});
      for (int i = 0; i < 3; ++i) cost->AddParameterBlock(4 * people);
      cost->SetNumResiduals(SceneAction::kRows * people);
      problem.AddResidualBlock(
          cost, nullptr, {(*nodes)[t - 1].data(), (*nodes)[t].data(), (*nodes)[t + 1].data()});
    }
  }

  // Errors: no optimum, and why.
  MaybeError Solve(ProbablePath* path) {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = 200;
    solver.function_tolerance = 1e-12;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    path->iterations = static_cast<int>(summary.iterations.size()) - 1;
    if (summary.termination_type == ceres::CONVERGENCE) return std::nullopt;
    return Error{"no most probable path was found: " + summary.message};
  }
};

MaybeError CheckNoise(const IdentifiedModel& model) {
  const std::string file = model.source.empty() ? "the model" : model.source;
  if (model.options.process_noise == ProcessNoise::kNone) {
    return Error{file +
                 " has no process noise, without which no path is more probable than another; fit "
                 "it with --likelihood=innovation"};
  }
  for (int i = 0; i < 4; ++i) {
    if (model.parameters[kSigmaX + i] > 0.0) continue;
    return Error{file + " has no noise in " + model.table.specs[kSigmaX + i].name +
                 ": a path would be impossible or certain"};
  }
  return std::nullopt;
}

MaybeError CheckEnd(const char* which, const PathEnd& end) {
  for (int i = 0; i < 8; ++i) {
    const double value = i < 4 ? end.state.q[i] : end.state.qd[i - 4];
    const bool angle = i == 2 || i == 3;
    const double most = angle ? kMaxAngle : kFurthestEnd;
    if (std::isfinite(value) && std::abs(value) <= most) continue;
    return Error{std::string("--") + which + ": " + kEndNames[i] + " is " + Rounded(value, 4) +
                 ", outside the model's domain (" + Rounded(most, 3) + ")"};
  }
  return std::nullopt;
}

// Cubic from end to end: no noise is asked for that an end does not need.
Vector4<double> Between(const PathEnd& from, const PathEnd& to, double share, double seconds) {
  const Vector4<double> apart = to.state.q - from.state.q;
  const Vector4<double> leaving = seconds * from.state.qd;
  const Vector4<double> arriving = to.rates_held ? Vector4<double>(seconds * to.state.qd) : apart;
  const double s = share;
  return from.state.q + s * leaving + s * s * (3.0 * apart - 2.0 * leaving - arriving) +
         s * s * s * (leaving + arriving - 2.0 * apart);
}

void EvaluatePath(PathProblem* problem, const Nodes& nodes, ProbablePath* path) {
  const Scene& scene = *problem->scene;
  const int people = scene.num_people(), frames = static_cast<int>(nodes.size());
  path->states = RolloutPath<double>(frames, people);
  path->noise = FrameTable<Vector4<double>>(frames, people);
  for (int t = 0; t < frames; ++t) {
    const int before = std::max(0, t - 1), after = std::min(frames - 1, t + 1);
    for (int n = 0; n < people; ++n) {
      PendulumState<double>& state = path->states.At(t, n);
      for (int i = 0; i < 4; ++i) {
        state.q[i] = nodes[t][4 * n + i];
        state.qd[i] =
            (nodes[after][4 * n + i] - nodes[before][4 * n + i]) / ((after - before) * scene.dt);
      }
      path->noise.At(t, n).setZero();
    }
  }
  std::vector<double> rows(SceneAction::kRows * people);
  for (int t = 1; t + 1 < frames; ++t) {
    const double* const at[] = {nodes[t - 1].data(), nodes[t].data(), nodes[t + 1].data()};
    SceneAction{&scene, &problem->options, &problem->parameters, t}(at, rows.data());
    for (int n = 0; n < people; ++n) {
      const double* const own = rows.data() + SceneAction::kRows * n;
      const Vector4<double> white(own[0], own[1], own[2], own[3]);
      path->noise_action += 0.5 * white.squaredNorm();
      path->divergence_action += 0.5 * own[4] * own[4] - kDivergenceShift;
      path->noise.At(t, n) = NoiseFactor<double>(scene.people[n].body, problem->parameters[n]) *
                             white / std::sqrt(scene.dt);
    }
  }
}

}  // namespace

Result<ProbablePath> PathBetween(const IdentifiedModel& model, const Body& body, double fps,
                                 const PathEnd& from, const PathEnd& to, int num_frames) {
  if (MaybeError error = CheckNoise(model)) return *error;
  if (MaybeError error = CheckEnd("from", from)) return *error;
  if (MaybeError error = CheckEnd("to", to)) return *error;
  if (num_frames < 6) return Error{"--frames must be at least 6: two are fixed at each end"};
  Scene scene;
  scene.dt = 1.0 / fps;
  scene.people.push_back({body, {}});
  PathProblem problem{&scene, model.options, {model.parameters}, {}};
  Nodes nodes;
  const double seconds = (num_frames - 1) * scene.dt;
  for (int t = 0; t < num_frames; ++t) {
    const Vector4<double> q = Between(from, to, t / (num_frames - 1.0), seconds);
    nodes.emplace_back(q.data(), q.data() + 4);
  }
  problem.AddActions(&nodes);
  // A velocity is held by the node next to the end.
  const auto hold = [&](size_t at, const Vector4<double>& q) {
    nodes[at].assign(q.data(), q.data() + 4);
    problem.problem.SetParameterBlockConstant(nodes[at].data());
  };
  hold(0, from.state.q);
  hold(1, from.state.q + scene.dt * from.state.qd);
  hold(num_frames - 1, to.state.q);
  if (to.rates_held) hold(num_frames - 2, to.state.q - scene.dt * to.state.qd);
  ProbablePath path;
  if (MaybeError error = problem.Solve(&path)) return *error;
  EvaluatePath(&problem, nodes, &path);
  return path;
}

Result<PathEnd> ParsePathEnd(const std::string& flag, const std::string& text, bool always) {
  const Result<std::vector<NamedValue>> values = ParseAssignments(text, flag);
  if (!values.ok()) return values.error();
  PathEnd end;
  end.rates_held = always;
  for (const NamedValue& named : values.value()) {
    bool known = false;
    for (int i = 0; i < 8; ++i) {
      if (named.name != kEndNames[i]) continue;
      known = true;
      (i < 4 ? end.state.q[i] : end.state.qd[i - 4]) = named.value;
      if (i >= 4) end.rates_held = true;
    }
    if (known) continue;
    return Error{flag + " names '" + named.name +
                 "'; a state has x, y, theta, phi, xd, yd, thetad, phid"};
  }
  return end;
}

MaybeError WritePathCsv(const std::string& file, const ProbablePath& path, double dt) {
  const int people = path.states.num_people();
  std::string text = "frame,time_s";
  for (int n = 0; n < people; ++n) {
    for (const char* name : kEndNames) text += ",p" + std::to_string(n) + "_" + name;
    for (int i = 0; i < 4; ++i) text += ",p" + std::to_string(n) + "_noise_" + kEndNames[i];
  }
  text += "\n";
  for (int t = 0; t < path.states.num_frames(); ++t) {
    text += std::to_string(t) + "," + DoubleText(t * dt);
    for (int n = 0; n < people; ++n) {
      const PendulumState<double>& state = path.states.At(t, n);
      for (double value : state.q) text += "," + DoubleText(value);
      for (double value : state.qd) text += "," + DoubleText(value);
      for (double value : path.noise.At(t, n)) text += "," + DoubleText(value);
    }
    text += "\n";
  }
  return WriteFileAtomically(file, text);
}

}  // namespace pushid
