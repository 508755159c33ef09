// ident: the table of residual families and how each adds its blocks.
#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "residuals/cost_functions/condensed_rollout.h"
#include "residuals/cost_functions/prior_residual.h"
#include "residuals/cost_functions/rest_residual.h"

namespace pushid {
namespace {

constexpr double kLeastDecay = 0.2;  // 1/s, asked of free modes at rest
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
      problem.LikelihoodOf(i, problem.Weight(i, 0)), blocks.data(), false, problem.fall_of_noise());
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
    const ParameterSpec& spec = at.problem.options().table[at.problem.map().fitted[i].parameter];
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
    const ParameterSpec& spec = at.problem.options().table[at.problem.map().fitted[i].parameter];
    if (spec.prior) continue;
    AddPrior(family, at, i, spec.nominal,
             spec.transform == Transform::kIdentity
                 ? kStagePrior * std::max(std::abs(spec.nominal), spec.scale)
                 : std::log(kStagePrior));
  }
}

std::vector<double*> UnitBlocks(const Place& at) {
  std::vector<double*> blocks = {at.point->shared.data()};
  if (!at.unit.empty()) blocks.push_back(at.point->unit[at.unit].data());
  return blocks;
}

void AddSettling(const Family& family, const Place& at) {
  const Options& o = at.problem.options();
  std::vector<double*> blocks = UnitBlocks(at);
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

void AddModes(const Family& family, const Place& at) {
  const Options& o = at.problem.options();
  const Body body = SettlingScene(kSettlingMass, 0.0).people[0].body;
  at.built->Add(std::make_unique<ModalStabilityResidual>(
                    o.model, body, at.problem.map(), kLeastDecay, o.mode_weight, !at.unit.empty()),
                UnitBlocks(at), family.cluster);
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
      {"modes", Family::kUnit, FitProblem::kSettlingCluster,
       [](const Options& o, int horizon) {
         return horizon == 0 && o.mode_weight > 0.0 && o.model.delay == Delay::kNone;
       },
       AddModes},
  };
  return families;
}

}  // namespace pushid
