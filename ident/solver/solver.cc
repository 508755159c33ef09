// ident: running Ceres over the stages of a start.
#include "ident/solver/solver.h"

#include <ceres/iteration_callback.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "datasets/files/number_text.h"
#include "ident/problem/parallel.h"
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

// By secants where there are few columns.
ceres::Solver::Summary Minimize(FitProblem::Built* built, ceres::Solver::Options options,
                                StructuredSecants secants, RecordingSums* recordings) {
  ceres::Solver::Summary summary;
  // Recordings that are cut short at one point are not at another.
  const bool whole = recordings != nullptr && built->shortened.empty();
  auto summed = std::make_unique<SummedCost>(built, std::move(secants),
                                             whole ? *recordings : RecordingSums());
  if (recordings != nullptr) *recordings = {};
  if (summed->parameter_block_sizes()[0] > kDenseColumns) {
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
void TrainNetwork(const FitProblem& problem, const SolveProgress& progress, SolveStart* start) {
  const FitOptions& options = problem.options();
  FitProblem::Built built = problem.Build(&start->to, 0, false, options.num_threads);
  ceres::Solver::Options solver = SolverOptions(options, *built.problem);
  solver.function_tolerance = std::max(kNetworkTolerance, options.function_tolerance);
  ProgressCallback callback(progress, "network");
  if (progress) solver.callbacks.push_back(&callback);
  const SolveStage stage = SolveBuilt(&built, solver, 0, &start->message, StructuredSecants(false));
  start->Add(stage);
  start->failed = problem.Failures(start->to, 0);
  start->usable = start->converged || stage.final_cost < stage.initial_cost;
}

SolveStart SolveFrom(const FitProblem& problem, const FitPoint& from, const std::string& kind,
                     const SolveProgress& progress) {
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
      ProgressCallback callback(progress, HorizonName(horizons[i]));
      if (progress) solver.callbacks.push_back(&callback);
      const SolveStage stage =
          SolveBuilt(&built, solver, horizons[i], &start.message, StructuredSecants(false));
      start.Add(stage);
      if (!last) break;
      start.failed = problem.Failures(start.to, 0);
      start.usable = stage.converged || stage.final_cost < stage.initial_cost;
      const size_t left_out = built.shortened.size() + built.rests_left_out;
      if (left_out == 0 || left_out >= left_out_before) break;
      left_out_before = left_out;
    }
  }
  if (!from.weights.empty()) TrainNetwork(problem, progress, &start);
  return start;
}

std::vector<std::string> MoveOffBounds(const FitProblem& problem, FitPoint* point) {
  std::vector<std::string> notes;
  for (size_t i = 0; i < point->shared.size(); ++i) {
    const ParameterSpec& spec = problem.Spec(i);
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

Solution Solve(const FitProblem& problem, const SolveProgress& progress) {
  const double begin = Now();
  Solution solution{SolveFrom(problem, problem.NominalPoint(), "nominal", progress)};
  solution.seconds = Now() - begin;
  return solution;
}

FitOptions PhysicsAlone(FitOptions options) {
  const ModelOptions whole = options.model;
  options.model.learned = nullptr;
  options.model.interaction.learned = false;
  for (ParameterSpec& spec : options.table.specs) {
    const bool of_network = Acts(spec.id, whole) && !Acts(spec.id, options.model);
    if (of_network) spec.free = spec.pooled = false;
  }
  return options;
}

LargeNetworkTrainer& LargeNetworkTraining() {
  static LargeNetworkTrainer trainer = nullptr;
  return trainer;
}

Result<FitOptions> TrainLargeNetwork(const std::vector<PendulumRecording>& recordings,
                                     const FitOptions& options, const SolveProgress& progress) {
  if (LargeNetworkTraining() != nullptr) {
    return LargeNetworkTraining()(recordings, options, progress);
  }
  return Error{"this program trains no large networks: it is built without pushid_large_networks"};
}

namespace {

// Where demands begin and contacts close, steps shrink with the trust region until one is within
// the tolerance, which is no optimum: from such an end a fresh region goes on, without what secants
// learned, while it brings more than so many tolerances.
constexpr double kWorthAnother = 50.0;
constexpr int kMostFresh = 5;

}  // namespace

SolveStart Refit(const FitProblem& problem, const FitPoint& from, int num_threads,
                 RecordingSums known) {
  SolveStart start;
  start.kind = "warm";
  start.from = start.to = from;
  if (problem.options().likelihood != Likelihood::kTrajectory) {
    start.Add(SolveByBfgs(problem, &start.to, &start.message));
    start.usable = start.converged;
    return start;
  }
  start.recordings = std::move(known);
  const bool network = !from.weights.empty();
  const auto solve = [&] {
    const std::vector<double> at = start.to.Flat();
    const bool all_inside = start.recordings.AreAt(
        Eigen::Map<const Eigen::VectorXd>(at.data(), static_cast<Eigen::Index>(at.size())));
    FitProblem::Built built = problem.Build(&start.to, 0, false, num_threads, all_inside);
    ceres::Solver::Options solver = SolverOptions(problem.options(), *built.problem);
    if (network) solver.function_tolerance = std::max(kNetworkTolerance, solver.function_tolerance);
    start.Add(
        SolveBuilt(&built, solver, 0, &start.message, StructuredSecants(true), &start.recordings));
    start.failed = std::move(built.shortened);
  };
  solve();
  const double worth = kWorthAnother * problem.options().function_tolerance;
  for (int fresh = 0; !network && start.converged && fresh < kMostFresh; ++fresh) {
    const SolveStage& last = start.stages.back();
    if (!last.cramped || last.initial_cost - last.final_cost <= worth * last.initial_cost) break;
    solve();
  }
  start.usable = start.converged && start.failed.empty();
  return start;
}

}  // namespace pushid
