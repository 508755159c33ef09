// ident: rounds of building and solving by a likelihood.
#include "ident/solver/likelihood_solve.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/parallel.h"
#include "ident/problem/residual_rows.h"
#include "ident/solver/solver.h"
#include "models/decompositions.h"
#include "models/parameters.h"
#include "residuals/cost_functions/likelihood_residual.h"

namespace pushid {

namespace {

constexpr int kMostRounds = 30;
constexpr double kSameCost = 1e-3;  // of a log likelihood, absolute
constexpr double kSettled = 0.01;   // relative change of a spread
// Noise starts too low rather than too high: rows end where it has fallen far, and never where it
// rises. Of what transitions leave, measured velocities err too.
constexpr double kShareOfNoise = 0.1;
constexpr double kLowMeasurementError = 3e-4;  // m
// The likelihood of the noise has two basins: all roughness is force, or most of it errors of
// measurement.
constexpr double kMeasurementErrors[] = {kLowMeasurementError, 3e-3};

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

bool GivenByUser(const ParameterSpec& spec) {
  return spec.nominal != AllParameterFacts()[spec.id].nominal;
}

// Where the user has given no other start; error: of measurement, m.
void StartNoise(const FitProblem& problem, const FitPoint& point, double error,
                FitOptions* options) {
  const Vector4<double> spread = SpreadOfTransitions(problem, point);
  for (int i = 0; i < 4; ++i) {
    ParameterSpec& spec = options->table.specs[kSigmaX + i];
    if (!spec.free || GivenByUser(spec)) continue;
    spec.nominal = std::clamp(kShareOfNoise * spread[i], 2.0 * spec.lower, 0.5 * spec.upper);
  }
  for (Parameter id : {kMeasuredCart, kMeasuredHip}) {
    ParameterSpec& spec = options->table[id];
    if (spec.free && !GivenByUser(spec)) spec.nominal = error;
  }
}

// The noise's starts, at a point of the other parameters.
void TakeNoise(const FitProblem& problem, FitPoint* point) {
  const FitPoint nominal = problem.NominalPoint();
  for (size_t i = 0; i < point->shared.size(); ++i) {
    if (IsNoiseParameter(problem.Spec(i).id)) point->shared[i] = nominal.shared[i];
  }
}

// With the likelier of the noise's starts, which the point takes.
FitProblem WithNoise(const FitProblem& problem, FitPoint* point) {
  std::optional<FitProblem> best;
  FitPoint best_point;
  double least = std::numeric_limits<double>::infinity();
  for (double error : kMeasurementErrors) {
    FitOptions options = problem.options();
    StartNoise(problem, *point, error, &options);
    FitProblem with(problem.recordings(), std::move(options), problem.counts());
    FitPoint at = *point;
    TakeNoise(with, &at);
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
    CostWeights weights = problem->weights();
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

LikelihoodSolution SolveByLikelihood(FitProblem* problem, const SolveProgress& progress) {
  const double begin = Now();
  LikelihoodSolution solved;
  FitPoint from = RolloutStart(*problem);
  FitProblem with_noise = WithNoise(*problem, &from);
  FitOptions own = with_noise.options();
  own.horizons = {0};
  own.max_iterations = kScoringSteps;
  const FitProblem whole(problem->recordings(), own, problem->counts());
  SolveStart& start = solved.solution.start;
  start = SolveFrom(whole, from, "rollouts", progress);
  for (int round = 1; round < kScoringRounds; ++round) {
    start.to = SolveFrom(whole, start.to, start.kind, progress).to;
  }
  start.failed.clear();
  solved.stays = SolveOn(&with_noise, &start);
  start.usable = std::isfinite(start.cost) && start.failed.empty();
  if (start.usable) *problem = std::move(with_noise);
  solved.solution.seconds = Now() - begin;
  return solved;
}

LikelihoodScore ScoreByLikelihood(const FitProblem& problem, const FitPoint& point) {
  const Deviance deviance = problem.DevianceAt(point);
  return {deviance.value, deviance.measured, problem.map().num_shared()};
}

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

// Information below which nothing depends on a number, as a share of the largest.
constexpr double kNoInformation = 1e-12;
// How far the logarithm of noise may fall: far.
constexpr double kAnyFall = 40.0;
constexpr double kNearBound = 1e-3;  // on the fitted scale
constexpr double kRidge = 1e-9;      // of the information's diagonal: directions may be unknown

// Bounds of every number of a point, in its order; those of units are open.
struct Bounds {
  VectorXd lower, upper;
};

Bounds BoundsOf(const FitProblem& problem, Eigen::Index size) {
  Bounds bounds{VectorXd::Constant(size, -HUGE_VAL), VectorXd::Constant(size, HUGE_VAL)};
  for (size_t i = 0; i < problem.map().fitted.size(); ++i) {
    const ParameterSpec& spec = problem.Spec(i);
    bounds.lower[i] = ToFitted(spec.transform, spec.lower);
    bounds.upper[i] = ToFitted(spec.transform, spec.upper);
  }
  return bounds;
}

VectorXd FlatOf(const FitPoint& point) {
  const std::vector<double> flat = point.Flat();
  return Eigen::Map<const VectorXd>(flat.data(), static_cast<Eigen::Index>(flat.size()));
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
        bounds_(BoundsOf(problem, origin_.size())) {
    problem_.set_fall_of_noise(kAnyFall);
    built_ = problem_.Build(&point_, 0);
    double at_origin = 0.0;
    built_.problem->Evaluate({}, &at_origin, nullptr, nullptr, nullptr);
    level_ = kLevelOfRow * built_.problem->NumResiduals();
    shift_ = level_ - at_origin;
  }

  double level() const { return level_; }
  // What a cost of the solver's is above the negative log likelihood.
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
  Bounds bounds_;
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
  const Bounds bounds = BoundsOf(problem, x.size());
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
