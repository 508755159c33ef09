// ident: sums of parameters and their errors.
#include <algorithm>
#include <cmath>
#include <limits>

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/uncertainty.h"
#include "models/self_terms.h"

namespace pushid {

Combination Combine(const FitProblem& problem, const FitPoint& point,
                    const Uncertainty& uncertainty, const CombinationSpec& spec) {
  const std::vector<Term>& terms = spec.terms;
  const ParameterSet<double> values = problem.Parameters(point, "");
  const auto& fitted = problem.map().fitted;
  Combination result{spec.name, spec.unit};
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(uncertainty.covariance.rows());
  for (const Term& term : terms) {
    result.value += term.coefficient * values[term.parameter];
    for (size_t i = 0; i < fitted.size(); ++i) {
      if (fitted[i].parameter != term.parameter) continue;
      gradient[static_cast<Eigen::Index>(i)] +=
          term.coefficient * TransformSlope(fitted[i].transform, values[term.parameter]);
    }
  }
  // That of the term which is known least: a lower bound for the sum.
  double freedom = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < std::min(fitted.size(), uncertainty.estimates.size()); ++i) {
    if (gradient[static_cast<Eigen::Index>(i)] == 0.0) continue;
    freedom = std::min(freedom, uncertainty.estimates[i].freedom);
  }
  result.freedom = std::max(1.0, std::isfinite(freedom) ? freedom : uncertainty.freedom);
  const double quantile = StudentQuantile95(result.freedom);
  const double variance = gradient.dot(uncertainty.covariance * gradient);
  result.standard_error = std::sqrt(std::max(0.0, variance));
  result.lower95 = result.value - quantile * result.standard_error;
  result.upper95 = result.value + quantile * result.standard_error;
  if (terms.size() == 1) {
    // A multiple of one parameter has that parameter's interval, asymmetric where it is fitted as a
    // log.
    for (size_t i = 0; i < fitted.size(); ++i) {
      if (fitted[i].parameter != terms[0].parameter) continue;
      result.lower95 = terms[0].coefficient * uncertainty.estimates[i].lower95;
      result.upper95 = terms[0].coefficient * uncertainty.estimates[i].upper95;
    }
  }
  return result;
}

std::vector<CombinationSpec> DerivedCombinations(const ModelOptions& model) {
  const double m = (1.0 - kCartShare) * kReferenceMass, l = kReferenceRod;
  const double stiffness = 1.0 / (m * kGravity * l), damping = 1.0 / (m * l * l);
  const double by_mass = 1.0 / kReferenceMass;
  std::vector<CombinationSpec> combinations;
  const auto cart = [&](const char* over, const char* unit, double factor) {
    for (const CartDamping& c : CartDampings(model.friction)) {
      combinations.push_back(
          {std::string(c.name) + over, unit, {{c.friction, factor}, {c.gain, factor}}});
    }
  };
  cart("", "N s/m", 1.0);
  cart("/M", "1/s", by_mass);
  combinations.insert(combinations.end(), {{"Kp_theta/(m g l)", "1", {{kKpTheta, stiffness}}},
                                           {"Kp_phi/(m g l)", "1", {{kKpPhi, stiffness}}},
                                           {"Kd_theta/(m l^2)", "1/s", {{kKdTheta, damping}}},
                                           {"Kd_phi/(m l^2)", "1/s", {{kKdPhi, damping}}}});
  return combinations;
}

}  // namespace pushid
