// ident: running Ceres over the stages of a start.
#include "ident/solver/solver.h"

#include <ceres/iteration_callback.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/solver/network_training.h"
#include "ident/solver/summed_cost.h"

namespace pushid {
namespace {

// Stages before the last need not be exact: function tolerance, and how much larger than the
// last's.
constexpr double kOnTheWay = 1e-4, kLessExact = 3.0;
constexpr double kOffBound = 0.1;
// In a row, each of a smaller trust region: where people fall, or leave the model's domain.
constexpr int kInvalidSteps = 20;

class ProgressCallback : public ceres::IterationCallback {
 public:
  ProgressCallback(const SolveProgress& progress, std::string phase)
      : progress_(progress), phase_(std::move(phase)) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (progress_) progress_(phase_, summary.iteration, summary.cost);
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const SolveProgress& progress_;
  std::string phase_;
};

std::string HorizonName(int horizon) {
  return horizon == 0 ? "all frames" : std::to_string(horizon) + " frames";
}

ceres::LinearSolverType LinearSolverFor(int columns, bool has_network) {
  if (columns <= kDenseColumns) return ceres::DENSE_QR;
  return has_network ? ceres::DENSE_NORMAL_CHOLESKY : ceres::SPARSE_NORMAL_CHOLESKY;
}

// By secants where there are few columns; early stopping looks at the problem's own blocks.
ceres::Solver::Summary Minimize(FitProblem::Built* built, ceres::Solver::Options options,
                                StructuredSecants secants, RecordingSums* recordings) {
  ceres::Solver::Summary summary;
  // Recordings that are cut short at one point are not at another.
  const bool whole = recordings != nullptr && built->shortened.empty();
  auto summed = std::make_unique<SummedCost>(built, std::move(secants),
                                             whole ? *recordings : RecordingSums());
  if (recordings != nullptr) *recordings = {};
  if (summed->parameter_block_sizes()[0] > kDenseColumns || options.update_state_every_iteration) {
    ceres::Solve(options, built->problem.get(), &summary);
    return summary;
  }
  options.linear_solver_type = ceres::DENSE_QR;
  const SummedCost& cost = *summed;
  std::vector<double> x = cost.Values();
  ceres::Problem sum;
  sum.AddResidualBlock(summed.release(), nullptr, x.data());
  cost.SetBounds(&sum, x.data());
  ceres::Solve(options, &sum, &summary);
  cost.SetValues(x.data());
  if (whole) *recordings = cost.recordings();
  return summary;
}

}  // namespace

ceres::Solver::Options SolverOptions(const FitOptions& options, const ceres::Problem& problem) {
  ceres::Solver::Options solver;
  solver.linear_solver_type =
      LinearSolverFor(problem.NumParameters(), options.model.learned != nullptr);
  solver.dense_linear_algebra_library_type = ceres::EIGEN;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.parameter_tolerance = options.parameter_tolerance;
  // A step that does not descend shrinks the trust region. Ceres' search along it, which problems
  // with bounds get otherwise, takes a thousandth of the step, counts that as a success and only
  // halves the region: ten Jacobians where one would do.
  solver.max_num_line_search_step_size_iterations = 0;
  solver.max_num_consecutive_invalid_steps = kInvalidSteps;
  solver.num_threads = 1;  // evaluations have threads of their own (parallel_evaluation.h)
  solver.logging_type = ceres::SILENT;
  return solver;
}

SolveStage SolveBuilt(FitProblem::Built* built, const ceres::Solver::Options& options, int horizon,
                      std::string* message, StructuredSecants secants, RecordingSums* recordings) {
  const ceres::Solver::Summary summary = Minimize(built, options, std::move(secants), recordings);
  *message = summary.message;
  SolveStage stage;
  stage.horizon = horizon;
  stage.iterations = static_cast<int>(summary.iterations.size()) - 1;
  stage.initial_cost = summary.initial_cost - built->Offset();
  stage.final_cost = summary.final_cost - built->Offset();
  stage.converged = summary.termination_type == ceres::CONVERGENCE;
  stage.cramped = !summary.iterations.empty() && summary.iterations.back().trust_region_radius <
                                                     options.initial_trust_region_radius;
  for (const ceres::IterationSummary& i : summary.iterations) {
    if (i.cost == std::numeric_limits<double>::max()) continue;  // could not be evaluated
    stage.trace.push_back({horizon, i.iteration, i.cost - built->Offset(), i.gradient_max_norm});
  }
  return stage;
}

double CostAt(const FitProblem& problem, FitPoint point) {
  const FitProblem::Built built = problem.Build(&point, 0);
  if (built.rests_left_out > 0) return std::numeric_limits<double>::infinity();
  double cost = 0.0;
  built.problem->Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost - built.Offset();
}

// A network learns on top of a physical model that has converged without it, together with it.
void TrainNetwork(const FitProblem& problem, const std::string& label,
                  const SolveProgress& progress, SolveStart* start) {
  const FitOptions& options = problem.options();
  EarlyStoppingSplit split;
  if (options.early_stopping > 0.0) {
    const auto made = SplitForEarlyStopping(problem, options.early_stopping, options.seed);
    if (!made.ok()) {
      start->usable = false;
      start->message = made.error().ToString();
      return;
    }
    split = made.value();
  }
  const bool stop_early = !split.held_out.empty();
  const FitProblem training(problem.recordings(), options,
                            stop_early ? split.training : problem.counts());
  const FitProblem held_out(problem.recordings(), options, split.held_out);
  FitProblem::Built built = training.Build(&start->to, 0, false, options.num_threads);
  ceres::Solver::Options solver = SolverOptions(options, *built.problem);
  solver.function_tolerance = std::max(kNetworkTolerance, options.function_tolerance);
  ProgressCallback callback(progress, label + "network");
  if (progress) solver.callbacks.push_back(&callback);
  EarlyStopping stopping(held_out, &start->to);
  if (stop_early) {
    solver.callbacks.push_back(&stopping);
    solver.update_state_every_iteration = true;
  }
  const SolveStage stage = SolveBuilt(&built, solver, 0, &start->message, StructuredSecants(false));
  if (stop_early) start->to = stopping.best();
  start->stages.push_back(stage);
  start->iterations += stage.iterations;
  start->failed = problem.Failures(start->to, 0);
  // Of all recordings, whatever the training saw.
  start->cost = stop_early ? CostAt(problem, start->to) : stage.final_cost;
  start->converged = stage.converged || stopping.stopped();
  start->usable = start->converged || stage.final_cost < stage.initial_cost;
}

SolveStart SolveFrom(const FitProblem& problem, const FitPoint& from, const std::string& kind,
                     const std::string& label, const SolveProgress& progress) {
  const FitOptions& options = problem.options();
  SolveStart start;
  start.kind = kind;
  start.from = from;
  start.notes = MoveOffBounds(problem, &start.from);
  start.to = start.from;
  std::vector<int> horizons = options.horizons;
  if (horizons.empty() || horizons.back() != 0) horizons.push_back(0);

  for (size_t i = 0; i < horizons.size(); ++i) {
    const bool last = i + 1 == horizons.size();
    size_t left_out_before = std::numeric_limits<size_t>::max();
    // A recording that could not be rolled out to its end at the stage's start may well be after
    // it: the last stage is repeated, each time with more of it, until nothing changes.
    for (int attempt = 0; attempt < (last ? 5 : 1); ++attempt) {
      FitProblem::Built built = problem.Build(&start.to, horizons[i], true, options.num_threads);
      ceres::Solver::Options solver = SolverOptions(options, *built.problem);
      if (!last) {
        solver.function_tolerance = std::max(kOnTheWay, kLessExact * options.function_tolerance);
      }
      ProgressCallback callback(progress, label + HorizonName(horizons[i]));
      if (progress) solver.callbacks.push_back(&callback);
      const SolveStage stage =
          SolveBuilt(&built, solver, horizons[i], &start.message, StructuredSecants(false));
      start.stages.push_back(stage);
      start.iterations += stage.iterations;
      if (!last) break;
      start.failed = problem.Failures(start.to, 0);
      start.cost = stage.final_cost;
      start.converged = stage.converged;
      start.usable = stage.converged || stage.final_cost < stage.initial_cost;
      const size_t left_out = built.shortened.size() + built.rests_left_out;
      if (left_out == 0 || left_out >= left_out_before) break;
      left_out_before = left_out;
    }
  }
  if (!from.weights.empty()) TrainNetwork(problem, label, progress, &start);
  return start;
}

std::vector<std::string> MoveOffBounds(const FitProblem& problem, FitPoint* point) {
  std::vector<std::string> notes;
  for (size_t i = 0; i < point->shared.size(); ++i) {
    const ParameterSpec& spec = problem.options().table[problem.map().fitted[i].parameter];
    const double lower = ToFitted(spec.transform, spec.lower);
    const double upper = ToFitted(spec.transform, spec.upper);
    const double size = spec.transform == Transform::kIdentity ? spec.scale : 1.0;
    const double inwards = std::min(kOffBound * size, 0.5 * (upper - lower));
    double& value = point->shared[i];
    const double before = value;
    if (value <= lower) value = lower + inwards;
    if (value >= upper) value = upper - inwards;
    if (value == before) continue;
    notes.push_back(spec.name + " started on its bound " +
                    DoubleText(ToNatural(spec.transform, before)) + " and was moved to " +
                    DoubleText(ToNatural(spec.transform, value)));
  }
  return notes;
}

std::uint64_t RandomStartSeed(const FitOptions& options, int i) {
  return options.seed * 1000003u + static_cast<std::uint64_t>(i);
}

FitPoint RandomStart(const FitProblem& problem, double spread, uint64_t seed) {
  Random random(seed);
  FitPoint point = problem.NominalPoint();
  for (size_t i = 0; i < point.shared.size(); ++i) {
    const Transform transform = problem.map().fitted[i].transform;
    const double natural =
        ToNatural(transform, point.shared[i]) * std::pow(spread, random.Uniform(-1.0, 1.0));
    point.shared[i] = ToFitted(transform, natural);
  }
  return point;
}

Solution Solve(const FitProblem& problem, const SolveProgress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const FitOptions& options = problem.options();
  Solution solution;
  const int num_starts = std::max(1, options.num_starts);
  for (int i = 0; i < num_starts; ++i) {
    const std::string label =
        num_starts > 1 ? "start " + std::to_string(i + 1) + "/" + std::to_string(num_starts) + ", "
                       : "";
    const FitPoint from =
        i > 0 ? RandomStart(problem, options.start_spread, RandomStartSeed(options, i))
              : problem.NominalPoint();
    solution.starts.push_back(
        SolveFrom(problem, from, i > 0 ? "random" : "nominal", label, progress));
  }
  for (int i = 0; i < static_cast<int>(solution.starts.size()); ++i) {
    const SolveStart& tried = solution.starts[i];
    if (!tried.usable) continue;
    if (solution.best < 0 || tried.failed.size() < solution.Best().failed.size() ||
        (tried.failed.size() == solution.Best().failed.size() &&
         tried.cost < solution.Best().cost)) {
      solution.best = i;
    }
  }
  solution.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return solution;
}

}  // namespace pushid
