// ident: the fitted numbers one by one, in the order of FitPoint::Flat.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"

namespace pushid {

// What is known of each fitted number besides its estimate.
struct FittedColumn {
  std::string name, unit;
  Transform transform = Transform::kIdentity;
  double scale = 1.0;   // typical size, natural unit
  double fitted = 0.0;  // value on the fitted scale
  double natural = 0.0;
  bool at_bound = false;
};

std::vector<FittedColumn> FittedColumns(const FitProblem& problem, const FitPoint& point);

// To physical units; a parameter on its bound does not move.
Eigen::VectorXd Units(const std::vector<FittedColumn>& columns);

}  // namespace pushid
