// ident: null directions in words.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "datasets/files/number_text.h"
#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/uncertainty.h"
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

namespace {

constexpr size_t kMostDirections = 3;  // to tell: those that the data know least
constexpr double kPartOf = 0.3;  // of the largest component: what counts as part of a direction

// The information on `kept`, everything else integrated out.
Eigen::MatrixXd Marginal(const Eigen::MatrixXd& information, const std::vector<int>& kept,
                         const std::vector<int>& rest) {
  const Eigen::MatrixXd own = information(kept, kept);
  if (rest.empty()) return own;
  const Eigen::MatrixXd cross = information(rest, kept), others = information(rest, rest);
  return own - cross.transpose() * SolveLeastNorm(others, cross);
}

// change: of each kept parameter along the direction, natural units.
std::string Sentence(const std::vector<const ParameterSpec*>& specs, const Eigen::VectorXd& change,
                     double share) {
  Eigen::VectorXd size(change.size());
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    size[i] = std::abs(change[i]) / specs[static_cast<size_t>(i)]->scale;
  }
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    if (size[i] >= kPartOf * size.maxCoeff()) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&size](auto a, auto b) { return size[a] > size[b]; });
  const std::string percent = Rounded(std::round(100.0 * share), 3) + " %";
  const ParameterSpec& first = *specs[static_cast<size_t>(order[0])];
  if (order.size() == 1) {
    return "the data alone hardly determine " + first.name + " (their share: " + percent + ")";
  }
  if (order.size() == 2) {
    const ParameterSpec& second = *specs[static_cast<size_t>(order[1])];
    const double slope = change[order[0]] / change[order[1]];
    return "the data alone determine " + first.name + (slope > 0.0 ? " - " : " + ") +
           Rounded(std::abs(slope), 2) + " " + second.name +
           " better than either parameter; their split comes from priors or constraints (data: " +
           percent + ")";
  }
  std::string names;
  for (size_t k = 0; k < order.size(); ++k) {
    names += (k == 0                  ? ""
              : k + 1 == order.size() ? " and "
                                      : ", ") +
             specs[static_cast<size_t>(order[k])]->name;
  }
  return "the data alone hardly separate " + names +
         "; their split comes from priors or constraints (data: " + percent + ")";
}

}  // namespace

std::vector<std::string> HeldDirections(const FitProblem& problem, const FitPoint& point,
                                        const Covariance& covariance,
                                        const std::vector<bool>& at_bound) {
  const auto& fitted = problem.map().fitted;
  std::vector<int> kept, rest;
  std::vector<const ParameterSpec*> specs;
  Eigen::VectorXd slope(0);
  for (int i = 0; i < covariance.by_data.rows(); ++i) {
    const bool shared = i < static_cast<int>(fitted.size());
    if (at_bound[static_cast<size_t>(i)]) continue;
    if (!shared) {
      rest.push_back(i);
      continue;
    }
    kept.push_back(i);
    const FittedParameter& f = fitted[static_cast<size_t>(i)];
    specs.push_back(&problem.options().table[f.parameter]);
    slope.conservativeResize(slope.size() + 1);
    slope[slope.size() - 1] =
        TransformSlope(f.transform, ToNatural(f.transform, point.shared[static_cast<size_t>(i)]));
  }
  std::vector<std::string> sentences;
  if (kept.empty()) return sentences;
  const Eigen::MatrixXd by_data = covariance.by_data + covariance.by_pooling;
  const Eigen::MatrixXd data = Marginal(by_data, kept, rest);
  const SymmetricEigen all = DecomposeSymmetric(
      Marginal(by_data + covariance.by_prior + covariance.by_settling, kept, rest));
  if (!(all.values.minCoeff() > 0.0)) return sentences;  // a null direction: told elsewhere
  const Eigen::MatrixXd root = all.InverseSqrt();
  const SymmetricEigen shares = DecomposeSymmetric(root * data * root);
  for (Eigen::Index k = 0; k < shares.values.size(); ++k) {
    const double share = std::max(0.0, shares.values[k]);
    if (share >= kHeldShare || sentences.size() >= kMostDirections) break;  // ascending
    const Eigen::VectorXd direction = root * shares.vectors.col(k);
    const std::string sentence = Sentence(specs, slope.cwiseProduct(direction), share);
    if (sentences.empty() || sentences.back() != sentence) sentences.push_back(sentence);
  }
  return sentences;
}

}  // namespace pushid
