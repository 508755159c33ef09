// ident: directions that the data hardly know, in words.
#include "ident/uncertainty/held_directions.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "models/decompositions.h"

namespace pushid {
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
