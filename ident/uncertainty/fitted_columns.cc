// ident: names, units and scales of the fitted numbers.
#include "ident/uncertainty/fitted_columns.h"

#include <algorithm>

namespace pushid {

std::vector<FittedColumn> FittedColumns(const FitProblem& problem, const FitPoint& point) {
  std::vector<FittedColumn> columns;
  const ParameterTable& table = problem.options().table;
  const auto& fitted = problem.map().fitted;
  for (size_t i = 0; i < fitted.size(); ++i) {
    const ParameterSpec& spec = table[fitted[i].parameter];
    FittedColumn c{spec.name, spec.unit, spec.transform, spec.scale, point.shared[i], 0.0, false};
    c.natural = ToNatural(spec.transform, c.fitted);
    const double lower = ToFitted(spec.transform, spec.lower);
    const double upper = ToFitted(spec.transform, spec.upper);
    const double margin = 1e-6 * (upper - lower);
    c.at_bound = c.fitted < lower + margin || c.fitted > upper - margin;
    columns.push_back(c);
  }
  for (const auto& [unit, values] : point.unit) {
    for (const FittedParameter& f : fitted) {
      if (f.deviation < 0) continue;
      const ParameterSpec& spec = table[f.parameter];
      const bool plain = f.transform == Transform::kIdentity;
      FittedColumn c{spec.name + "[" + unit + "] deviation", plain ? spec.unit : "1"};
      c.scale = plain ? spec.scale : 1.0;
      c.fitted = c.natural = values[f.deviation];
      columns.push_back(c);
    }
  }
  static const char* const kVelocityNames[] = {"xd", "yd", "thetad", "phid"};
  for (const auto& [recording, values] : point.velocity) {
    for (size_t k = 0; k < values.size(); ++k) {
      FittedColumn c{"initial " + std::string(kVelocityNames[k % 4]) + "[" +
                         problem.recordings()[recording].id +
                         (values.size() > 4 ? ":" + std::to_string(k / 4) : "") + "]",
                     k % 4 < 2 ? "m/s" : "rad/s"};
      c.scale = 0.1;
      c.fitted = c.natural = values[k];
      columns.push_back(c);
    }
  }
  for (size_t i = 0; i < point.weights.size(); ++i) {
    FittedColumn c{"network weight " + std::to_string(i), "1"};
    c.fitted = c.natural = point.weights[i];
    columns.push_back(c);
  }
  return columns;
}

namespace {

// d fitted / d (natural / scale): the change of variables to physical units.
double PhysicalUnit(const FittedColumn& c) {
  return c.scale / TransformSlope(c.transform, c.natural);
}

}  // namespace

Eigen::VectorXd Units(const std::vector<FittedColumn>& columns) {
  Eigen::VectorXd unit(columns.size());
  for (size_t i = 0; i < columns.size(); ++i) {
    unit[static_cast<Eigen::Index>(i)] = columns[i].at_bound ? 0.0 : PhysicalUnit(columns[i]);
  }
  return unit;
}

}  // namespace pushid
