// ident: logistic regression of stepping on the predicted margin.
#include "ident/fit/step_probability.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "ident/model/model_rollout.h"
#include "ident/problem/own_axes.h"
#include "models/rollout.h"
#include "models/stance.h"

namespace pushid {
namespace {

// Half a foot's length tells standing from stepping: slopes beyond ten times its inverse are not
// known from any data there is.
constexpr double kPriorIntercept = 10.0, kPriorSlope = 200.0;  // standard deviations; 1/m
constexpr int kMostIterations = 50;
constexpr double kFarthestFitted = -0.1;  // m
constexpr double kLeastFactor = 1e-3, kMostFactor = 4.0;
constexpr double kAgainstNone = 1.0 / 500.0;  // of 1/f

Eigen::Vector2d Features(const StepOutcome& outcome) {
  return {1.0, std::max(outcome.margin, kFarthestFitted)};
}

// Newton's method on the log posterior, which is concave.
Eigen::Vector2d MostLikelyCoefficients(const std::vector<StepOutcome>& outcomes,
                                       Eigen::Matrix2d* hessian) {
  const Eigen::Vector2d precision(1.0 / (kPriorIntercept * kPriorIntercept),
                                  1.0 / (kPriorSlope * kPriorSlope));
  Eigen::Vector2d coefficients = Eigen::Vector2d::Zero();
  for (int i = 0; i < kMostIterations; ++i) {
    Eigen::Vector2d gradient = -precision.cwiseProduct(coefficients);
    *hessian = precision.asDiagonal();
    for (const StepOutcome& outcome : outcomes) {
      const Eigen::Vector2d x = Features(outcome);
      const double p = 1.0 / (1.0 + std::exp(-coefficients.dot(x)));
      gradient += ((outcome.stepped ? 1.0 : 0.0) - p) * x;
      *hessian += p * (1.0 - p) * x * x.transpose();
    }
    Eigen::Vector2d step = hessian->inverse() * gradient;
    // Far from the optimum the curvature says too little.
    step *= std::min(1.0, 50.0 / std::max(std::abs(step[0]) * 10.0, std::abs(step[1])));
    coefficients += step;
    if (step.norm() < 1e-10 * (1.0 + coefficients.norm())) break;
  }
  return coefficients;
}

// The margin of a support that goes with the cart.
double MarginOfPath(const ModelOptions& options, const ParameterSet<double>& parameters,
                    const ScenePerson& person, const RolloutPath<double>& path, int index) {
  const SelfForce self(options, person.body, person.start.q, 1.0);
  const StanceParameters<double> p(parameters);
  double most = 0.0;
  for (int t = 0; t < path.num_frames(); ++t) {
    const PendulumState<double>& state = path.At(t, index);
    const HipOverFeet<double> hip(self.standing, Angles<double>(state.q), state.qd);
    const Eigen::Vector2d xi =
        hip.Capture(self.standing) - Eigen::Vector2d(self.standing.rest[0], self.standing.rest[1]);
    most = std::max(most, SupportRatio<double>(p, xi, Eigen::Vector2d::Zero()));
  }
  return StepMargin(p.front, most);
}

// Whether somebody steps, or falls before that, with a support so many times as large: looked at no
// longer than until it is so.
bool StepsWith(double factor, int person, const ModelOptions& options,
               std::vector<ParameterSet<double>> parameters, const Scene& scene,
               RolloutPath<double>* path) {
  ParameterSet<double>& own = parameters[parameters.size() == 1 ? 0 : person];
  for (Parameter id : {kSupportFront, kSupportBack, kSupportSide}) own[id] *= factor;
  ModelStep<double> forces(scene, options, parameters);
  StartPath(scene, InitialVelocities(scene), path);
  for (int t = 0; t + 1 < path->num_frames(); ++t) {
    const RolloutStatus status = StepOn<double>(scene, &forces, t, path);
    if (!status.ok) return status.person == person;
    const FeetState<double>& feet = path->At(t + 1, person).feet;
    if (feet.landed != 0 || feet.swings != 0) return true;
  }
  return false;
}

}  // namespace

double StepMargin(double support, double factor) {
  const double f = std::max(factor, kLeastFactor);
  return support * (f - 1.0 - kAgainstNone * (1.0 / f - 1.0));
}

std::vector<double> StepMargins(const ModelOptions& options,
                                const std::vector<ParameterSet<double>>& parameters,
                                const PendulumRecording& recording,
                                const RolloutPath<double>& path) {
  constexpr int kHalvings = 12;
  std::vector<double> margins;
  if (options.stance != Stance::kSteps) {
    for (int n = 0; n < path.num_people(); ++n) {
      const ParameterSet<double>& own = parameters[parameters.size() == 1 ? 0 : n];
      margins.push_back(MarginOfPath(options, own, recording.scene.people[n], path, n));
    }
    return margins;
  }
  const Scene scene = SceneInOwnAxes(recording, options);
  if (scene.num_people() > kMostPeopleWithMargins) return {};
  RolloutPath<double> other(path.num_frames(), path.num_people());
  for (int n = 0; n < scene.num_people(); ++n) {
    double steps = std::log(kLeastFactor), stands = std::log(kMostFactor);
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (steps + stands);
      (StepsWith(std::exp(middle), n, options, parameters, scene, &other) ? steps : stands) =
          middle;
    }
    const ParameterSet<double>& own = parameters[parameters.size() == 1 ? 0 : n];
    margins.push_back(StepMargin(own[kSupportFront], std::exp(0.5 * (steps + stands))));
  }
  return margins;
}

std::optional<StepProbability> FitStepProbability(const std::vector<StepOutcome>& outcomes) {
  StepProbability fitted;
  fitted.tracks = static_cast<int>(outcomes.size());
  std::map<std::string, Eigen::Vector2d> scores;
  for (const StepOutcome& outcome : outcomes) {
    fitted.stepped += outcome.stepped ? 1 : 0;
    scores.try_emplace(outcome.person, Eigen::Vector2d::Zero());
  }
  if (outcomes.empty()) return std::nullopt;
  fitted.clusters = static_cast<int>(scores.size());
  Eigen::Matrix2d hessian;
  fitted.coefficients = MostLikelyCoefficients(outcomes, &hessian);
  if (!fitted.coefficients.allFinite()) return std::nullopt;  // no support, no margin
  for (const StepOutcome& outcome : outcomes) {
    const double error = (outcome.stepped ? 1.0 : 0.0) - fitted.At(outcome.margin);
    scores[outcome.person] += error * Features(outcome);
  }
  Eigen::Matrix2d meat = Eigen::Matrix2d::Zero();
  for (const auto& [person, score] : scores) meat += score * score.transpose();
  if (fitted.clusters > 1) meat *= fitted.clusters / (fitted.clusters - 1.0);
  const Eigen::Matrix2d inverse = hessian.inverse();
  fitted.covariance = inverse * meat * inverse;
  return fitted;
}

std::optional<StepProbability> FitStepProbability(
    const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings) {
  std::vector<StepOutcome> outcomes;
  for (const PendulumRecording& r : recordings) {
    if (!r.StepsKnown()) continue;
    const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, r);
    RolloutPath<double> path;
    if (!RolloutInOwnAxes(r, model.options, parameters, r.num_frames(), &path).ok) continue;
    const std::vector<double> margins = StepMargins(model.options, parameters, r, path);
    for (int n = 0; n < static_cast<int>(margins.size()); ++n) {
      outcomes.push_back({margins[n], r.Stepped(n), r.subject_ids[n]});
    }
  }
  return FitStepProbability(outcomes);
}

}  // namespace pushid
