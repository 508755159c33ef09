// ident: running Ceres over the stages of a start.
#include "ident/solver/solver.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>
#include <ceres/iteration_callback.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>

#include "datasets/files/number_text.h"
#include "ident/problem/parallel.h"
#include "ident/problem/residual_rows.h"
#include "ident/solver/structured_secants.h"
#include "models/decompositions.h"
#include "models/parameters.h"
#include "residuals/cost_functions/likelihood_residual.h"

namespace pushid {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

// Function tolerance where a network is fitted: a smaller one changes nothing that can be seen.
constexpr double kNetworkTolerance = 1e-6;
// Stages before the last need not be exact: function tolerance, and how much larger than the
// last's.
constexpr double kOnTheWay = 1e-4, kLessExact = 3.0;
constexpr double kOffBound = 0.1;
// Invalid steps in a row, each of a smaller trust region, in which people fall or leave the model's
// domain.
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

// Tolerances that a fresh trust region must bring to go on. Steps shrink where demands begin and
// contacts close, until one is within the tolerance without an optimum: a fresh region then starts
// from there, without what the secants learned.
constexpr double kWorthAnother = 50.0;
constexpr int kMostFresh = 5;

// Minimizes by secants where there are few columns.
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

// A stage of a start, from where it stands: what was built there. tolerance: the least.
FitProblem::Built SolveStageOf(const FitProblem& problem, int horizon, bool hold_network,
                               double tolerance, const std::string& phase,
                               const SolveProgress& progress, SolveStart* start) {
  const FitOptions& options = problem.options();
  FitProblem::Built built = problem.Build(&start->to, horizon, hold_network, options.num_threads);
  ceres::Solver::Options solver = SolverOptions(options, *built.problem);
  solver.function_tolerance = std::max(tolerance, solver.function_tolerance);
  ProgressCallback callback(progress, phase);
  if (progress) solver.callbacks.push_back(&callback);
  start->Add(SolveBuilt(&built, solver, horizon, &start->message, StructuredSecants(false)));
  const SolveStage& stage = start->stages.back();
  if (horizon != 0) return built;
  start->failed = problem.Failures(start->to, 0);
  start->usable = stage.converged || stage.final_cost < stage.initial_cost;
  return built;
}

}  // namespace

ceres::Solver::Options SolverOptions(const FitOptions& options, const ceres::Problem& problem) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = problem.NumParameters() <= kDenseColumns ? ceres::DENSE_QR
                              : options.model.learned != nullptr ? ceres::DENSE_NORMAL_CHOLESKY
                                                                 : ceres::SPARSE_NORMAL_CHOLESKY;
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

SolveStart SolveFrom(const FitProblem& problem, const FitPoint& from, const std::string& kind,
                     const SolveProgress& progress) {
  const FitOptions& options = problem.options();
  SolveStart start;
  start.kind = kind;
  start.from = from;
  start.notes = MoveOffBounds(problem, &start.from);
  start.to = start.from;
  for (int horizon : options.horizons) {
    if (horizon == 0) break;
    SolveStageOf(problem, horizon, true,
                 std::max(kOnTheWay, kLessExact * options.function_tolerance),
                 std::to_string(horizon) + " frames", progress, &start);
  }
  // A recording that could not be rolled out to its end at the stage's start may well be after it:
  // the last stage is repeated, each time with more of it, until nothing changes.
  size_t left_out_before = std::numeric_limits<size_t>::max();
  for (int attempt = 0; attempt < 5; ++attempt) {
    const FitProblem::Built built =
        SolveStageOf(problem, 0, true, 0.0, "all frames", progress, &start);
    const size_t left_out = built.shortened.size() + built.rests_left_out;
    if (left_out == 0 || left_out >= left_out_before) break;
    left_out_before = left_out;
  }
  // A network learns on top of a physical model that has converged without it, together with it.
  if (!from.weights.empty()) {
    SolveStageOf(problem, 0, false, kNetworkTolerance, "network", progress, &start);
  }
  return start;
}

