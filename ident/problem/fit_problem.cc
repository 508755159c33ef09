// ident: what a problem knows of a point.
#include "ident/problem/fit_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/inspection/findings.h"
#include "ident/problem/own_axes.h"

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

void FitProblem::Weigh(const CostWeights& weights) {
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
        // Of options that pool something else since, those starts mean other parameters.
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

ModelOptions FitProblem::ModelAt(const FitPoint& point) const {
  ModelOptions model = options_.model;
  if (map_.num_weights == 0) return model;
  LearnedTerms network = *model.learned;
  network.weights = point.weights;
  model.learned = std::make_shared<const LearnedTerms>(std::move(network));
  return model;
}

Behaviour FitProblem::BehaviourAt(const FitPoint& point) const {
  const ModelOptions model = ModelAt(point);
  Behaviour all;
  for (const std::string& unit : SettlingUnits(point)) {
    const Behaviour one = ComputeBehaviour(model, Parameters(point, unit));
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

double FitProblem::DataCost(const FitPoint& point) const {
  if (options_.likelihood != Likelihood::kTrajectory) return 0.5 * DevianceAt(point).value;
  FitPoint copy = point;
  double cost = 0.0;
  for (const auto& [rollout, blocks] : Rollouts(*LayOut(0), &copy)) {
    if (rollout == nullptr) continue;
    Eigen::VectorXd values(rollout->num_residuals());
    if (!RolloutResiduals(*rollout, blocks.data(), values.data())) {
      return std::numeric_limits<double>::infinity();
    }
    cost += 0.5 * values.squaredNorm();
  }
  return cost;
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

}  // namespace pushid
