// ident: profiles of a fit's parameters and combinations.
#include "ident/uncertainty/profile.h"

#include <algorithm>
#include <cmath>

#include "ident/solver/solver.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/profile_plan.h"
#include "residuals/cost_functions/combination_residual.h"
#include "residuals/cost_functions/prior_residual.h"

namespace pushid {
namespace {

constexpr double kHold = 0.03;  // s_hold over the naive error

class Profiler {
 public:
  Profiler(const FitProblem& problem, const FitPoint& estimate, const Uncertainty& uncertainty)
      : problem_(problem),
        estimate_(estimate),
        uncertainty_(uncertainty),
        covariance_(CovarianceAt(problem, estimate)),
        cost_(Refit(problem, estimate).cost) {}

  // In the target's own scale.
  Profile Run(const ProfileTarget& target) const;

 private:
  ProfileSearch Search(const ProfileTarget& target, const Eigen::VectorXd& gradient) const;
  HeldFit Hold(const ProfileTarget& target, double sigma, double wanted,
               const std::vector<double>& from) const;
  double Value(const ProfileTarget& target, const FitPoint& point) const;
  Eigen::VectorXd Gradient(const ProfileTarget& target) const;
  double MeanRatio() const;
  double Freedom(const ProfileTarget& target) const;
  ProfilePoint Describe(const ProfileTarget& target, const HeldFit& fit) const;

  const FitProblem& problem_;
  const FitPoint& estimate_;
  const Uncertainty& uncertainty_;
  const Covariance covariance_;
  const double cost_;
};

double Profiler::Value(const ProfileTarget& target, const FitPoint& point) const {
  if (target.index >= 0) return point.shared[target.index];
  double value = target.constant;
  for (size_t i = 0; i < target.coefficients.size(); ++i) {
    const Transform transform = problem_.map().fitted[i].transform;
    value += target.coefficients[i] * ToNatural(transform, point.shared[i]);
  }
  return value;
}

// Of the target by all fitted numbers, at the estimate.
Eigen::VectorXd Profiler::Gradient(const ProfileTarget& target) const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(covariance_.inverse_hessian.rows());
  if (target.index >= 0) {
    gradient[target.index] = 1.0;
    return gradient;
  }
  for (size_t i = 0; i < target.coefficients.size(); ++i) {
    const Transform transform = problem_.map().fitted[i].transform;
    gradient[static_cast<Eigen::Index>(i)] =
        target.coefficients[i] *
        TransformSlope(transform, ToNatural(transform, estimate_.shared[i]));
  }
  return gradient;
}

double Profiler::MeanRatio() const {
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < problem_.map().num_shared(); ++i) {
    const double naive = covariance_.inverse_hessian(i, i);
    if (naive <= 0.0) continue;
    sum += uncertainty_.covariance(i, i) / naive;
    ++count;
  }
  return count > 0 ? sum / count : covariance_.sigma * covariance_.sigma;
}

// Of a combination: that of the parameter in it which is known least.
double Profiler::Freedom(const ProfileTarget& target) const {
  const std::vector<Estimate>& estimates = uncertainty_.estimates;
  if (target.index >= 0) return estimates[target.index].freedom;
  double freedom = std::max(1, uncertainty_.freedom);
  for (size_t i = 0; i < target.coefficients.size(); ++i) {
    if (target.coefficients[i] != 0.0) freedom = std::min(freedom, estimates[i].freedom);
  }
  return freedom;
}

ProfileSearch Profiler::Search(const ProfileTarget& target, const Eigen::VectorXd& gradient) const {
  const Eigen::VectorXd moved = covariance_.inverse_hessian * gradient;
  const double naive = gradient.dot(moved);
  // A result keeps no covariance of a network's weights, which stand last and are in no target.
  const Eigen::VectorXd kept = gradient.head(uncertainty_.covariance.rows());
  const double clustered = kept.dot(uncertainty_.covariance * kept);
  ProfileSearch search;
  search.estimate = Value(target, estimate_);
  search.cost = cost_;
  search.point = estimate_.Flat();
  search.direction.assign(search.point.size(), 0.0);
  const bool known = naive > 0.0 && clustered > 0.0;
  if (known) {
    const Eigen::VectorXd direction = moved / naive;
    search.direction.assign(direction.data(), direction.data() + direction.size());
    search.naive_error = std::sqrt(naive);
  } else if (target.index >= 0) {
    const ParameterSpec& spec =
        problem_.options().table[problem_.map().fitted[target.index].parameter];
    search.direction[target.index] = 1.0;
    search.naive_error =
        0.1 * (spec.transform == Transform::kIdentity ? spec.scale : 1.0);  // a careful first step
  }
  const double t = StudentQuantile95(Freedom(target));
  search.threshold = 0.5 * t * t * (known ? clustered / naive : MeanRatio());
  if (target.index >= 0) {
    const ParameterSpec& spec =
        problem_.options().table[problem_.map().fitted[target.index].parameter];
    search.lower = ToFitted(spec.transform, spec.lower);
    search.upper = ToFitted(spec.transform, spec.upper);
  }
  return search;
}

