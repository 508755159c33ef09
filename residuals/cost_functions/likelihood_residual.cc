// residuals: densities by frame and person, and their rows with derivatives.
#include "residuals/cost_functions/likelihood_residual.h"

#include <ceres/jet.h>

#include <algorithm>
#include <limits>
#include <type_traits>

#include "residuals/jets/autodiff_rollout.h"

namespace pushid {
namespace {

constexpr int kLanes = 8;
using LaneJet = ceres::Jet<double, kLanes>;

// Step of a value on the fitted scale: the optimum is off by half of it, far less than any
// parameter is known to. Ten times smaller steps drown the Hessian of the uncertainty in rounding.
constexpr double kDifference = 3e-5;

// Whether a push on the person stands for all that its step shows.
bool PushedByNetForce(const Scene& scene, int person, int frame) {
  for (const ScenePush& push : scene.pushes) {
    if (push.person == person && push.kind != PushKind::kExternal && push.Active(frame)) {
      return true;
    }
  }
  return false;
}

// Velocities at the first frame are known exactly, at the others as measured.
template <typename T>
void Transitions(const LikelihoodProblem& problem, const std::vector<ParameterSet<T>>& parameters,
                 std::vector<GaussianDensity<T>>* densities) {
  const PendulumRecording& r = *problem.recording;
  const Scene& scene = r.scene;
  const T dt = T(scene.dt);
  SceneForces<T> forces(scene, problem.options, parameters);
  std::vector<PendulumState<T>> states(scene.num_people());
  std::vector<int> scratch;
  for (int t = 0; t + 1 < r.num_frames(); ++t) {
    for (int n = 0; n < scene.num_people(); ++n) {
      states[n] = {r.states[n][t].q.template cast<T>(), r.states[n][t].qd.template cast<T>()};
      if (t == 0) states[n].qd = scene.people[n].start.qd.template cast<T>();
    }
    forces.Update(states.data());
    for (int n = 0; n < scene.num_people(); ++n) {
      GaussianDensity<T>& density = (*densities)[t * scene.num_people() + n];
      density.measured =
          r.Weight(n, t) > 0.0 && r.Weight(n, t + 1) > 0.0 && !PushedByNetForce(scene, n, t);
      if (!density.measured) continue;
      forces.Prepare(n, &scratch);
      const Body& body = scene.people[n].body;
      const BodyOf<T> moving = DynamicBody<T>(problem.options, body, parameters[n], false);
      const PendulumState<T>& state = states[n];
      const NetForce<T> force = forces.On(n, t, states[n].qd);
      const Vector4<T> rate = r.states[n][t + 1].qd.template cast<T>() - state.qd;
      density.v = InverseDynamics<T>(moving, state, Vector4<T>(rate / dt)) - force.Total();
      density.lower = NoiseFactor<T>(body, parameters[n]) / T(std::sqrt(scene.dt));
    }
  }
}

template <typename T>
RolloutStatus Innovations(const LikelihoodProblem& problem,
                          const std::vector<ParameterSet<T>>& parameters,
                          std::vector<GaussianDensity<T>>* densities) {
  const PendulumRecording& r = *problem.recording;
  using Step = std::conditional_t<std::is_same_v<T, double>, JetStep, DualStep<T>>;
  PendulumFilter<T, Step> filter(r.scene, problem.options, parameters);
  for (int t = 0; t + 1 < r.num_frames(); ++t) {
    const RolloutStatus status = filter.Predict(t);
    if (!status.ok) return status;
    for (int n = 0; n < r.num_people(); ++n) {
      GaussianDensity<T>& density = (*densities)[t * r.num_people() + n];
      const double weight = r.Weight(n, t + 1);
      if (weight <= 0.0) continue;
      const auto innovation = filter.Update(n, r.states[n][t + 1].q, weight);
      density.measured = !PushedByNetForce(r.scene, n, t);
      if (!density.measured) continue;
      density.v = innovation.v;
      density.lower = innovation.lower;
    }
  }
  return {};
}

// One number of the natural scale that some people share, and the columns it belongs to.
struct Seed {
  int fitted = 0;
  int unit = -1;  // of the layout; negative: everybody
};

std::vector<Seed> SeedsOf(const LikelihoodProblem& problem) {
  std::vector<Seed> seeds;
  const int units = static_cast<int>(problem.layout.units.size());
  for (int i = 0; i < problem.map.num_shared(); ++i) {
    if (problem.map.fitted[i].deviation < 0 || problem.layout.num_deviations == 0) {
      seeds.push_back({i});
    } else {
      for (int unit = 0; unit < units; ++unit) seeds.push_back({i, unit});
    }
  }
  return seeds;
}

}  // namespace

LikelihoodProblem MakeLikelihoodProblem(Likelihood likelihood, const PendulumRecording& recording,
                                        const ModelOptions& options, const ParameterMap& map,
                                        double weight) {
  LikelihoodProblem problem;
  problem.likelihood = likelihood;
  problem.recording = &recording;
  problem.options = options;
  problem.map = map;
  problem.layout = LayoutOf(recording, map, false);
  problem.weight = weight;
  return problem;
}

template <typename T>
RolloutStatus Densities(const LikelihoodProblem& problem,
                        const std::vector<ParameterSet<T>>& parameters,
                        std::vector<GaussianDensity<T>>* densities) {
  densities->assign(problem.num_densities(), {});
  if (problem.likelihood == Likelihood::kInnovation) {
    return Innovations(problem, parameters, densities);
  }
  Transitions(problem, parameters, densities);
  return {};
}

Deviance DevianceOf(const LikelihoodProblem& problem,
                    const std::vector<ParameterSet<double>>& parameters) {
  Deviance deviance;
  std::vector<GaussianDensity<double>> densities;
  if (!Densities(problem, parameters, &densities).ok) {
    deviance.value = std::numeric_limits<double>::infinity();
    return deviance;
  }
  constexpr double kUnshifted[4] = {0.0, 0.0, 0.0, 0.0};
  for (const GaussianDensity<double>& d : densities) {
    if (!d.measured) continue;
    deviance.value += SolveLower<double, 4, 1>(d.lower, d.v).squaredNorm() +
                      2.0 * d.lower.diagonal().array().log().sum() -
                      2.0 * GaussianOffset<4>(kUnshifted);
    deviance.measured += 4;
  }
  return deviance;
}

LikelihoodResidual::LikelihoodResidual(LikelihoodProblem problem, double const* const* blocks,
                                       bool jets, double fall)
    : problem_(std::move(problem)), jets_(jets) {
  for (int size : problem_.layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(kGaussianRows * problem_.num_densities());
  std::vector<GaussianDensity<double>> densities;
  status_ =
      Densities(problem_, problem_.layout.Parameters<double>(problem_.map, blocks), &densities);
  for (const GaussianDensity<double>& d : densities) {
    for (int i = 0; i < 4; ++i) shift_.push_back(fall - std::log(d.lower(i, i)));
    if (d.measured) offset_ += GaussianOffset<4>(&shift_[shift_.size() - 4]);
  }
}

template <typename T>
bool LikelihoodResidual::Rows(const std::vector<ParameterSet<T>>& parameters,
                              std::vector<T>* rows) const {
  std::vector<GaussianDensity<T>> densities;
  if (!Densities(problem_, parameters, &densities).ok) return false;
  rows->assign(num_residuals(), T(0.0));
  for (size_t i = 0; i < densities.size(); ++i) {
    if (!densities[i].measured) continue;
    T* const at = rows->data() + kGaussianRows * i;
    if (!GaussianRows<T, 4>(densities[i].v, densities[i].lower, &shift_[4 * i], at)) return false;
    for (int row = 0; row < kGaussianRows; ++row) at[row] *= T(problem_.weight);
  }
  return true;
}

namespace {

// Adds a seed's derivatives, by row, to the columns that it belongs to.
template <typename Derivative>
void AddSeed(const LikelihoodProblem& problem, const Seed& seed, Derivative derivative,
             RowMajorMatrix* jacobian) {
  const ParameterMap& map = problem.map;
  const int deviation = seed.unit < 0 ? -1
                                      : map.num_shared() + seed.unit * map.num_deviations +
                                            map.fitted[seed.fitted].deviation;
  for (Eigen::Index row = 0; row < jacobian->rows(); ++row) {
    const double slope = derivative(row);
    (*jacobian)(row, seed.fitted) += slope;
    if (deviation >= 0) (*jacobian)(row, deviation) += slope;
  }
}

bool Moves(const LikelihoodProblem& problem, const Seed& seed, size_t person) {
  return seed.unit < 0 || seed.unit == problem.layout.unit_of_person[person];
}

}  // namespace

bool LikelihoodResidual::ByJets(const std::vector<ParameterSet<double>>& values,
                                RowMajorMatrix* jacobian) const {
  const std::vector<Seed> seeds = SeedsOf(problem_);
  for (size_t first = 0; first < seeds.size(); first += kLanes) {
    const size_t end = std::min(seeds.size(), first + kLanes);
    std::vector<ParameterSet<LaneJet>> parameters(values.size());
    for (size_t n = 0; n < values.size(); ++n) {
      for (int i = 0; i < kNumParameters; ++i) parameters[n][i] = LaneJet(values[n][i]);
      for (size_t s = first; s < end; ++s) {
        if (!Moves(problem_, seeds[s], n)) continue;
        const ParameterMap::Action a =
            problem_.map.ActionOf(seeds[s].fitted, problem_.layout.CovariatesOf(n));
        parameters[n][a.parameter].v[s - first] =
            a.by * TransformSlope(a.transform, values[n][a.parameter]);
      }
    }
    std::vector<LaneJet> rows;
    if (!Rows(parameters, &rows)) return false;
    for (size_t s = first; s < end; ++s) {
      AddSeed(
          problem_, seeds[s], [&](Eigen::Index row) { return rows[row].v[s - first]; }, jacobian);
    }
  }
  return true;
}

bool LikelihoodResidual::ByDifferences(const std::vector<ParameterSet<double>>& values,
                                       const std::vector<double>& rows,
                                       RowMajorMatrix* jacobian) const {
  for (const Seed& seed : SeedsOf(problem_)) {
    const ParameterMap::Action of_all = problem_.map.ActionOf(seed.fitted, nullptr);
    const double size = std::abs(ToFitted(of_all.transform, values[0][of_all.parameter]));
    const double step = kDifference * std::max(1.0, size);
    std::vector<ParameterSet<double>> moved = values;
    for (size_t n = 0; n < values.size(); ++n) {
      if (!Moves(problem_, seed, n)) continue;
      const ParameterMap::Action a =
          problem_.map.ActionOf(seed.fitted, problem_.layout.CovariatesOf(n));
      double& value = moved[n][a.parameter];
      value = ToNatural(a.transform, ToFitted(a.transform, value) + step * a.by);
    }
    std::vector<double> beside;
    if (!Rows(moved, &beside)) return false;
    AddSeed(
        problem_, seed, [&](Eigen::Index row) { return (beside[row] - rows[row]) / step; },
        jacobian);
  }
  return true;
}

bool LikelihoodResidual::Evaluate(double const* const* blocks, double* residuals,
                                  double** jacobians) const {
  if (!status_.ok) return false;
  const auto values = problem_.layout.Parameters<double>(problem_.map, blocks);
  std::vector<double> rows;
  if (!Rows(values, &rows)) return false;
  std::copy(rows.begin(), rows.end(), residuals);
  if (jacobians == nullptr) return true;
  RowMajorMatrix jacobian = RowMajorMatrix::Zero(num_residuals(), problem_.layout.num_columns());
  const bool steps = problem_.likelihood == Likelihood::kInnovation && !jets_;
  if (!(steps ? ByDifferences(values, rows, &jacobian) : ByJets(values, &jacobian))) return false;
  ScatterJacobian(jacobian, problem_.layout.BlockSizes(), 0, num_residuals(), jacobians);
  return true;
}

template RolloutStatus Densities<double>(const LikelihoodProblem&,
                                         const std::vector<ParameterSet<double>>&,
                                         std::vector<GaussianDensity<double>>*);

}  // namespace pushid
