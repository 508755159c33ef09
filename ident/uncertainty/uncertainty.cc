// ident: standard errors, intervals and null directions of a fit.
#include "ident/uncertainty/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/files/number_text.h"
#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/uncertainty/assumptions.h"
#include "models/decompositions.h"
#include "models/enum_names.h"
#include "models/self_terms.h"

namespace pushid {
namespace {

constexpr double kTouched = 1e-4;   // share of a null direction that counts
constexpr double kHeldShare = 0.5;  // of the data; with less, what was put in decides

// Sums and differences of two touched shared parameters of one unit that the null space leaves
// alone; at most as many as are independent.
std::vector<Combination> IdentifiedPairs(const FitProblem& problem, const FitPoint& point,
                                         const std::vector<int>& touched,
                                         const Eigen::MatrixXd& null_space,
                                         const Uncertainty& uncertainty) {
  const Eigen::MatrixXd own = null_space(touched, Eigen::all);
  const size_t wanted = touched.size() - static_cast<size_t>(Rank(own, kTouched));
  std::vector<Combination> found;
  for (size_t a = 0; a < touched.size(); ++a) {
    for (size_t b = a + 1; b < touched.size() && found.size() < wanted; ++b) {
      const ParameterSpec& first = problem.Spec(touched[a]);
      const ParameterSpec& second = problem.Spec(touched[b]);
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

// Parameters that the data cannot tell apart, and sums of them that they can. null_space: columns
// over all fitted numbers, in units of each one's scale. `uncertainty` needs its covariance and
// quantile only.
std::vector<NullDirection> DescribeNullSpace(const FitProblem& problem, const FitPoint& point,
                                             const Eigen::MatrixXd& null_space,
                                             const Uncertainty& uncertainty) {
  std::vector<NullDirection> directions;
  if (null_space.cols() == 0) return directions;
  const Eigen::MatrixXd projector = null_space * null_space.transpose();
  std::vector<int> touched;
  for (int i = 0; i < problem.map().num_shared(); ++i) {
    if (null_space.row(i).cwiseAbs().maxCoeff() > kTouched) touched.push_back(i);
  }
  while (!touched.empty()) {
    // Parameters belong together when one's share of the null space moves the other.
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
    NullDirection& joint = directions.emplace_back();
    int largest = group[0];
    for (int i : group) {
      if (projector(i, i) > projector(largest, largest)) largest = i;
    }
    for (int i : group) {
      joint.parameters.push_back(problem.Spec(i).name);
      joint.coefficients.push_back(projector(i, largest) / projector(largest, largest));
    }
    if (group.size() == 1) {
      const std::string& name = joint.parameters[0];
      joint.sentence = name + " has no effect on these recordings: fix it (--fix=" + name + ")";
      continue;
    }
    joint.identified = IdentifiedPairs(problem, point, group, null_space, uncertainty);
    joint.sentence = Listed(joint.parameters, "and") + " cannot be separated";
    for (const Combination& c : joint.identified) {
      const double width = problem.Spec(largest).scale;
      const bool known = IsNarrow(Transform::kIdentity, width, c.lower95, c.upper95);
      joint.sentence += "; " + c.name + " = " + Rounded(c.value, 4) + " +- " +
                        Rounded(c.standard_error, 4) + " " + c.unit +
                        (known ? " is identified" : " is only weakly identified");
    }
  }
  return directions;
}

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
  std::vector<double> size;
  for (size_t i = 0; i < specs.size(); ++i) {
    size.push_back(std::abs(change[static_cast<Eigen::Index>(i)]) / specs[i]->scale);
  }
  const double largest = *std::max_element(size.begin(), size.end());
  std::vector<size_t> order;
  for (size_t i = 0; i < size.size(); ++i) {
    if (size[i] >= kPartOf * largest) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&size](auto a, auto b) { return size[a] > size[b]; });
  std::vector<std::string> names;
  for (size_t i : order) names.push_back(specs[i]->name);
  const std::string percent = Rounded(std::round(100.0 * share), 3) + " %";
  if (names.size() == 1) {
    return "the data alone hardly determine " + names[0] + " (their share: " + percent + ")";
  }
  const std::string split =
      "; their split comes from priors or constraints (data: " + percent + ")";
  if (names.size() > 2) return "the data alone hardly separate " + Listed(names, "and") + split;
  const double slope =
      change[static_cast<Eigen::Index>(order[0])] / change[static_cast<Eigen::Index>(order[1])];
  return "the data alone determine " + names[0] + (slope > 0.0 ? " - " : " + ") +
         Rounded(std::abs(slope), 2) + " " + names[1] + " better than either parameter" + split;
}

// Directions that the data hardly know, one sentence for each: where priors and demands decide.
//
// H = H_data + H_put_in over the shared parameters (deviations of units integrated out). The
// eigenvalues of H^-1/2 H_data H^-1/2 are the data's shares, direction by direction; along one
// whose share is below 50 % the estimate is what was put in. Where two parameters make most of it,
// the data still know a combination of the two.
std::vector<std::string> HeldDirections(const FitProblem& problem,
                                        const std::vector<FittedColumn>& columns,
                                        const Covariance& covariance) {
  std::vector<int> kept, rest;
  std::vector<const ParameterSpec*> specs;
  std::vector<double> slopes;
  for (int i = 0; i < static_cast<int>(columns.size()); ++i) {
    const FittedColumn& c = columns[i];
    if (c.at_bound) continue;
    const bool shared = i < problem.map().num_shared();
    (shared ? kept : rest).push_back(i);
    if (!shared) continue;
    specs.push_back(&problem.Spec(i));
    slopes.push_back(TransformSlope(c.transform, c.natural));
  }
  const auto slope = Eigen::VectorXd::Map(slopes.data(), static_cast<Eigen::Index>(slopes.size()));
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

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Beyond that a gradient for each column takes a large part of the fit's time.
constexpr Eigen::Index kMostColumnsWithCurvature = 40;

// Directions that the recordings say nothing about, whatever priors and settling simulations say: a
// number that only its prior holds is not identified.
Eigen::MatrixXd DataNullSpace(const ResidualRows& score, const Eigen::MatrixXd& scaled,
                              const std::vector<FittedColumn>& columns) {
  const std::vector<int> rows = score.RowsWhere([](int cluster) {
    return cluster != FitProblem::kPriorCluster && cluster != FitProblem::kSettlingCluster;
  });
  const SingularDirections data = Decompose(scaled(rows, Eigen::all));
  // Parameters on a bound make columns of zeros: those are not news.
  std::vector<int> off_bound, news;
  for (size_t i = 0; i < columns.size(); ++i) {
    if (!columns[i].at_bound) off_bound.push_back(static_cast<int>(i));
  }
  for (int k = data.rank; k < data.v.cols(); ++k) {
    if ((data.v(off_bound, k).array().abs() >= kTouched).any()) news.push_back(k);
  }
  return data.v(Eigen::all, news);
}

// Limits of EstimateStatus.
constexpr double kIdentifiedShare = 0.8;
constexpr double kMostPull = 0.5;  // standard errors
constexpr double kMostHalfWidth = 0.5;

}  // namespace

bool IsNarrow(Transform transform, double width, double lower95, double upper95) {
  if (transform == Transform::kLog) {
    return 0.5 * std::log(upper95 / lower95) < std::asinh(kMostHalfWidth);
  }
  return 0.5 * (upper95 - lower95) < kMostHalfWidth * width;
}

bool Leads(const Estimate& e) {
  const double pull = std::abs(e.shares.prior_pull + e.shares.settling_pull);
  return e.shares.data > kIdentifiedShare && pull < kMostPull * e.standard_error;
}

Interval IntervalOf(const FittedColumn& c, const ScatterOf& of) {
  const double error = c.at_bound ? 0.0 : of.standard_error;
  return {TransformSlope(c.transform, c.natural) * error,
          ToNatural(c.transform, c.fitted - of.quantile * error),
          ToNatural(c.transform, c.fitted + of.quantile * error)};
}

Interval WidenedTo(const Interval& least, Interval interval) {
  interval.lower = std::min(interval.lower, least.lower);
  interval.upper = std::max(interval.upper, least.upper);
  interval.standard_error = std::max(interval.standard_error, least.standard_error);
  return interval;
}

namespace {

// touched: by a null direction of the data. few: too few recordings to know their scatter, or
// people to say anything of others.
Estimate MakeEstimate(const FittedColumn& c, ScatterOf of, double naive_variance,
                      const Shares& shares, bool touched, bool few) {
  if (touched) of.standard_error = kInfinity;
  const double slope = TransformSlope(c.transform, c.natural);
  const Interval interval = IntervalOf(c, of);
  Estimate e;
  e.name = c.name;
  e.unit = c.unit;
  e.value = c.natural;
  e.freedom = of.freedom;
  e.quantile = of.quantile;
  e.shares = shares;
  e.shares.prior_pull *= slope;
  e.shares.settling_pull *= slope;
  e.standard_error_naive = c.at_bound ? 0.0
                           : touched  ? kInfinity
                                      : slope * std::sqrt(std::max(0.0, naive_variance));
  e.standard_error = interval.standard_error;
  e.lower95 = interval.lower;
  e.upper95 = interval.upper;
  const bool identified = !few && Leads(e) && IsNarrow(c.transform, c.width, e.lower95, e.upper95);
  e.status = c.at_bound                   ? EstimateStatus::kAtBound
             : touched                    ? EstimateStatus::kUnidentifiable
             : e.shares.data < kHeldShare ? EstimateStatus::kPriorHeld
             : identified                 ? EstimateStatus::kIdentified
                                          : EstimateStatus::kWeak;
  return e;
}

Eigen::MatrixXd Correlation(const Eigen::MatrixXd& covariance) {
  const Eigen::ArrayXd variance = covariance.diagonal();
  const Eigen::VectorXd scale = (variance > 0.0).select(variance.rsqrt(), 0.0);
  Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  correlation.diagonal().setOnes();
  return correlation;
}

// Shares of every column, pulls on the fitted scale. What ties units to each other or a network's
// weights to zero counts as the data's: it is estimated from them, or chosen by them.
std::vector<Shares> SharesOf(const Covariance& c, const Eigen::VectorXd& settling_pull) {
  const Eigen::MatrixXd& inverse = c.inverse_of_parts;
  const auto part = [&inverse](const Eigen::MatrixXd& of) {
    return (inverse * of * inverse).diagonal().eval();
  };
  const Eigen::VectorXd prior = part(c.by_prior), settling = part(c.by_settling);
  const Eigen::VectorXd prior_pull = -inverse * c.prior_gradient;
  std::vector<Shares> shares(static_cast<size_t>(inverse.rows()));
  for (size_t i = 0; i < shares.size(); ++i) {
    const Eigen::Index k = static_cast<Eigen::Index>(i);
    const double all = inverse(k, k);
    if (all <= 0.0) continue;
    Shares& s = shares[i];
    s.prior = prior[k] / all;
    s.settling = settling[k] / all;
    s.data = 1.0 - s.prior - s.settling;
    s.prior_pull = prior_pull[k];
    s.settling_pull = settling_pull[k];
  }
  return shares;
}

// Moves of each column by the demand to settle, fitted scale.
Eigen::VectorXd MovedBySettling(const Covariance& c, const Eigen::VectorXd& unit,
                                const FitPoint& point, const FitPoint* free) {
  if (free == nullptr) {
    if (c.settling_gradient.isZero(0.0)) return c.settling_gradient;
    const Eigen::MatrixXd without =
        unit.asDiagonal() * (c.by_data + c.by_prior + c.by_pooling) * unit.asDiagonal();
    const Eigen::VectorXd gradient = unit.cwiseProduct(c.settling_gradient);
    return -unit.cwiseProduct(SolveLeastNorm(without, gradient));
  }
  const std::vector<double> to = point.Flat(), from = free->Flat();
  const Eigen::Index size = static_cast<Eigen::Index>(to.size());
  return Eigen::VectorXd::Map(to.data(), size) - Eigen::VectorXd::Map(from.data(), size);
}

// Steps of the gradient's differences, in a column's unit: standard errors are within 3e-5 of those
// by central differences. A likelihood's rows have Jacobians that are differences themselves, whose
// rounding a small step would magnify.
constexpr double kCurvatureStep = 3e-7, kCurvatureStepOfLikelihood = 1e-3;

}  // namespace

ScoredFit ScoreAt(const FitProblem& problem, const FitPoint& point, bool curvature) {
  FitPoint copy = point;
  const FitProblem::Built built = problem.Build(&copy, 0);
  ScoredFit e{EvaluateRows(built, true), FittedColumns(problem, point), {}, {}, {}};
  e.unit = Units(e.columns);
  e.clusters = MakeClusters(problem.recordings(), ClusterBy::kAuto, problem.counts());
  e.clustering = ClusterRows(problem, e.clusters, e.score);
  // The gradient jumps where feet step: differences across a jump left no minimum, and those of a
  // shorter step do not see it.
  const bool steps = problem.options().model.stance == Stance::kSteps;
  if (curvature && !steps && e.unit.size() <= kMostColumnsWithCurvature) {
    const bool rolls = problem.options().likelihood == Likelihood::kTrajectory;
    const double step = rolls ? kCurvatureStep : kCurvatureStepOfLikelihood;
    AddCurvature(built, step * e.unit, !rolls, &e.score);
  }
  return e;
}

Covariance CovarianceAt(const FitProblem& problem, const FitPoint& point) {
  const ScoredFit e = ScoreAt(problem, point);
  return ComputeCovariance(e.score, e.unit, e.clustering);
}

Conditioning ComputeConditioning(const FitProblem& problem, const FitPoint& point,
                                 const ResidualRows& score) {
  const std::vector<FittedColumn> columns = FittedColumns(problem, point);
  const Eigen::VectorXd unit = Units(columns);
  const Covariance c = ComputeCovariance(score, unit, {});
  Uncertainty u;
  u.covariance = c.naive;
  u.scatter.Add(c.naive, c.naive_freedom);
  u.freedom = c.naive_freedom;
  const Eigen::MatrixXd scaled = score.jacobian * unit.asDiagonal();
  return {c.directions.Condition(),
          DescribeNullSpace(problem, point, DataNullSpace(score, scaled, columns), u)};
}

Uncertainty ComputeUncertainty(const FitProblem& problem, const FitPoint& point,
                               const FitPoint* free) {
  // Where a demand moved the fit its errors are those at `free`, second derivatives and all.
  const ScoredFit e = ScoreAt(problem, point, free == nullptr);
  const auto& [score, columns, unit, clusters, clustering] = e;
  const int size = static_cast<int>(columns.size());
  const Covariance c = ComputeCovariance(score, unit, free == nullptr ? clustering : Clustering{});
  FitProblem undemanding = problem;
  undemanding.mutable_options()->settling_weight = 0.0;
  const Covariance spread = free == nullptr ? c : CovarianceAt(undemanding, *free);

  Uncertainty u;
  u.num_residuals = score.num_data_rows;
  u.num_clusters = clusters.count();
  u.clustered_by = clusters.by;
  u.two_way = clusters.two_way;
  u.clustered = !spread.scatter.empty();
  u.num_people = clusters.people;
  u.about_people_like_them = u.clustered && clusters.draws_people;
  u.moves = spread.moves;
  u.left_out = spread.recordings;
  u.condition_number = c.directions.Condition();
  u.full_hessian = spread.full_hessian;
  u.sigma = c.sigma;
  u.freedom = u.clustered ? u.num_clusters - 1 : spread.naive_freedom;
  u.scatter = spread.scatter;
  u.these = spread.these;
  // One cluster does not show how clusters scatter: the width of the posterior is left, in which
  // the cluster counts as one independent frame.
  if (!u.clustered) u.scatter.Add(spread.inverse_hessian, kInfinity);
  u.covariance = u.scatter.Covariance();
  u.too_few_clusters = u.clustered && u.num_clusters - 1 < problem.map().num_shared();
  u.correlation = Correlation(u.too_few_clusters ? spread.naive : u.covariance);

  const Eigen::MatrixXd scaled = score.jacobian * unit.asDiagonal();
  const Eigen::MatrixXd null_space = DataNullSpace(score, scaled, columns);
  const std::vector<Shares> shares = SharesOf(c, MovedBySettling(c, unit, point, free));
  const bool few = !u.clustered || (u.about_people_like_them && u.num_people < kFewestPeople);
  for (int i = 0; i < size; ++i) {
    const bool touched =
        null_space.cols() > 0 && null_space.row(i).cwiseAbs().maxCoeff() > kTouched;
    const bool free_of_data = touched && !columns[i].at_bound;
    u.estimates.push_back(MakeEstimate(columns[i], u.scatter.OfColumn(i), spread.naive(i, i),
                                       shares[i], free_of_data, few));
    if (!u.these.empty() && !free_of_data) {
      u.estimates.back().these = IntervalOf(columns[i], u.these.OfColumn(i));
    }
  }
  u.null_directions = DescribeNullSpace(problem, point, null_space, u);
  u.held_directions = HeldDirections(problem, columns, c);
  return u;
}

Combination Combine(const FitProblem& problem, const FitPoint& point,
                    const Uncertainty& uncertainty, const CombinationSpec& spec) {
  const std::vector<Term>& terms = spec.terms;
  const ParameterSet<double> values = problem.Parameters(point, "");
  const size_t fitted = problem.map().fitted.size();
  Combination result{spec.name, spec.unit};
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(uncertainty.covariance.rows());
  for (const Term& term : terms) {
    result.value += term.coefficient * values[term.parameter];
    const size_t i = problem.FittedIndex(term.parameter);
    if (i == fitted) continue;
    gradient[static_cast<Eigen::Index>(i)] +=
        term.coefficient * TransformSlope(problem.Spec(i).transform, values[term.parameter]);
  }
  result.quantile = uncertainty.scatter.Of(gradient).quantile;
  const auto by_scatter = [&](const Scatter& scatter) {
    const ScatterOf of = scatter.Of(gradient);
    return Interval{of.standard_error, result.value - of.HalfWidth(),
                    result.value + of.HalfWidth()};
  };
  // A multiple of one parameter has that parameter's intervals, asymmetric where it is fitted as a
  // log.
  const size_t one = terms.size() == 1 ? problem.FittedIndex(terms[0].parameter) : fitted;
  const auto times = [by = terms[0].coefficient](const Interval& i) {
    return Interval{by * i.standard_error, by * i.lower, by * i.upper};
  };
  Interval own = by_scatter(uncertainty.scatter);
  if (one != fitted) {
    const Estimate& e = uncertainty.estimates[one];
    own = times({e.standard_error, e.lower95, e.upper95});
    if (e.these) result.these = times(*e.these);
    if (e.total) result.total = times(*e.total);
  } else {
    if (!uncertainty.these.empty()) result.these = by_scatter(uncertainty.these);
    if (!uncertainty.total.empty()) result.total = WidenedTo(own, by_scatter(uncertainty.total));
  }
  result.standard_error = own.standard_error;
  result.lower95 = own.lower;
  result.upper95 = own.upper;
  return result;
}

std::vector<CombinationSpec> DerivedCombinations(const ModelOptions& model) {
  if (IsOneMachine(model)) return {};  // gains of the reference person would not be its own
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
  // The mass at the hip, or of the whole body where it turns about its ankles.
  const std::string mass = slides ? "m" : "M";
  const std::string load = "/(" + mass + " g l)", inertia = "/(" + mass + " l^2)";
  combinations.insert(combinations.end(), {{"Kp_theta" + load, "1", {{kKpTheta, stiffness}}},
                                           {"Kp_phi" + load, "1", {{kKpPhi, stiffness}}},
                                           {"Kd_theta" + inertia, "1/s", {{kKdTheta, damping}}},
                                           {"Kd_phi" + inertia, "1/s", {{kKdPhi, damping}}}});
  return combinations;
}

}  // namespace pushid