std::vector<std::string> MoveOffBounds(const FitProblem& problem, FitPoint* point) {
  std::vector<std::string> notes;
  for (size_t i = 0; i < point->shared.size(); ++i) {
    const ParameterSpec& spec = problem.Spec(i);
    const auto [lower, upper] = problem.Bounds(i);
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
    const bool all_inside =
        start.recordings.AreAt(VectorXd::Map(at.data(), static_cast<Eigen::Index>(at.size())));
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

namespace {

constexpr int kMostRounds = 30;
constexpr double kSameCost = 1e-3;  // of a log likelihood, absolute
constexpr double kSettled = 0.01;   // relative change of a spread
// Noise starts too low rather than too high: rows end where it has fallen far, and never where it
// rises. Of what transitions leave, measured velocities err too.
constexpr double kShareOfNoise = 0.1;
// The likelihood of the noise has two basins: all roughness is force, or most of it errors of
// measurement.
constexpr double kMeasurementErrors[] = {3e-4, 3e-3};  // m

constexpr double kRoughRollouts = 1e-3;  // function tolerance

// Steps of Fisher scoring before BFGS.
constexpr int kScoringRounds = 3, kScoringSteps = 3;

// Root mean squares of what the model leaves of the transitions, as sigmas.
Vector4<double> SpreadOfTransitions(const FitProblem& problem, const FitPoint& point) {
  ParameterSet<double> p = problem.Parameters(point, "");
  for (int i = 0; i < 4; ++i) p[kSigmaX + i] = 1.0;
  Vector4<double> sum = Vector4<double>::Zero();
  int count = 0;
  for (const PendulumRecording& recording : problem.recordings()) {
    const LikelihoodProblem one = MakeLikelihoodProblem(
        Likelihood::kTransition, recording, problem.options().model, problem.map(), 1.0);
    std::vector<GaussianDensity<double>> densities;
    Densities(one, std::vector<ParameterSet<double>>(recording.num_people(), p), &densities);
    for (const GaussianDensity<double>& density : densities) {
      if (!density.measured) continue;
      sum += density.v.cwiseQuotient(density.lower.diagonal()).cwiseAbs2();
      ++count;
    }
  }
  return (sum / std::max(1, count)).cwiseSqrt();
}

// The problem with the noise's starts where the user has given no other, at the likelier of the
// errors of measurement; the point takes them.
FitProblem WithNoise(const FitProblem& problem, FitPoint* point) {
  const Vector4<double> spread = SpreadOfTransitions(problem, *point);
  std::optional<FitProblem> best;
  FitPoint best_point;
  double least = std::numeric_limits<double>::infinity();
  for (double error : kMeasurementErrors) {
    FitOptions options = problem.options();
    const auto start = [&options](Parameter id, double value, bool clamped) {
      ParameterSpec& spec = options.table[id];
      if (!spec.free || spec.nominal != kParameterRows[id].facts.nominal) return;
      spec.nominal = clamped ? std::clamp(value, 2.0 * spec.lower, 0.5 * spec.upper) : value;
    };
    for (int i = 0; i < 4; ++i) {
      start(static_cast<Parameter>(kSigmaX + i), kShareOfNoise * spread[i], true);
    }
    for (Parameter id : {kMeasuredCart, kMeasuredHip}) start(id, error, false);
    FitProblem with(problem.recordings(), std::move(options), problem.counts());
    FitPoint at = *point;
    const FitPoint nominal = with.NominalPoint();
    for (size_t i = 0; i < at.shared.size(); ++i) {
      if (IsNoiseParameter(with.Spec(i).id)) at.shared[i] = nominal.shared[i];
    }
    const double deviance = with.DevianceAt(at).value;
    if (best && !(deviance < least)) continue;
    least = deviance;
    best.emplace(std::move(with));
    best_point = std::move(at);
  }
  *point = std::move(best_point);
  return *std::move(best);
}

// BFGS, and the units' spread anew, in turns. Whether the likelihood stays.
bool SolveOn(FitProblem* problem, SolveStart* start) {
  for (int round = 0; round < kMostRounds; ++round) {
    FitOptions weights = problem->options();
    const double spread = UpdatePoolingSpread(*problem, start->to, &weights);
    problem->SetWeights(weights);
    const double before = start->cost;
    start->Add(SolveByBfgs(*problem, &start->to, &start->message));
    if (!std::isfinite(start->cost)) return false;
    const bool stays = std::abs(before - start->cost) < kSameCost && spread < kSettled;
    if (stays && start->converged) return true;
  }
  return false;
}

// The optimum of whole rollouts, roughly: from other values a likelihood of single steps may climb
// to a place where all roughness is force.
FitPoint RolloutStart(const FitProblem& problem) {
  FitOptions options = problem.options();
  options.likelihood = Likelihood::kTrajectory;
  options.function_tolerance = kRoughRollouts;
  const FitProblem rollouts(problem.recordings(), options, problem.counts());
  const FitPoint nominal = problem.NominalPoint();
  const SolveStart start = SolveFrom(rollouts, nominal, "nominal", nullptr);
  return start.usable ? start.to : nominal;
}

}  // namespace

Solution SolveByLikelihood(FitProblem* problem, const SolveProgress& progress) {
  const double begin = Now();
  Solution solution;
  FitPoint from = RolloutStart(*problem);
  FitProblem with_noise = WithNoise(*problem, &from);
  FitOptions own = with_noise.options();
  own.horizons = {0};
  own.max_iterations = kScoringSteps;
  const FitProblem whole(problem->recordings(), own, problem->counts());
  SolveStart& start = solution.start;
  start = SolveFrom(whole, from, "rollouts", progress);
  for (int round = 1; round < kScoringRounds; ++round) {
    start.to = SolveFrom(whole, start.to, start.kind, progress).to;
  }
  start.failed.clear();
  solution.settled = SolveOn(&with_noise, &start);
  start.usable = std::isfinite(start.cost);
  if (start.usable) *problem = std::move(with_noise);
  solution.seconds = Now() - begin;
  return solution;
}

LikelihoodScore ScoreByLikelihood(const FitProblem& problem, const FitPoint& point) {
  const Deviance deviance = problem.DevianceAt(point);
  return {deviance.value, deviance.measured, problem.map().num_shared()};
}

namespace {

// Information below which nothing depends on a number, as a share of the largest.
constexpr double kNoInformation = 1e-12;
// How far the logarithm of noise may fall: far.
constexpr double kAnyFall = 40.0;
constexpr double kNearBound = 1e-3;  // on the fitted scale
constexpr double kRidge = 1e-9;      // of the information's diagonal: directions may be unknown

// Bounds of every number of a point, in its order; those of units are open.
struct AllBounds {
  VectorXd lower, upper;

  AllBounds(const FitProblem& problem, Eigen::Index size)
      : lower(VectorXd::Constant(size, -HUGE_VAL)), upper(VectorXd::Constant(size, HUGE_VAL)) {
    for (size_t i = 0; i < problem.map().fitted.size(); ++i) {
      std::tie(lower[i], upper[i]) = problem.Bounds(i);
    }
  }
};

VectorXd FlatOf(const FitPoint& point) {
  const std::vector<double> flat = point.Flat();
  return VectorXd::Map(flat.data(), static_cast<Eigen::Index>(flat.size()));
}

void SetFlat(const VectorXd& flat, FitPoint* point) {
  point->SetFlat(std::vector<double>(flat.data(), flat.data() + flat.size()));
}

// The cost at the origin, for every row. The solver compares changes with the cost itself, and a
// negative log likelihood may be negative: counted from here it is not, as no row falls so far.
constexpr double kLevelOfRow = 1e3;
constexpr double kLeastChange = 1e-4;  // nats: changes below end the search

// The exact cost: half the squares of rows that do not end, but for a constant.
class WhitenedCost : public ceres::FirstOrderFunction {
 public:
  WhitenedCost(const FitProblem& problem, const FitPoint& at, const MatrixXd& root)
      : problem_(problem),
        point_(at),
        origin_(FlatOf(at)),
        root_(root),
        bounds_(problem, origin_.size()) {
    problem_.set_fall_of_noise(kAnyFall);
    built_ = problem_.Build(&point_, 0);
    double at_origin = 0.0;
    built_.problem->Evaluate({}, &at_origin, nullptr, nullptr, nullptr);
    level_ = kLevelOfRow * built_.problem->NumResiduals();
    shift_ = level_ - at_origin;
  }

  double level() const { return level_; }
  // A cost of the solver's less the negative log likelihood.
  double above() const { return shift_ + built_.Offset(); }

  VectorXd At(const double* z) const {
    return origin_ + root_ * Eigen::Map<const VectorXd>(z, root_.cols());
  }

  bool Evaluate(const double* z, double* cost, double* gradient) const override {
    const VectorXd x = At(z);
    if ((x.array() < bounds_.lower.array()).any() || (x.array() > bounds_.upper.array()).any()) {
      return false;
    }
    SetFlat(x, &point_);
    std::vector<double> by_x;
    if (!built_.problem->Evaluate({}, cost, nullptr, gradient != nullptr ? &by_x : nullptr,
                                  nullptr)) {
      return false;
    }
    *cost += shift_;
    if (gradient == nullptr) return true;
    Eigen::Map<VectorXd>(gradient, root_.cols()) =
        root_.transpose() * Eigen::Map<const VectorXd>(by_x.data(), x.size());
    return true;
  }
  int NumParameters() const override { return static_cast<int>(root_.cols()); }

 private:
  FitProblem problem_;
  mutable FitPoint point_;  // Ceres' problem looks at it
  VectorXd origin_;
  MatrixXd root_;
  AllBounds bounds_;
  double level_ = 0.0, shift_ = 0.0;
  mutable FitProblem::Built built_;
};

// R of the header at a point: a column for each number that moves.
MatrixXd RootOfInverse(const MatrixXd& information, const std::vector<int>& moving) {
  MatrixXd own = information(moving, moving);
  own.diagonal() *= 1.0 + kRidge;
  const MatrixXd factor = CholeskyFactor(own);
  if (factor.size() == 0) return {};
  MatrixXd root = MatrixXd::Zero(information.rows(), factor.cols());
  root(moving, Eigen::all) = Inverse(factor).transpose();
  return root;
}

}  // namespace

SolveStage SolveByBfgs(const FitProblem& problem, FitPoint* point, std::string* message) {
  SolveStage stage;
  stage.final_cost = HUGE_VAL;
  FitProblem fisher = problem;
  fisher.set_fall_of_noise(kFisherShift);
  const FitProblem::Built built = fisher.Build(point, 0);
  if (!built.shortened.empty()) {
    const FailedRollout& failed = built.shortened.front();
    *message = "the filter of recording " + problem.recordings()[failed.recording].id +
               " leaves the model's domain: " + std::string(failed.status.quantity) + " at frame " +
               std::to_string(failed.status.frame);
    return stage;
  }
  const ResidualRows score = EvaluateRows(built);
  const VectorXd x = FlatOf(*point), gradient = score.jacobian.transpose() * score.residuals;
  const AllBounds bounds(problem, x.size());
  const MatrixXd information = score.jacobian.transpose() * score.jacobian;
  const double nothing = kNoInformation * information.diagonal().maxCoeff();
  std::vector<int> moving;
  for (int i = 0; i < x.size(); ++i) {
    const bool at_bound = (x[i] < bounds.lower[i] + kNearBound && gradient[i] > 0.0) ||
                          (x[i] > bounds.upper[i] - kNearBound && gradient[i] < 0.0);
    if (!at_bound && information(i, i) > nothing) moving.push_back(i);
  }
  const MatrixXd root = RootOfInverse(information, moving);
  if (root.size() == 0) {
    *message = moving.empty() ? "no parameter changes the likelihood"
                              : "the Fisher information has no inverse";
    return stage;
  }
  auto* cost = new WhitenedCost(problem, *point, root);  // of the gradient problem
  const ceres::GradientProblem whitened(cost);
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::BFGS;
  options.max_num_iterations = problem.options().max_iterations;
  options.function_tolerance = kLeastChange / cost->level();
  options.logging_type = ceres::SILENT;
  std::vector<double> z(moving.size(), 0.0);
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, whitened, z.data(), &summary);
  *message = summary.message;
  stage.initial_cost = summary.initial_cost - cost->above();
  if (summary.IsSolutionUsable()) stage.final_cost = summary.final_cost - cost->above();
  stage.converged = summary.termination_type == ceres::CONVERGENCE;
  stage.iterations = static_cast<int>(summary.iterations.size()) - 1;
  for (const ceres::IterationSummary& i : summary.iterations) {
    stage.trace.push_back({0, i.iteration, i.cost - cost->above(), i.gradient_max_norm});
  }
  if (summary.IsSolutionUsable()) SetFlat(cost->At(z.data()), point);
  return stage;
}

}  // namespace pushid
