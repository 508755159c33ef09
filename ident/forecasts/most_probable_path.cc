// ident: most probable paths: nodes, their action, and the solver.
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

constexpr int kLanes = 12;              // of Jets: three nodes
constexpr double kFurthestEnd = 100.0;  // m, m/s, rad/s
constexpr const char* kEndNames[] = {"x", "y", "theta", "phi", "xd", "yd", "thetad", "phid"};

using Nodes = std::vector<Vector4<double>>;  // q, frame by frame

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

// The initial path: a cubic from end to end.
Vector4<double> Between(const PathEnd& from, const PathEnd& to, double share, double seconds) {
  const Vector4<double> apart = to.state.q - from.state.q;
  const Vector4<double> leaving = seconds * from.state.qd;
  const Vector4<double> arriving = to.rates_held ? Vector4<double>(seconds * to.state.qd) : apart;
  const double s = share;
  return from.state.q + s * leaving + s * s * (3.0 * apart - 2.0 * leaving - arriving) +
         s * s * s * (leaving + arriving - 2.0 * apart);
}

// The states of the nodes, and the noise and the action of each frame between the ends.
void EvaluatePath(const SceneAction& action, const Nodes& nodes, ProbablePath* path) {
  const double dt = action.scene->dt;
  const int frames = static_cast<int>(nodes.size());
  path->states = RolloutPath<double>(frames, 1);
  path->noise = FrameTable<Vector4<double>>(frames, 1);
  for (int t = 0; t < frames; ++t) {
    const int before = std::max(0, t - 1), after = std::min(frames - 1, t + 1);
    path->states.At(t, 0).q = nodes[t];
    path->states.At(t, 0).qd = (nodes[after] - nodes[before]) / ((after - before) * dt);
    path->noise.At(t, 0).setZero();
    if (t == 0 || t + 1 == frames) continue;
    const double* const at[] = {nodes[t - 1].data(), nodes[t].data(), nodes[t + 1].data()};
    double rows[SceneAction::kRows];
    SceneAction of_frame = action;
    of_frame.frame = t;
    of_frame(at, rows);
    const Vector4<double> white(rows[0], rows[1], rows[2], rows[3]);
    path->noise_action += 0.5 * white.squaredNorm();
    path->divergence_action += 0.5 * rows[4] * rows[4] - kDivergenceShift;
    path->noise.At(t, 0) =
        NoiseFactor<double>(action.scene->people[0].body, action.parameters->front()) * white /
        std::sqrt(dt);
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
  const std::vector<ParameterSet<double>> parameters = {model.parameters};
  const SceneAction action = {&scene, &model.options, &parameters};
  Nodes nodes;
  const double seconds = (num_frames - 1) * scene.dt;
  for (int t = 0; t < num_frames; ++t) {
    nodes.push_back(Between(from, to, t / (num_frames - 1.0), seconds));
  }
  ceres::Problem problem;
  for (Vector4<double>& node : nodes) problem.AddParameterBlock(node.data(), 4);
  for (int t = 1; t + 1 < num_frames; ++t) {
    auto* at_frame = new SceneAction(action);
    at_frame->frame = t;
    auto* cost = new ceres::DynamicAutoDiffCostFunction<SceneAction, kLanes>(at_frame);
    for (int i = 0; i < 3; ++i) cost->AddParameterBlock(4);
    cost->SetNumResiduals(SceneAction::kRows);
    problem.AddResidualBlock(cost, nullptr,
                             {nodes[t - 1].data(), nodes[t].data(), nodes[t + 1].data()});
  }
  // The node next to an end holds its velocity.
  const auto hold = [&](size_t at, const Vector4<double>& q) {
    nodes[at] = q;
    problem.SetParameterBlockConstant(nodes[at].data());
  };
  hold(0, from.state.q);
  hold(1, from.state.q + scene.dt * from.state.qd);
  hold(num_frames - 1, to.state.q);
  if (to.rates_held) hold(num_frames - 2, to.state.q - scene.dt * to.state.qd);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = 200;
  solver.function_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (summary.termination_type != ceres::CONVERGENCE) {
    return Error{"no most probable path was found: " + summary.message};
  }
  ProbablePath path;
  EvaluatePath(action, nodes, &path);
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
  std::string text = "frame,time_s";
  for (const char* name : kEndNames) text += std::string(",p0_") + name;
  for (int i = 0; i < 4; ++i) text += std::string(",p0_noise_") + kEndNames[i];
  text += "\n";
  for (int t = 0; t < path.states.num_frames(); ++t) {
    text += std::to_string(t) + "," + DoubleText(t * dt);
    const PendulumState<double>& state = path.states.At(t, 0);
    for (const Vector4<double>& values : {state.q, state.qd, path.noise.At(t, 0)}) {
      for (const double value : values) text += "," + DoubleText(value);
    }
    text += "\n";
  }
  return WriteFileAtomically(file, text);
}

}  // namespace pushid
