// residuals: densities by frame and person, and their rows with derivatives.
#include "residuals/cost_functions/likelihood_residual.h"

#include <algorithm>
#include <limits>

#include "residuals/jets/autodiff_rollout.h"

namespace pushid {
namespace {

// Step of a column, where its parameter's value over its derivative is up to one: the optimum is
// off by half of it, far less than any parameter is known to. Ten times smaller steps drown the
// Hessian of the uncertainty in rounding.
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
  ModelStep<T> forces(scene, problem.options, parameters);
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

RolloutStatus Innovations(const LikelihoodProblem& problem,
                          const std::vector<ParameterSet<double>>& parameters,
                          std::vector<GaussianDensity<double>>* densities) {
  const PendulumRecording& r = *problem.recording;
  PendulumFilter filter(r.scene, problem.options, parameters,
                        StepByJets(r.scene, problem.options, parameters));
  for (int t = 0; t + 1 < r.num_frames(); ++t) {
    const RolloutStatus status = filter.Predict(t);
    if (!status.ok) return status;
    for (int n = 0; n < r.num_people(); ++n) {
      GaussianDensity<double>& density = (*densities)[t * r.num_people() + n];
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

RolloutStatus Densities(const LikelihoodProblem& problem,
                        const std::vector<ParameterSet<double>>& parameters,
                        std::vector<GaussianDensity<double>>* densities) {
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
                                       double fall)
    : problem_(std::move(problem)) {
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
bool LikelihoodResidual::RowsOf(const std::vector<GaussianDensity<T>>& densities,
                                std::vector<T>* rows) const {
  rows->assign(num_residuals(), T(0.0));
  for (size_t i = 0; i < densities.size(); ++i) {
    if (!densities[i].measured) continue;
    T* const at = rows->data() + kGaussianRows * i;
    if (!GaussianRows<T, 4>(densities[i].v, densities[i].lower, &shift_[4 * i], at)) return false;
    for (int row = 0; row < kGaussianRows; ++row) at[row] *= T(problem_.weight);
  }
  return true;
}

bool LikelihoodResidual::Rows(const std::vector<ParameterSet<double>>& parameters,
                              std::vector<double>* rows) const {
  std::vector<GaussianDensity<double>> densities;
  return Densities(problem_, parameters, &densities).ok && RowsOf(densities, rows);
}

bool LikelihoodResidual::ByJets(const SensitivityInputs& in, RowMajorMatrix* by_acting) const {
  for (int first = 0; first < by_acting->cols(); first += VectorJet::kColumns) {
    const int count = std::min<int>(VectorJet::kColumns, by_acting->cols() - first);
    std::vector<GaussianDensity<VectorJet>> densities(problem_.num_densities());
    Transitions(problem_, JetInputs(problem_.options, in, first).parameters, &densities);
    std::vector<VectorJet> rows;
    if (!RowsOf(densities, &rows)) return false;
    for (Eigen::Index row = 0; row < by_acting->rows(); ++row) {
      for (int k = 0; k < count; ++k) (*by_acting)(row, first + k) = rows[row].Slope(k);
    }
  }
  return true;
}

bool LikelihoodResidual::ByDifferences(const SensitivityInputs& in, const std::vector<double>& rows,
                                       RowMajorMatrix* by_acting) const {
  for (int column = 0; column < by_acting->cols(); ++column) {
    const auto of_column = [&](const auto& visit) {
      for (size_t n = 0; n < in.parameters.size(); ++n) {
        for (const ColumnEntry& entry : in.entries[n]) {
          if (entry.column == column && entry.derivative != 0.0) visit(n, entry);
        }
      }
    };
    double size = 1.0;
    of_column([&](size_t n, const ColumnEntry& entry) {
      size = std::max(size, std::abs(in.parameters[n][entry.parameter] / entry.derivative));
    });
    const double step = kDifference * size;
    std::vector<ParameterSet<double>> moved = in.parameters;
    of_column([&](size_t n, const ColumnEntry& entry) {
      moved[n][entry.parameter] += step * entry.derivative;
    });
    std::vector<double> beside;
    if (!Rows(moved, &beside)) return false;
    for (Eigen::Index row = 0; row < by_acting->rows(); ++row) {
      (*by_acting)(row, column) = (beside[row] - rows[row]) / step;
    }
  }
  return true;
}

bool LikelihoodResidual::Evaluate(double const* const* blocks, double* residuals,
                                  double** jacobians) const {
  if (!status_.ok) return false;
  const SensitivityInputs in =
      RolloutInputs(problem_.recording->scene, problem_.map, problem_.layout, blocks);
  std::vector<double> rows;
  if (!Rows(in.parameters, &rows)) return false;
  std::copy(rows.begin(), rows.end(), residuals);
  if (jacobians == nullptr) return true;
  RowMajorMatrix by_acting = RowMajorMatrix::Zero(num_residuals(), problem_.layout.num_acting());
  const bool filters = problem_.likelihood == Likelihood::kInnovation;
  if (!(filters ? ByDifferences(in, rows, &by_acting) : ByJets(in, &by_acting))) return false;
  ActingColumns(problem_.layout).Scatter(by_acting, 0, num_residuals(), jacobians);
  return true;
}

}  // namespace pushid
