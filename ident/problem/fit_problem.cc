// ident: the blocks of a problem, its weights, and the spread of pooled units.
#include "ident/problem/fit_problem.h"

#include <Eigen/Core>
#include <cmath>

#include "datasets/inspection/findings.h"
#include "ident/parameters/presets.h"
#include "ident/problem/own_axes.h"
#include "ident/problem/residual_rows.h"
#include "models/decompositions.h"
#include "residuals/cost_functions/condensed_rollout.h"
#include "residuals/cost_functions/prior_residual.h"
#include "residuals/cost_functions/rest_residual.h"

namespace pushid {

FitProblem::FitProblem(const std::vector<PendulumRecording>& recordings, FitOptions options,
                       std::vector<int> counts)
    : turned_(InOwnAxes(recordings, options.model)),
      recordings_(turned_ == nullptr ? &recordings : turned_.get()),
      options_(std::move(options)),
      counts_(std::move(counts)),
      map_(options_.table.Map()) {
  const std::vector<int> copy_of = CopyOf(recordings);
  for (size_t i = 0; i < copy_of.size(); ++i) {
    if (copy_of[i] < 0) continue;
    counts_.resize(recordings.size(), 1);
    counts_[i] = 0;
  }
  map_.pool_by = options_.pool_by;
  if (options_.model.learned != nullptr && !options_.hold_network) {
    map_.num_weights = static_cast<int>(options_.model.learned->weights.size());
  }
}

FitProblem FitProblem::WithoutRecordings() const {
  FitProblem problem = *this;
  problem.counts_.assign(recordings().size(), 0);
  problem.layouts_ = std::make_shared<Layouts>();
  return problem;
}

FitPoint FitProblem::NominalPoint() const {
  FitPoint point;
  for (const FittedParameter& f : map_.fitted) {
    point.shared.push_back(ToFitted(f.transform, options_.table[f.parameter].nominal));
  }
  for (size_t i = 0; i < recordings().size(); ++i) {
    const PendulumRecording& recording = recordings()[i];
    if (map_.num_deviations > 0) {
      for (const std::string& unit : PoolingUnits(recording, map_.pool_by)) {
        point.unit[unit].assign(map_.num_deviations, 0.0);
      }
    }
    if (recording.initial_velocity != InitialVelocity::kFree) continue;
    std::vector<double>& velocity = point.velocity[static_cast<int>(i)];
    for (const ScenePerson& person : recording.scene.people) {
      velocity.insert(velocity.end(), person.start.qd.data(), person.start.qd.data() + 4);
    }
  }
  if (map_.num_weights > 0) point.weights = options_.model.learned->weights;
  return point;
}

std::optional<FitPoint> FitProblem::PointAt(std::vector<double> row) const {
  FitPoint point = NominalPoint();
  const size_t size = point.Flat().size();
  if (row.size() + point.weights.size() == size) {
    row.insert(row.end(), point.weights.begin(), point.weights.end());
  }
  if (row.size() != size) return std::nullopt;
  point.SetFlat(row);
  return point;
}

std::pair<double, double> FitProblem::Bounds(size_t fitted) const {
  const ParameterSpec& spec = Spec(fitted);
  return {ToFitted(spec.transform, spec.lower), ToFitted(spec.transform, spec.upper)};
}

ParameterSet<double> FitProblem::Parameters(const FitPoint& point, const std::string& unit) const {
  const auto found = point.unit.find(unit);
  return map_.Apply<double>(point.shared.data(),
                            found == point.unit.end() ? nullptr : found->second.data());
}

size_t FitProblem::FittedIndex(Parameter id) const {
  return static_cast<size_t>(
      std::find_if(map_.fitted.begin(), map_.fitted.end(),
                   [id](const FittedParameter& f) { return f.parameter == id; }) -
      map_.fitted.begin());
}

std::vector<double> FitProblem::SharedValues(const FitPoint& point) const {
  const ParameterSet<double> parameters = Parameters(point, "");
  std::vector<double> values;
  for (const FittedParameter& f : map_.fitted) values.push_back(parameters[f.parameter]);
  return values;
}

ModelOptions FitProblem::ModelAt(const FitPoint& point) const {
  ModelOptions model = options_.model;
  if (map_.num_weights == 0) return model;
  LearnedTerms network = *model.learned;
  network.weights = point.weights;
  model.learned = std::make_shared<const LearnedTerms>(std::move(network));
  return model;
}

Behaviour FitProblem::BehaviourAt(const FitPoint& point) const {
  ModelOptions model = ModelAt(point);
  GainScale scale;  // of a machine, whose gains are not those of the simulated people
  if (IsOneMachine(model)) {
    model.gain_scaling = GainScaling::kBody;
    scale = GainScale(GainScaling::kBody, recordings().front().scene.people.front().body);
  }
  Behaviour all;
  for (const std::string& unit : SettlingUnits(point)) {
    ParameterSet<double> parameters = Parameters(point, unit);
    for (Parameter id : {kKpTheta, kKpPhi}) parameters[id] /= scale.stiffness;
    for (Parameter id : {kKdTheta, kKdPhi}) parameters[id] /= scale.damping;
    const Behaviour one = ComputeBehaviour(model, parameters);
    if (unit.empty()) {
      all = one;
    } else {
      all.Add(one, unit);
    }
  }
  return all;
}

std::vector<std::string> FitProblem::SettlingUnits(const FitPoint& point) const {
  std::vector<std::string> units = {""};
  ModelOptions measured = options_.model;  // as the simulations' pushes are: without a tail
  measured.push_tail = PushTail::kNone;
  const bool differ =
      std::any_of(map_.fitted.begin(), map_.fitted.end(), [&measured](const FittedParameter& f) {
        return f.deviation >= 0 && Acts(f.parameter, measured);
      });
  if (!differ || !HoldsForRecording(map_.pool_by)) return units;
  for (const auto& [unit, deviations] : point.unit) units.push_back(unit);
  return units;
}

LikelihoodProblem FitProblem::LikelihoodOf(int recording, double weight) const {
  return MakeLikelihoodProblem(options_.likelihood, recordings()[recording], options_.model, map_,
                               weight);
}

Deviance FitProblem::DevianceAt(const FitPoint& point) const {
  Deviance sum;
  FitPoint copy = point;
  for (int i = 0; i < static_cast<int>(recordings().size()); ++i) {
    const LikelihoodProblem problem = LikelihoodOf(i, 1.0);
    const std::vector<double*> blocks = RecordingBlocks(&copy, i);
    const Deviance one =
        DevianceOf(problem, problem.layout.Parameters<double>(map_, blocks.data()));
    sum.value += Count(i) * one.value;
    sum.measured += Count(i) * one.measured;
  }
  return sum;
}

size_t FitProblem::NumMotionRows(int recording) const {
  const PendulumRecording& r = recordings()[recording];
  return static_cast<size_t>(r.num_frames() - 1) * r.num_people() * kFrameResiduals;
}

std::vector<double*> FitProblem::RecordingBlocks(FitPoint* point, int recording) const {
  return BlocksOf(point, recording, LayoutOf(recordings()[recording], map_, false));
}

std::vector<double*> FitProblem::BlocksOf(FitPoint* point, int recording,
                                          const BlockLayout& layout) const {
  std::vector<double*> blocks = {point->shared.data()};
  if (map_.num_deviations > 0) {
    for (const std::string& unit : layout.units) blocks.push_back(point->unit.at(unit).data());
  }
  const auto velocity = point->velocity.find(recording);
  if (velocity != point->velocity.end()) blocks.push_back(velocity->second.data());
  if (map_.num_weights > 0) blocks.push_back(point->weights.data());
  return blocks;
}

int PushFrame(const PendulumRecording& recording) {
  const Scene& scene = recording.scene;
  int first = recording.num_frames();
  for (const ScenePush& push : scene.pushes) first = std::min(first, push.start_frame);
  if (scene.ground.moves()) first = std::min(first, FirstMotion(scene.ground.poses));
  return first == recording.num_frames() ? 0 : first;
}

double FitProblem::Weight(int recording, int horizon) const {
  const double counted = std::sqrt(static_cast<double>(Count(recording)));
  if (options_.likelihood != Likelihood::kTrajectory) return counted;
  if (options_.effective_weight > 0.0) return counted * std::sqrt(options_.effective_weight);
  // A recording's frames are far from independent: together they count as one.
  const PendulumRecording& r = recordings()[recording];
  const int all = r.num_frames(),
            frames = horizon > 0 ? std::min(Frames(recording, horizon), all) : all;
  return counted / std::sqrt(std::max(1, frames - 1));
}

void FitProblem::Built::Add(std::unique_ptr<ceres::CostFunction> cost,
                            const std::vector<double*>& on, int cluster) {
  const ceres::CostFunction* const added = cost.get();
  blocks.push_back({problem->AddResidualBlock(cost.release(), nullptr, on), cluster, added});
}

void FitProblem::Built::AddRollout(std::unique_ptr<ceres::CostFunction> cost,
                                   const std::vector<double*>& on, int cluster) {
  const ceres::CostFunction* const inside = cost.get();
  Add(evaluation->Wrap(std::move(cost), on), on, cluster);
  blocks.back().cost = inside;
}

std::shared_ptr<const FitProblem::LaidOut> FitProblem::LayOut(int horizon) const {
  const std::lock_guard<std::mutex> lock(layouts_->mutex);
  std::shared_ptr<const LaidOut>& kept = layouts_->by_horizon[horizon];
  if (kept != nullptr) return kept;
  auto made = std::make_shared<LaidOut>();
  made->rollouts.resize(recordings().size());
  const bool rolls = options_.likelihood == Likelihood::kTrajectory;  // others roll nothing out
  for (int i = 0; rolls && i < static_cast<int>(recordings().size()); ++i) {
    if (Count(i) == 0) continue;
    made->rollouts[i].problem =
        MakeRolloutProblem(recordings()[i], options_.model, map_, options_.sigmas,
                           Weight(i, horizon), Frames(i, horizon), options_.derivatives);
  }
  made->side_by_side = PutSideBySide(made->rollouts);
  return kept = std::move(made);
}

std::vector<RolloutAt> FitProblem::Rollouts(const LaidOut& laid_out, FitPoint* point) const {
  std::vector<RolloutAt> rollouts = laid_out.rollouts;
  for (int i = 0; i < static_cast<int>(rollouts.size()); ++i) {
    const RolloutProblem* const problem = rollouts[i].problem.get();
    if (problem != nullptr) rollouts[i].blocks = BlocksOf(point, i, problem->layout);
  }
  return rollouts;
}

namespace {

std::vector<FailedRollout> FailuresOf(const std::vector<RolloutAt>& rollouts,
                                      const std::vector<SideBySide>& side_by_side) {
  std::vector<FailedRollout> failures;
  const auto sums = SumUp(side_by_side, rollouts, LaneSums::kSquares);
  for (size_t i = 0; i < rollouts.size(); ++i) {
    const auto& [problem, blocks] = rollouts[i];
    if (problem == nullptr || sums[i][0].ok) continue;
    RolloutPath<double> path;
    const RolloutStatus status = RollOut(*problem, blocks.data(), &path);
    if (!status.ok) failures.push_back({static_cast<int>(i), status});
  }
  return failures;
}

}  // namespace

std::vector<FailedRollout> FitProblem::Failures(const FitPoint& point, int horizon) const {
  FitPoint copy = point;
  const std::shared_ptr<const LaidOut> laid_out = LayOut(horizon);
  return FailuresOf(Rollouts(*laid_out, &copy), laid_out->side_by_side);
}

namespace {

constexpr double kStagePrior = 5.0;  // factor on a log scale, multiple on the others

// A solver asks for the cost of a trial point, and for derivatives at an accepted one. Rollouts are
// evaluated once and remembered, whatever the threads.
void AddParameterBlocks(const FitProblem& problem, FitPoint* point, int num_threads,
                        BuiltProblem* built) {
  built->evaluation = std::make_unique<ParallelEvaluation>(num_threads);
  ceres::Problem::Options options;
  options.evaluation_callback = built->evaluation.get();
  built->problem = std::make_unique<ceres::Problem>(options);
  built->evaluation->set_problem(built->problem.get());
  FitPoint::ForBlocks(*point, [built, point](std::vector<double>& values) {
    if (values.empty() && &values == &point->weights) return;
    built->problem->AddParameterBlock(values.data(), static_cast<int>(values.size()));
    built->parameter_blocks.push_back(values.data());
  });
  for (int i = 0; i < problem.map().num_shared(); ++i) {
    const auto [lower, upper] = problem.Bounds(i);
    built->problem->SetParameterLowerBound(point->shared.data(), i, lower);
    built->problem->SetParameterUpperBound(point->shared.data(), i, upper);
  }
}

void AddLikelihood(const FitProblem& problem, FitPoint* point, int i, BuiltProblem* built) {
  const std::vector<double*> blocks = problem.RecordingBlocks(point, i);
  auto residual = std::make_unique<LikelihoodResidual>(
      problem.LikelihoodOf(i, problem.Weight(i, 0)), blocks.data(), problem.fall_of_noise());
  if (!residual->status().ok) {
    built->shortened.push_back({i, residual->status()});
    return;
  }
  built->offsets[i] = problem.Count(i) * residual->offset();
  built->AddRollout(std::move(residual), blocks, i);
}

// The priors of the options. of_stage: a prior for each parameter that has none, in a stage of few
// frames, which says nothing of some: none moves to its bounds, from which later stages may not
// return.
void AddPriors(const FitProblem& problem, FitPoint* point, bool of_stage, BuiltProblem* built) {
  for (int i = 0; i < problem.map().num_shared(); ++i) {
    const ParameterSpec& spec = problem.Spec(i);
    if (spec.prior.has_value() == of_stage) continue;
    const double mean = of_stage ? spec.nominal : spec.prior->mean;
    const double sigma = !of_stage ? spec.prior->sigma / TransformSlope(spec.transform, mean)
                         : spec.transform == Transform::kIdentity
                             ? kStagePrior * std::max(std::abs(mean), spec.scale)
                             : std::log(kStagePrior);
    built->Add(std::make_unique<PriorResidual>(problem.map().num_shared(), i,
                                               ToFitted(spec.transform, mean), sigma),
               {point->shared.data()}, FitProblem::kPriorCluster);
  }
}

void AddPooling(const FitProblem& problem, FitPoint* point, BuiltProblem* built) {
  const ParameterMap& map = problem.map();
  for (auto& [name, values] : point->unit) {
    for (const FittedParameter& f : map.fitted) {
      if (f.deviation < 0) continue;
      built->Add(
          std::make_unique<PriorResidual>(map.num_deviations, f.deviation, 0.0,
                                          PoolingSigma(problem.options().table[f.parameter])),
          {values.data()}, FitProblem::kPoolingCluster);
    }
  }
}

// unit: of the people; empty: the shared parameters.
void AddSettling(const FitProblem& problem, FitPoint* point, const std::string& unit,
                 BuiltProblem* built) {
  const FitOptions& o = problem.options();
  std::vector<double*> blocks = {point->shared.data()};
  if (!unit.empty()) blocks.push_back(point->unit[unit].data());
  if (problem.map().num_weights > 0) blocks.push_back(point->weights.data());
  // Whether they can be rolled out here: Ceres cannot start from a block that fails.
  const auto add = [&](const std::vector<Scene>& scenes) {
    auto residual = std::make_unique<SettlingResidual>(
        MakeSettlingProblem(scenes, o.model, problem.map(), o.settling_weight, unit));
    std::vector<double> values(residual->num_residuals());
    if (!residual->Evaluate(blocks.data(), values.data(), nullptr)) return false;
    built->AddRollout(std::move(residual), blocks, FitProblem::kSettlingCluster);
    return true;
  };
  for (const std::vector<Scene>& scenes : SettlingScenes(o.model)) {
    if (HasLanes(scenes[0], o.model) && add(scenes)) continue;
    for (const Scene& scene : scenes) {
      if (!add({scene})) ++built->rests_left_out;
    }
  }
}

}  // namespace

// All that a fit minimizes. A new family of residuals is a call here, its cost function in a file
// of its own, and an option for its weight (ident/parameters/option_table.cc); solver, covariance,
// profiles and bootstrap take it from here.
FitProblem::Built FitProblem::Build(FitPoint* point, int horizon, bool hold_network,
                                    int num_threads, bool all_inside) const {
  Built built;
  AddParameterBlocks(*this, point, num_threads, &built);
  const std::shared_ptr<const LaidOut> laid_out = LayOut(horizon);
  built.rollouts = Rollouts(*laid_out, point);
  built.side_by_side = {laid_out, &laid_out->side_by_side};
  if (!all_inside) built.shortened = FailuresOf(built.rollouts, *built.side_by_side);
  for (const auto& [recording, status] : built.shortened) {
    std::shared_ptr<const RolloutProblem>& rollout = built.rollouts[recording].problem;
    auto shorter = std::make_shared<RolloutProblem>(*rollout);
    shorter->horizon = status.frame;
    rollout = status.frame == 1 ? nullptr : std::move(shorter);  // nothing is left to compare
  }
  if (!built.shortened.empty()) {
    built.side_by_side =
        std::make_shared<const std::vector<SideBySide>>(PutSideBySide(built.rollouts));
  }
  built.evaluation->set_side_by_side(built.side_by_side);

  for (int i = 0; i < static_cast<int>(recordings().size()); ++i) {
    const auto& [problem, blocks] = built.rollouts[i];
    if (Count(i) == 0) continue;
    if (options_.likelihood != Likelihood::kTrajectory) {
      AddLikelihood(*this, point, i, &built);
    } else if (problem != nullptr) {
      built.AddRollout(std::make_unique<CondensedRollout>(problem), blocks, i);
    }
  }
  AddPriors(*this, point, false, &built);
  AddPooling(*this, point, &built);
  if (options_.network_prior > 0.0 && map_.num_weights > 0) {
    built.Add(std::make_unique<PriorResidual>(map_.num_weights, 0, 0.0, options_.network_prior,
                                              map_.num_weights),
              {point->weights.data()}, kNetworkCluster);
  }
  if (horizon != 0) {
    AddPriors(*this, point, true, &built);
  } else if (options_.settling_weight > 0.0) {
    for (const std::string& unit : SettlingUnits(*point)) AddSettling(*this, point, unit, &built);
  }
  if (hold_network && map_.num_weights > 0) {
    built.problem->SetParameterBlockConstant(point->weights.data());
  }
  return built;
}

namespace {

constexpr int kMaxSteps = 200;
constexpr double kSmallChange = 1e-3;       // of a spread, that ends the steps
constexpr double kLeastInformation = 1e-6;  // units' worth; below it nothing is known of a spread

// Hessian and gradient of the cost less the pooling priors by the deviations `at`; everything else
// is integrated out.
SecondOrder IntegrateOut(const FitProblem& problem, const FitPoint& point,
                         const Eigen::VectorXd& pooling_precision, const Eigen::VectorXd& at) {
  const ResidualRows rows = EvaluateRows(problem, point);
  const Eigen::Index shared = static_cast<Eigen::Index>(point.shared.size());
  const Eigen::Index deviations = at.size(), size = rows.jacobian.cols();
  const Eigen::Index rest = size - deviations;
  // Deviations first, then the rest.
  Eigen::MatrixXd jacobian(rows.jacobian.rows(), size);
  jacobian << rows.jacobian.middleCols(shared, deviations), rows.jacobian.leftCols(shared),
      rows.jacobian.rightCols(rest - shared);
  const Eigen::MatrixXd hessian = jacobian.transpose() * jacobian;
  const Eigen::VectorXd gradient = jacobian.transpose() * rows.residuals;
  Eigen::MatrixXd nuisance = hessian.bottomRightCorner(rest, rest);
  nuisance.diagonal() *= 1.0 + 1e-12;  // a direction that nothing determines
  const Eigen::MatrixXd cross = hessian.bottomLeftCorner(rest, deviations);
  return {hessian.topLeftCorner(deviations, deviations) -
              cross.transpose() * SolveSymmetric(nuisance, cross) -
              Eigen::MatrixXd(pooling_precision.asDiagonal()),
          gradient.head(deviations) -
              cross.transpose() * SolveSymmetric(nuisance, Eigen::VectorXd(gradient.tail(rest))) -
              pooling_precision.cwiseProduct(at)};
}

}  // namespace

double UpdatePoolingSpread(const FitProblem& problem, const FitPoint& point, FitOptions* weights) {
  const ParameterMap& map = problem.map();
  if (map.num_deviations == 0 || problem.options().pooling_sigma) return 0.0;
  const Eigen::Index parameters = map.num_deviations;
  const Eigen::Index units = static_cast<Eigen::Index>(point.unit.size());
  Eigen::VectorXd typical(parameters), sigma(parameters);  // in PoolingSigma's units; fitted scale
  std::vector<Parameter> ids(parameters);
  for (const FittedParameter& f : map.fitted) {
    if (f.deviation < 0) continue;
    ids[f.deviation] = f.parameter;
    const ParameterSpec& spec = problem.options().table[f.parameter];
    sigma[f.deviation] = PoolingSigma(spec);
    typical[f.deviation] = PoolingSigma(spec) / spec.pooling_sigma;
  }
  const Eigen::VectorXd before = sigma;
  const auto precision = [&sigma, units]() -> Eigen::VectorXd {
    return sigma.array().square().inverse().matrix().replicate(units, 1);
  };
  Eigen::VectorXd at(units * parameters);
  Eigen::Index next = 0;
  for (const auto& [unit, deviations] : point.unit) {
    for (double deviation : deviations) at[next++] = deviation;
  }
  const SecondOrder p = IntegrateOut(problem, point, precision(), at);

  double change = 1.0;
  for (int step = 0; step < kMaxSteps && change > kSmallChange; ++step) {
    const Eigen::VectorXd prior = precision();
    const Eigen::MatrixXd hessian = p.information + Eigen::MatrixXd(prior.asDiagonal());
    const Eigen::MatrixXd covariance = SolveSymmetric(
        hessian, Eigen::MatrixXd(Eigen::MatrixXd::Identity(hessian.rows(), hessian.rows())));
    const Eigen::VectorXd mean = at - covariance * (p.gradient + prior.cwiseProduct(at));
    const Eigen::VectorXd last = sigma;
    for (Eigen::Index k = 0; k < parameters; ++k) {
      double squares = 0.0, known = 0.0;
      for (Eigen::Index u = 0; u < units; ++u) {
        const Eigen::Index i = u * parameters + k;
        squares += mean[i] * mean[i];
        known += 1.0 - covariance(i, i) * prior[i];
      }
      if (!(known > kLeastInformation) || !std::isfinite(squares)) continue;
      sigma[k] = std::clamp(std::sqrt(squares / known), kLeastPoolingSigma * typical[k],
                            kLargestPoolingSigma * typical[k]);
    }
    change = (sigma.cwiseQuotient(last).array() - 1.0).abs().maxCoeff();
  }
  for (Eigen::Index k = 0; k < parameters; ++k) {
    weights->table[ids[k]].pooling_sigma = sigma[k] / typical[k];
  }
  return (sigma.cwiseQuotient(before).array() - 1.0).abs().maxCoeff();
}

}  // namespace pushid
