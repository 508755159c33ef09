// ident: null directions in words.
#include "ident/uncertainty/null_directions.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ident/problem/fit_problem.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

std::string JoinNames(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

std::string Format(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// Sums and differences of two touched shared parameters of one unit that the null space leaves
// alone; at most as many as are independent.
std::vector<Combination> IdentifiedPairs(const FitProblem& problem, const FitPoint& point,
                                         const std::vector<int>& touched,
                                         const Eigen::MatrixXd& null_space,
                                         const Uncertainty& uncertainty) {
  const auto& fitted = problem.map().fitted;
  const ParameterTable& table = problem.options().table;
  const Eigen::MatrixXd own = null_space(touched, Eigen::all);
  const size_t wanted = touched.size() - static_cast<size_t>(Rank(own, kTouched));
  std::vector<Combination> found;
  for (size_t a = 0; a < touched.size(); ++a) {
    for (size_t b = a + 1; b < touched.size() && found.size() < wanted; ++b) {
      const ParameterSpec& first = table[fitted[touched[a]].parameter];
      const ParameterSpec& second = table[fitted[touched[b]].parameter];
      if (first.unit != second.unit) continue;
      for (double sign : {1.0, -1.0}) {
        const Eigen::RowVectorXd change = first.scale * null_space.row(touched[a]) +
                                          sign * second.scale * null_space.row(touched[b]);
        if (change.norm() > 1e-4 * first.scale) continue;
        found.push_back(Combine(problem, point, uncertainty,
                                {first.name + (sign > 0 ? " + " : " - ") + second.name,
                                 first.unit,
                                 {{first.id, 1.0}, {second.id, sign}}}));
        break;
      }
    }
  }
  return found;
}

NullDirection NoEffect(const FitProblem& problem, int parameter) {
  NullDirection direction;
  direction.parameters = {problem.options().table[problem.map().fitted[parameter].parameter].name};
  direction.coefficients = {1.0};
  direction.sentence =
      direction.parameters[0] +
      " has no effect on these recordings: fix it (--fix=" + direction.parameters[0] + ")";
  return direction;
}

NullDirection Inseparable(const FitProblem& problem, const FitPoint& point,
                          const std::vector<int>& group, const Eigen::MatrixXd& null_space,
                          const Uncertainty& uncertainty) {
  const Eigen::MatrixXd projector = null_space * null_space.transpose();
  NullDirection joint;
  int largest = group[0];
  for (int i : group) {
    if (projector(i, i) > projector(largest, largest)) largest = i;
  }
  for (int i : group) {
    joint.parameters.push_back(problem.options().table[problem.map().fitted[i].parameter].name);
    joint.coefficients.push_back(projector(i, largest) / projector(largest, largest));
  }
  joint.identified = IdentifiedPairs(problem, point, group, null_space, uncertainty);
  joint.sentence = JoinNames(joint.parameters) + " cannot be separated";
  for (const Combination& c : joint.identified) {
    const double half = 0.5 * (c.upper95 - c.lower95);
    const bool known = half < 0.5 * std::abs(c.value) || c.lower95 > 0.0 || c.upper95 < 0.0;
    joint.sentence += "; " + c.name + " = " + Format(c.value) + " +- " + Format(c.standard_error) +
                      " " + c.unit + (known ? " is identified" : " is only weakly identified");
  }
  return joint;
}

}  // namespace

std::vector<NullDirection> DescribeNullSpace(const FitProblem& problem, const FitPoint& point,
                                             const Eigen::MatrixXd& null_space,
                                             const Uncertainty& uncertainty) {
  std::vector<NullDirection> directions;
  if (null_space.cols() == 0) return directions;
  const auto& fitted = problem.map().fitted;

  // Parameters belong together when one's share of the null space moves the other.
  const Eigen::MatrixXd projector = null_space * null_space.transpose();
  std::vector<int> touched;
  for (int i = 0; i < static_cast<int>(fitted.size()); ++i) {
    if (null_space.row(i).cwiseAbs().maxCoeff() > kTouched) touched.push_back(i);
  }
  while (!touched.empty()) {
    std::vector<int> group = {touched[0]};
    const auto in_group = [&group](int i) {
      return std::find(group.begin(), group.end(), i) != group.end();
    };
    for (size_t k = 0; k < group.size(); ++k) {
      for (int i : touched) {
        if (!in_group(i) && std::abs(projector(group[k], i)) > kTouched) group.push_back(i);
      }
    }
    touched.erase(std::remove_if(touched.begin(), touched.end(), in_group), touched.end());
    std::sort(group.begin(), group.end());
    directions.push_back(group.size() == 1
                             ? NoEffect(problem, group[0])
                             : Inseparable(problem, point, group, null_space, uncertainty));
  }
  return directions;
}

}  // namespace pushid
