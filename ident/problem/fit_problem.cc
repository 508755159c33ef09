// ident: what a problem knows of a point.
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

CostWeights FitProblem::weights() const {
  CostWeights weights{options_.sigmas, options_.effective_weight, options_.settling_weight, {}};
  for (const ParameterSpec& spec : options_.table.specs) {
    weights.pooling_sigma.push_back(spec.pooling_sigma);
  }
  return weights;
}

void FitProblem::SetWeights(const CostWeights& weights) {
  options_.sigmas = weights.sigmas;
  options_.effective_weight = weights.effective_weight;
  options_.settling_weight = weights.settling_weight;
  for (size_t i = 0; i < options_.table.specs.size(); ++i) {
    options_.table.specs[i].pooling_sigma = weights.pooling_sigma[i];
  }
  layouts_ = std::make_shared<Layouts>();
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
        const auto start = options_.start_deviations.find(unit);
        // Starts of options that pool something else since mean other parameters.
        const bool known = start != options_.start_deviations.end() &&
                           static_cast<int>(start->second.size()) == map_.num_deviations;
        point.unit[unit] = known ? start->second : std::vector<double>(map_.num_deviations, 0.0);
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

// A solver asks for the cost of a trial point, and for derivatives at an accepted one. Rollouts are
// evaluated once and remembered, whatever the threads.
void FitProblem::AddParameterBlocks(FitPoint* point, int num_threads, Built* built) const {
  built->evaluation = std::make_unique<ParallelEvaluation>(num_threads);
  ceres::Problem::Options problem;
  problem.evaluation_callback = built->evaluation.get();
  built->problem = std::make_unique<ceres::Problem>(problem);
  built->evaluation->set_problem(built->problem.get());
  auto add = [built](std::vector<double>* values) {
    built->problem->AddParameterBlock(values->data(), static_cast<int>(values->size()));
    built->parameter_blocks.push_back(values->data());
  };
  add(&point->shared);
  for (auto& [name, values] : point->unit) add(&values);
  for (auto& [index, values] : point->velocity) add(&values);
  if (map_.num_weights > 0) add(&point->weights);
  for (size_t i = 0; i < map_.fitted.size(); ++i) {
    const ParameterSpec& spec = Spec(i);
    const int index = static_cast<int>(i);
    built->problem->SetParameterLowerBound(point->shared.data(), index,
                                           ToFitted(spec.transform, spec.lower));
    built->problem->SetParameterUpperBound(point->shared.data(), index,
                                           ToFitted(spec.transform, spec.upper));
  }
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
  const std::vector<RolloutSums> sums = SumUp(side_by_side, rollouts, LaneSums::kSquares);
  for (size_t i = 0; i < rollouts.size(); ++i) {
    const auto& [problem, blocks] = rollouts[i];
    if (problem == nullptr || sums[i].ok) continue;
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

FitProblem::Built FitProblem::Build(FitPoint* point, int horizon, bool hold_network,
                                    int num_threads, bool all_inside) const {
  Built built;
  AddParameterBlocks(point, num_threads, &built);
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

  FamilyPlace place{*this, point, &built};
  const auto add = [&](ResidualFamily::Per per) {
    for (const ResidualFamily& family : ResidualFamilies()) {
      if (family.per == per && family.on(options_, horizon)) family.add(family, place);
    }
  };
  for (int i = 0; i < static_cast<int>(recordings().size()); ++i) {
    if (Count(i) == 0) continue;
    place.recording = i;
    add(ResidualFamily::kRecording);
  }
  add(ResidualFamily::kPoint);
  for (const std::string& unit : SettlingUnits(*point)) {
    place.unit = unit;
    add(ResidualFamily::kUnit);
  }
  if (hold_network && map_.num_weights > 0) {
    built.problem->SetParameterBlockConstant(point->weights.data());
  }
  return built;
}

namespace {

constexpr double kStagePrior = 5.0;  // factor on a log scale, multiple on the others

using Family = ResidualFamily;
using Place = FamilyPlace;
using Options = FitOptions;

bool Rolls(const Options& o) { return o.likelihood == Likelihood::kTrajectory; }

void AddTrajectory(const Family&, const Place& at) {
  const auto& [problem, blocks] = at.rollout();
  if (problem == nullptr) return;
  at.built->AddRollout(std::make_unique<CondensedRollout>(problem), blocks, at.recording);
}

void AddLikelihood(const Family&, const Place& at) {
  const FitProblem& problem = at.problem;
  const int i = at.recording;
  const std::vector<double*> blocks = problem.RecordingBlocks(at.point, i);
  auto residual = std::make_unique<LikelihoodResidual>(
      problem.LikelihoodOf(i, problem.Weight(i, 0)), blocks.data(), problem.fall_of_noise());
  if (!residual->status().ok) {
    at.built->shortened.push_back({i, residual->status()});
    return;
  }
  at.built->offsets[i] = problem.Count(i) * residual->offset();
  at.built->AddRollout(std::move(residual), blocks, i);
}

// On the i-th shared value, natural mean and sigma on the fitted scale.
void AddPrior(const Family& family, const Place& at, int i, double mean, double sigma) {
  const Transform transform = at.problem.map().fitted[i].transform;
  at.built->Add(std::make_unique<PriorResidual>(static_cast<int>(at.point->shared.size()), i,
                                                ToFitted(transform, mean), sigma),
                {at.point->shared.data()}, family.cluster);
}

void AddPriors(const Family& family, const Place& at) {
  for (int i = 0; i < static_cast<int>(at.point->shared.size()); ++i) {
    const ParameterSpec& spec = at.problem.Spec(i);
    if (!spec.prior) continue;
    AddPrior(family, at, i, spec.prior->mean,
             spec.prior->sigma / TransformSlope(spec.transform, spec.prior->mean));
  }
}

void AddPooling(const Family& family, const Place& at) {
  const ParameterMap& map = at.problem.map();
  for (auto& [name, values] : at.point->unit) {
    for (const FittedParameter& f : map.fitted) {
      if (f.deviation < 0) continue;
      at.built->Add(
          std::make_unique<PriorResidual>(map.num_deviations, f.deviation, 0.0,
                                          PoolingSigma(at.problem.options().table[f.parameter])),
          {values.data()}, family.cluster);
    }
  }
}

void AddNetworkPrior(const Family& family, const Place& at) {
  const int weights = at.problem.map().num_weights;
  if (weights == 0) return;
  at.built->Add(std::make_unique<RidgeResidual>(weights, at.problem.options().network_prior),
                {at.point->weights.data()}, family.cluster);
}

// A stage of few frames says nothing of some parameters: what has no prior gets one, so that it
// does not move to its bounds, from which later stages may not return.
void AddStagePriors(const Family& family, const Place& at) {
  for (int i = 0; i < static_cast<int>(at.point->shared.size()); ++i) {
    const ParameterSpec& spec = at.problem.Spec(i);
    if (spec.prior) continue;
    AddPrior(family, at, i, spec.nominal,
             spec.transform == Transform::kIdentity
                 ? kStagePrior * std::max(std::abs(spec.nominal), spec.scale)
                 : std::log(kStagePrior));
  }
}

void AddSettling(const Family& family, const Place& at) {
  const Options& o = at.problem.options();
  std::vector<double*> blocks = {at.point->shared.data()};
  if (!at.unit.empty()) blocks.push_back(at.point->unit[at.unit].data());
  if (at.problem.map().num_weights > 0) blocks.push_back(at.point->weights.data());
  // Whether they can be rolled out here: Ceres cannot start from a block that fails.
  const auto add = [&](const std::vector<Scene>& scenes) {
    auto residual = std::make_unique<SettlingResidual>(
        MakeSettlingProblem(scenes, o.model, at.problem.map(), o.settling_weight, at.unit));
    std::vector<double> values(residual->num_residuals());
    if (!residual->Evaluate(blocks.data(), values.data(), nullptr)) return false;
    at.built->AddRollout(std::move(residual), blocks, family.cluster);
    return true;
  };
  for (const std::vector<Scene>& scenes : SettlingScenes(o.model)) {
    if (HasLanes(scenes[0], o.model) && add(scenes)) continue;
    for (const Scene& scene : scenes) {
      if (!add({scene})) ++at.built->rests_left_out;
    }
  }
}

}  // namespace

const std::vector<ResidualFamily>& ResidualFamilies() {
  constexpr int kOwn = 0;  // the recording's
  static const std::vector<ResidualFamily> families = {
      {"trajectory", Family::kRecording, kOwn, [](const Options& o, int) { return Rolls(o); },
       AddTrajectory},
      {"likelihood", Family::kRecording, kOwn, [](const Options& o, int) { return !Rolls(o); },
       AddLikelihood},
      {"priors", Family::kPoint, FitProblem::kPriorCluster,
       [](const Options&, int) { return true; }, AddPriors},
      {"pooling", Family::kPoint, FitProblem::kPoolingCluster,
       [](const Options&, int) { return true; }, AddPooling},
      {"network prior", Family::kPoint, FitProblem::kNetworkCluster,
       [](const Options& o, int) { return o.network_prior > 0.0; }, AddNetworkPrior},
      {"stage priors", Family::kPoint, FitProblem::kPriorCluster,
       [](const Options&, int horizon) { return horizon != 0; }, AddStagePriors},
      {"settling", Family::kUnit, FitProblem::kSettlingCluster,
       [](const Options& o, int horizon) { return horizon == 0 && o.settling_weight > 0.0; },
       AddSettling},
  };
  return families;
}

namespace {

constexpr int kMaxSteps = 200;
constexpr double kSmallChange = 1e-3;       // of a spread, that ends the steps
constexpr double kLeastInformation = 1e-6;  // units' worth; below it nothing is known of a spread

// Hessian and gradient of the cost less the pooling priors, by deviation; everything else is
// integrated out.
struct DeviationPosterior {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient, at;  // the gradient at these deviations
};

DeviationPosterior IntegrateOut(const FitProblem& problem, const FitPoint& point,
                                const Eigen::VectorXd& pooling_precision) {
  const ResidualRows rows = EvaluateRows(problem, point);
  const std::vector<double> flat = point.Flat();
  const Eigen::Index shared = static_cast<Eigen::Index>(point.shared.size());
  const Eigen::Index deviations = pooling_precision.size();
  const Eigen::Index size = static_cast<Eigen::Index>(flat.size());
  // Deviations first, then the rest.
  Eigen::MatrixXd jacobian(rows.jacobian.rows(), size);
  jacobian << rows.jacobian.middleCols(shared, deviations), rows.jacobian.leftCols(shared),
      rows.jacobian.rightCols(size - shared - deviations);
  const Eigen::MatrixXd hessian = jacobian.transpose() * jacobian;
  const Eigen::VectorXd gradient = jacobian.transpose() * rows.residuals;

  const Eigen::Index rest = size - deviations;
  Eigen::MatrixXd nuisance = hessian.bottomRightCorner(rest, rest);
  nuisance.diagonal() *= 1.0 + 1e-12;  // a direction that nothing determines
  const Eigen::MatrixXd cross = hessian.bottomLeftCorner(rest, deviations);
  DeviationPosterior p;
  p.at = Eigen::Map<const Eigen::VectorXd>(flat.data() + shared, deviations);
  p.hessian = hessian.topLeftCorner(deviations, deviations) -
              cross.transpose() * SolveSymmetric(nuisance, cross) -
              Eigen::MatrixXd(pooling_precision.asDiagonal());
  p.gradient = gradient.head(deviations) -
               cross.transpose() * SolveSymmetric(nuisance, Eigen::VectorXd(gradient.tail(rest))) -
               pooling_precision.cwiseProduct(p.at);
  return p;
}

}  // namespace

double UpdatePoolingSpread(const FitProblem& problem, const FitPoint& point, CostWeights* weights) {
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
  const DeviationPosterior p = IntegrateOut(problem, point, precision());

  double change = 1.0;
  for (int step = 0; step < kMaxSteps && change > kSmallChange; ++step) {
    const Eigen::VectorXd prior = precision();
    const Eigen::MatrixXd hessian = p.hessian + Eigen::MatrixXd(prior.asDiagonal());
    const Eigen::MatrixXd covariance = SolveSymmetric(
        hessian, Eigen::MatrixXd(Eigen::MatrixXd::Identity(hessian.rows(), hessian.rows())));
    const Eigen::VectorXd mean = p.at - covariance * (p.gradient + prior.cwiseProduct(p.at));
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
    weights->pooling_sigma[ids[k]] = sigma[k] / typical[k];
  }
  return (sigma.cwiseQuotient(before).array() - 1.0).abs().maxCoeff();
}

}  // namespace pushid