HeldFit Profiler::Hold(const ProfileTarget& target, double sigma, double wanted,
                       const std::vector<double>& from) const {
  FitPoint point = estimate_;
  point.SetFlat(from);
  FitProblem::Built built = problem_.Build(&point, 0);
  HeldFit held;
  // With recordings cut short the costs could not be compared.
  if (!built.shortened.empty() || built.rests_left_out > 0) return held;
  ceres::CostFunction* holder;
  if (target.index >= 0) {
    holder = new PriorResidual(problem_.map().num_shared(), target.index, wanted, sigma);
  } else {
    holder = new CombinationResidual(problem_.map(), target.coefficients, target.constant, wanted,
                                     sigma);
  }
  built.problem->AddResidualBlock(holder, nullptr, point.shared.data());
  ceres::Solver::Options options = SolverOptions(problem_.options(), *built.problem);
  options.num_threads = 1;
  std::string message;
  const SolveStage stage = SolveBuilt(&built, options, 0, &message);
  held.value = Value(target, point);
  const double pull = (held.value - wanted) / sigma;
  held.cost = stage.final_cost - 0.5 * pull * pull;
  held.point = point.Flat();
  held.ok = stage.converged;
  return held;
}

ProfilePoint Profiler::Describe(const ProfileTarget& target, const HeldFit& fit) const {
  ProfilePoint point;
  point.value = fit.value;
  point.cost = fit.cost;
  for (int i = 0; i < problem_.map().num_shared(); ++i) {
    if (i == target.index) continue;
    const FittedParameter& f = problem_.map().fitted[i];
    point.others[problem_.options().table[f.parameter].name] = ToNatural(f.transform, fit.point[i]);
  }
  return point;
}

Profile Profiler::Run(const ProfileTarget& target) const {
  const ProfileSearch search = Search(target, Gradient(target));
  const HoldFit hold = [&](double wanted, const std::vector<double>& from) {
    return Hold(target, kHold * search.naive_error, wanted, from);
  };
  const ProfileSide below = TraceProfile(search, -1, hold);
  const ProfileSide above = TraceProfile(search, +1, hold);

  Profile profile;
  profile.name = target.name;
  profile.unit = target.unit;
  profile.estimate = search.estimate;
  profile.cost = search.cost;
  profile.threshold = search.threshold;
  profile.lower_end = below.end;
  profile.upper_end = above.end;
  profile.lower95 = below.crossing;
  profile.upper95 = above.crossing;
  profile.points.push_back(Describe(target, {true, search.estimate, search.cost, search.point}));
  for (const ProfileSide* side : {&below, &above}) {
    for (const HeldFit& fit : side->points) profile.points.push_back(Describe(target, fit));
  }
  std::sort(profile.points.begin(), profile.points.end(),
            [](const ProfilePoint& a, const ProfilePoint& b) { return a.value < b.value; });

  // What only a prior holds has a rising profile too, and is not identified for that.
  const bool null = target.index >= 0 &&
                    uncertainty_.estimates[target.index].status == EstimateStatus::kUnidentifiable;
  const bool flat = below.end == "flat" && above.end == "flat";
  if (null || flat) {
    profile.classification = ProfileClass::kStructurallyNot;
    profile.lower95 = -std::numeric_limits<double>::infinity();
    profile.upper95 = std::numeric_limits<double>::infinity();
  } else if (std::isfinite(profile.lower95) && std::isfinite(profile.upper95)) {
    profile.classification = ProfileClass::kIdentifiable;
  }
  return profile;
}

// From the target's scale to what is reported; factors are positive.
Profile InUnitsOf(const ReportedProfile& reported, Transform transform, Profile profile) {
  const auto natural = [&](double value) {
    if (!std::isfinite(value)) return reported.factor * value;
    return reported.factor * ToNatural(transform, value) + reported.offset;
  };
  profile.name = reported.name;
  profile.unit = reported.unit;
  profile.estimate = natural(profile.estimate);
  profile.lower95 = natural(profile.lower95);
  profile.upper95 = natural(profile.upper95);
  for (ProfilePoint& point : profile.points) point.value = natural(point.value);
  return profile;
}

}  // namespace

Result<std::vector<Profile>> ComputeProfiles(const FitProblem& problem, const FitPoint& estimate,
                                             const Uncertainty& uncertainty,
                                             const std::vector<std::string>& names, int num_threads,
                                             const JobProgress& progress) {
  ProfilePlan plan(problem);
  if (MaybeError error = plan.Choose(names)) return *error;
  std::vector<size_t> needed;
  for (const ReportedProfile& reported : plan.chosen()) {
    if (std::find(needed.begin(), needed.end(), reported.target) == needed.end()) {
      needed.push_back(reported.target);
    }
  }
  const Profiler profiler(problem, estimate, uncertainty);
  std::vector<Profile> traced(plan.targets().size());
  ParallelFor(
      static_cast<int>(needed.size()), num_threads,
      [&](int i) { traced[needed[i]] = profiler.Run(plan.targets()[needed[i]]); }, progress);
  std::vector<Profile> profiles;
  for (const ReportedProfile& reported : plan.chosen()) {
    profiles.push_back(
        InUnitsOf(reported, plan.targets()[reported.target].transform, traced[reported.target]));
  }
  return profiles;
}

}  // namespace pushid
