// ident: names, units and scales of the fitted numbers, and sums of them with their errors.

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/covariance.h"
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
  const ScatterOf of = uncertainty.scatter.Of(gradient);
  result.standard_error = of.standard_error;
  result.quantile = of.quantile;
  result.lower95 = result.value - of.HalfWidth();
  result.upper95 = result.value + of.HalfWidth();
  if (!uncertainty.these.empty()) {
    const ScatterOf these = uncertainty.these.Of(gradient);
    result.these = Interval{these.standard_error, result.value - these.HalfWidth(),
                            result.value + these.HalfWidth()};
  }
  if (terms.size() == 1) {
    // A multiple of one parameter has that parameter's interval, asymmetric where it is fitted as a
    // log.
    for (size_t i = 0; i < fitted.size(); ++i) {
      if (fitted[i].parameter != terms[0].parameter) continue;
      const double by = terms[0].coefficient;
      const Estimate& e = uncertainty.estimates[i];
      result.lower95 = by * e.lower95;
      result.upper95 = by * e.upper95;
      if (e.these) {
        result.these =
            Interval{by * e.these->standard_error, by * e.these->lower, by * e.these->upper};
      }
    }
  }
  return result;
}

std::vector<CombinationSpec> DerivedCombinations(const ModelOptions& model) {
  const bool slides = Acts(kMu, model);
  const bool at_hip = model.stance != Stance::kFixed;  // where the mass is
  const double m = (at_hip ? 1.0 - kCartShare : 1.0) * kReferenceMass, l = kReferenceRod;
  const double stiffness = 1.0 / (m * kGravity * l), damping = 1.0 / (m * l * l);
  const double by_mass = 1.0 / kReferenceMass;
  std::vector<CombinationSpec> combinations;
  const auto cart = [&](const char* over, const char* unit, double factor) {
    for (const CartDamping& c : CartDampings(model.friction)) {
      combinations.push_back(
          {std::string(c.name) + over, unit, {{c.friction, factor}, {c.gain, factor}}});
    }
  };
  if (slides) {
    cart("", "N s/m", 1.0);
    cart("/M", "1/s", by_mass);
  }
  // Of the mass at the hip, or of the whole body's where it turns about its ankles.
  const std::string mass = slides ? "m" : "M";
  const std::string load = "/(" + mass + " g l)", inertia = "/(" + mass + " l^2)";
  combinations.insert(combinations.end(), {{"Kp_theta" + load, "1", {{kKpTheta, stiffness}}},
                                           {"Kp_phi" + load, "1", {{kKpPhi, stiffness}}},
                                           {"Kd_theta" + inertia, "1/s", {{kKdTheta, damping}}},
                                           {"Kd_phi" + inertia, "1/s", {{kKdPhi, damping}}}});
  return combinations;
}

}  // namespace pushid
