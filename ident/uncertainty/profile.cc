// ident: profiles: a target is moved from its estimate, everything else refitted, until the cost
// says that it is far enough.
#include "ident/uncertainty/profile.h"

#include <algorithm>

#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/covariance.h"
#include "residuals/cost_functions/prior_residual.h"

namespace pushid {
namespace {

// Lengths are in half widths: where a quadratic cost would cross the threshold.
constexpr int kMaxSteps = 60;
// Aimed at, on a quadratic cost. With 4 the first step of a profile to 13 standard errors (few
// people) lands so far from the path that the held fit ends in another basin.
constexpr int kStepsToThreshold = 8;
// After the first, where only the class is wanted. By short steps a walk stays on its branch, and
// crosses, where beside it the cost stays lower to the bound (tail_base of the 32 recordings
// alone).
constexpr int kStepsToClassify = 4;
constexpr double kMaxGrowth = 3.0;      // of a step over the one before
constexpr double kSmallestStep = 1e-3;  // what may be left of a step that keeps failing
constexpr double kFlatReach = 1e4;      // this far without a rise is flat
constexpr int kMaxRefinements = 8;
constexpr double kCrossingTolerance = 1e-3;  // of the signed root

// The signed root of the cost difference, nearly linear where the cost is nearly quadratic: steps
// and crossings are found on it.
double Root(const ProfileSearch& search, const HeldFit& fit) {
  return std::sqrt(std::max(0.0, 2.0 * (fit.cost - search.cost)));
}

// All numbers at `wanted`, on the line through the last two points.
std::vector<double> Extrapolate(const ProfileSearch& search, const HeldFit* before,
                                const HeldFit& last, double wanted) {
  std::vector<double> start = last.point;
  for (size_t i = 0; i < start.size(); ++i) {
    const double slope = before == nullptr || last.value == before->value
                             ? search.direction[i]
                             : (last.point[i] - before->point[i]) / (last.value - before->value);
    start[i] += slope * (wanted - last.value);
  }
  return start;
}

// Between a point below the threshold and one beyond it: regula falsi, Illinois' variant. short_by:
// how far the fit beyond ended short of where it was held, with its sign.
double FindCrossing(const ProfileSearch& search, HeldFit below, HeldFit beyond, double short_by,
                    const HoldFit& hold, std::vector<HeldFit>* points) {
  const double aim = std::sqrt(2.0 * search.threshold);
  double low = Root(search, below) - aim, high = Root(search, beyond) - aim;
  for (int i = 0; i < kMaxRefinements; ++i) {
    const double wanted = (below.value * high - beyond.value * low) / (high - low);
    const HeldFit fit = hold(wanted + short_by, Extrapolate(search, &beyond, below, wanted));
    if (!fit.ok) break;
    short_by += wanted - fit.value;
    points->push_back(fit);
    const double off = Root(search, fit) - aim;
    if (std::abs(off) < kCrossingTolerance * aim) return fit.value;
    if (off < 0.0) {
      below = fit;
      low = off;
      high *= 0.5;
    } else {
      beyond = fit;
      high = off;
      low *= 0.5;
    }
  }
  low = Root(search, below) - aim;
  high = Root(search, beyond) - aim;
  return (below.value * high - beyond.value * low) / (high - low);
}

}  // namespace

ProfileSide TraceProfile(const ProfileSearch& search, int sign, const HoldFit& hold) {
  const double aim = std::sqrt(2.0 * search.threshold);
  const double half_width = search.naive_error * aim;
  const double limit = sign > 0 ? search.upper : search.lower;
  ProfileSide side;
  side.crossing = sign * std::numeric_limits<double>::infinity();
  side.end = "steps";
  HeldFit last{true, search.estimate, search.cost, search.point}, before;
  double step = half_width / kStepsToThreshold;
  for (int k = 0; k < kMaxSteps; ++k) {
    double wanted = last.value + sign * step;
    const bool at_limit = sign * (wanted - limit) >= 0.0;
    if (at_limit) wanted = limit;
    if (sign * (wanted - last.value) <= kSmallestStep * half_width) {
      side.end = at_limit ? "bound" : "domain";
      return side;
    }
    const HeldFit fit =
        hold(wanted, Extrapolate(search, side.points.empty() ? nullptr : &before, last, wanted));
    if (!fit.ok || sign * (fit.value - last.value) <= 0.0) {
      step /= kMaxGrowth;
      continue;
    }
    side.points.push_back(fit);
    const double root = Root(search, fit);
    if (root >= aim) {
      side.end = "threshold";
      side.crossing = search.locate_crossing
                          ? FindCrossing(search, last, fit, wanted - fit.value, hold, &side.points)
                          : fit.value;
      return side;
    }
    side.end = at_limit ? "bound" : "flat";
    const double reach = std::abs(fit.value - search.estimate) / half_width;
    if (at_limit || (reach > kFlatReach && root < kCrossingTolerance * aim)) return side;
    side.end = "steps";
    const double length = std::abs(fit.value - last.value), rise = root - Root(search, last);
    const int steps = search.locate_crossing ? kStepsToThreshold : kStepsToClassify;
    step = std::clamp(rise > 0.0 ? aim / steps * length / rise : kMaxGrowth * length,
                      length / kMaxGrowth, kMaxGrowth * length);
    before = last;
    last = fit;
  }
  return side;
}

namespace {

// A number to be profiled: one fitted parameter on its fitted scale, or a combination of natural
// values. It is told as factor * natural value + offset; factors are positive.
struct ProfileTarget {
  std::string name, unit;
  Transform transform = Transform::kIdentity;
  int index = -1;                      // of the parameter; -1 for a combination
  std::vector<double> coefficients{};  // of a combination, by fitted parameter
  double constant = 0.0;               // what fixed parameters contribute
  double factor = 1.0, offset = 0.0;

  double Told(double value) const {
    return std::isfinite(value) ? factor * ToNatural(transform, value) + offset : factor * value;
  }
  // Half-width over standard error; of a combination, that of its least known parameter.
  double Quantile(const std::vector<Estimate>& estimates) const {
    if (index >= 0) return estimates[index].quantile;
    double quantile = 0.0;
    for (size_t i = 0; i < coefficients.size(); ++i) {
      if (coefficients[i] != 0.0) quantile = std::max(quantile, estimates[i].quantile);
    }
    return quantile;
  }
};

// Everything that moves. A combination of one parameter is that parameter on another scale.
std::vector<ProfileTarget> AllTargets(const FitProblem& problem) {
  const ParameterMap& map = problem.map();
  std::vector<ProfileTarget> all;
  for (size_t i = 0; i < map.fitted.size(); ++i) {
    const ParameterSpec& spec = problem.Spec(i);
    all.push_back({spec.name, spec.unit, spec.transform, static_cast<int>(i)});
  }
  for (const CombinationSpec& spec : DerivedCombinations(problem.options().model)) {
    ProfileTarget target{spec.name, spec.unit};
    std::vector<double>& c = target.coefficients;
    c.assign(map.fitted.size(), 0.0);
    for (const Term& term : spec.terms) {
      const size_t at = problem.FittedIndex(term.parameter);
      if (at == c.size()) {
        target.constant += term.coefficient * map.values[term.parameter];
      } else {
        c[at] += term.coefficient;
      }
    }
    const auto fixed = std::count(c.begin(), c.end(), 0.0);
    if (fixed == static_cast<std::ptrdiff_t>(c.size())) continue;
    if (fixed + 1 == static_cast<std::ptrdiff_t>(c.size())) {
      const int one = static_cast<int>(
          std::find_if(c.begin(), c.end(), [](double by) { return by != 0.0; }) - c.begin());
      target = {spec.name, spec.unit, all[one].transform, one, {}, 0.0, c[one], target.constant};
    }
    all.push_back(std::move(target));
  }
  return all;
}

constexpr double kHold = 0.03;  // s_hold over the naive error
// Where a held fit ends: changes of the cost, over the threshold, well below what crossings are
// located to; where only the class is wanted, more of them. And of the cost itself, at most: a far
// threshold must not end fits that have hardly begun.
struct HoldTolerance {
  double of_threshold, of_cost;
};
constexpr HoldTolerance kToLocate = {1e-4, 1e-5}, kToClassify = {1e-3, 1e-4};

ProfileClass ClassOf(const ProfileSide& below, const ProfileSide& above) {
  if (below.IsFlat() && above.IsFlat()) return ProfileClass::kStructurallyNot;
  return below.Crosses() && above.Crosses() ? ProfileClass::kIdentifiable
                                            : ProfileClass::kPracticallyNot;
}

class Profiler {
 public:
  Profiler(const FitProblem& problem, const FitPoint& estimate, const Uncertainty& uncertainty)
      : problem_(problem),
        estimate_(estimate),
        uncertainty_(uncertainty),
        covariance_(CovarianceAt(problem, estimate)),
        free_(covariance_),
        cost_(Refit(problem, estimate).cost) {
    if (!uncertainty.settling.holds()) return;
    // Errors are those at the optimum without a demand that moved the fit (uncertainty.h): at the
    // edge of a demand H says how little room is left, not how much the frames err.
    FitProblem undemanding = problem;
    undemanding.mutable_options()->settling_weight = 0.0;
    const SolveStart start = Refit(undemanding, estimate);
    if (start.usable) free_ = CovarianceAt(undemanding, start.to);
  }

  // In the target's own scale.
  Profile Run(const ProfileTarget& target) const {
    const ProfileSearch search = Search(target);
    const ProfileSide below = Trace(target, search, -1), above = Trace(target, search, +1);
    Profile profile;
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
    profile.classification =
        IsNull(target) ? ProfileClass::kStructurallyNot : ClassOf(below, above);
    if (profile.classification == ProfileClass::kStructurallyNot) {
      profile.lower95 = -std::numeric_limits<double>::infinity();
      profile.upper95 = std::numeric_limits<double>::infinity();
    }
    return profile;
  }

  ProfileClass Classify(const ProfileTarget& target) const {
    if (IsNull(target)) return ProfileClass::kStructurallyNot;
    ProfileSearch search = Search(target);
    search.locate_crossing = false;
    const ProfileSide below = Trace(target, search, -1);
    if (!below.Crosses() && !below.IsFlat()) return ProfileClass::kPracticallyNot;
    return ClassOf(below, Trace(target, search, +1));
  }

 private:
  // Nothing but a prior holds it; its profile rises for that, and it is not identified.
  bool IsNull(const ProfileTarget& target) const {
    return target.index >= 0 &&
           uncertainty_.estimates[target.index].status == EstimateStatus::kUnidentifiable;
  }

  double Value(const ProfileTarget& target, const FitPoint& point) const {
    if (target.index >= 0) return point.shared[target.index];
    double value = target.constant;
    for (size_t i = 0; i < target.coefficients.size(); ++i) {
      value += target.coefficients[i] * ToNatural(problem_.Spec(i).transform, point.shared[i]);
    }
    return value;
  }

  // The target's derivatives by all fitted numbers, at the estimate.
  Eigen::VectorXd Gradient(const ProfileTarget& target) const {
    const Eigen::Index size = covariance_.inverse_hessian.rows();
    if (target.index >= 0) return Eigen::VectorXd::Unit(size, target.index);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    for (size_t i = 0; i < target.coefficients.size(); ++i) {
      const Transform transform = problem_.Spec(i).transform;
      gradient[static_cast<Eigen::Index>(i)] =
          target.coefficients[i] *
          TransformSlope(transform, ToNatural(transform, estimate_.shared[i]));
    }
    return gradient;
  }

  // Clustered over naive variances, on average.
  double MeanRatio() const {
    double sum = 0.0;
    int count = 0;
    for (int i = 0; i < problem_.map().num_shared(); ++i) {
      const double naive = free_.inverse_hessian(i, i);
      if (naive <= 0.0) continue;
      sum += uncertainty_.covariance(i, i) / naive;
      ++count;
    }
    return count > 0 ? sum / count : free_.sigma * free_.sigma;
  }

  ProfileSearch Search(const ProfileTarget& target) const {
    const Eigen::VectorXd gradient = Gradient(target);
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
    if (target.index >= 0) {
      const ParameterSpec& spec = problem_.Spec(target.index);
      search.lower = ToFitted(spec.transform, spec.lower);
      search.upper = ToFitted(spec.transform, spec.upper);
    }
    const bool known = naive > 0.0 && clustered > 0.0;
    if (known) {
      Eigen::VectorXd::Map(search.direction.data(), moved.size()) = moved / naive;
      search.naive_error = std::sqrt(naive);
    } else if (target.index >= 0) {  // a careful first step
      search.direction[target.index] = 1.0;
      search.naive_error =
          0.1 *
          (target.transform == Transform::kIdentity ? problem_.Spec(target.index).scale : 1.0);
    }
    const double t = target.Quantile(uncertainty_.estimates);
    const double by_frames = gradient.dot(free_.inverse_hessian * gradient);
    search.threshold =
        0.5 * t * t * (known && by_frames > 0.0 ? clustered / by_frames : MeanRatio());
    return search;
  }

  ProfileSide Trace(const ProfileTarget& target, const ProfileSearch& search, int sign) const {
    return TraceProfile(search, sign, [&](double wanted, const std::vector<double>& from) {
      return Hold(target, search, wanted, from);
    });
  }

  HeldFit Hold(const ProfileTarget& target, const ProfileSearch& search, double wanted,
               const std::vector<double>& from) const {
    const double sigma = kHold * search.naive_error;
    FitPoint point = estimate_;
    point.SetFlat(from);
    // Where a rollout fails, so does the solve: no need to look for them first. With recordings cut
    // short costs could not be compared.
    FitProblem::Built built = problem_.Build(&point, 0, false, 1, true);
    HeldFit held;
    if (!built.shortened.empty() || built.rests_left_out > 0) return held;
    std::unique_ptr<ceres::CostFunction> holder;
    if (target.index >= 0) {
      holder =
          std::make_unique<PriorResidual>(problem_.map().num_shared(), target.index, wanted, sigma);
    } else {
      holder = std::make_unique<CombinationResidual>(problem_.map(), target.coefficients,
                                                     target.constant, wanted, sigma);
    }
    built.Add(std::move(holder), {point.shared.data()}, FitProblem::kPriorCluster);
    ceres::Solver::Options options = SolverOptions(problem_.options(), *built.problem);
    if (cost_ > 0.0) {
      const HoldTolerance& enough = search.locate_crossing ? kToLocate : kToClassify;
      options.function_tolerance =
          std::max(options.function_tolerance,
                   std::min(enough.of_cost, enough.of_threshold * search.threshold / cost_));
    }
    std::string message;
    const SolveStage stage =
        SolveBuilt(&built, options, 0, &message, StructuredSecants(true, free_.curvature));
    held.value = Value(target, point);
    const double pull = (held.value - wanted) / sigma;
    held.cost = stage.final_cost - 0.5 * pull * pull;
    held.point = point.Flat();
    held.ok = stage.converged;
    return held;
  }

  ProfilePoint Describe(const ProfileTarget& target, const HeldFit& fit) const {
    ProfilePoint point{fit.value, fit.cost, {}};
    for (int i = 0; i < problem_.map().num_shared(); ++i) {
      if (i == target.index) continue;
      const ParameterSpec& spec = problem_.Spec(i);
      point.others[spec.name] = ToNatural(spec.transform, fit.point[i]);
    }
    return point;
  }

  const FitProblem& problem_;
  const FitPoint& estimate_;
  const Uncertainty& uncertainty_;
  const Covariance covariance_;
  Covariance free_;
  const double cost_;
};

}  // namespace

Result<std::vector<Profile>> ComputeProfiles(const FitProblem& problem, const FitPoint& estimate,
                                             const Uncertainty& uncertainty,
                                             const std::vector<std::string>& names, int num_threads,
                                             const JobProgress& progress, bool classes_alone) {
  const std::vector<ProfileTarget> all = AllTargets(problem);
  std::vector<ProfileTarget> chosen;
  for (const std::string& name : names) {
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&name](const ProfileTarget& one) { return one.name == name; });
    if (at == all.end()) {
      std::vector<std::string> known;
      for (const ProfileTarget& one : all) known.push_back(one.name);
      return Error{"there is no profile of '" + name + "'; free numbers are " + Joined(known)};
    }
    chosen.push_back(*at);
  }
  if (names.empty()) chosen = all;
  // Each parameter once, whatever scales it is told on.
  const auto key = [](const ProfileTarget& target) {
    return std::pair(target.index, target.index < 0 ? target.name : "");
  };
  std::map<std::pair<int, std::string>, Profile> traced;
  std::vector<const ProfileTarget*> needed;
  for (const ProfileTarget& target : chosen) {
    if (traced.try_emplace(key(target)).second) needed.push_back(&target);
  }
  const Profiler profiler(problem, estimate, uncertainty);
  ParallelFor(
      static_cast<int>(needed.size()), num_threads,
      [&](int i) {
        const ProfileTarget& target = *needed[i];
        Profile& profile = traced.at(key(target));
        if (classes_alone) {
          profile.classification = profiler.Classify(target);
        } else {
          profile = profiler.Run(target);
        }
      },
      progress);
  std::vector<Profile> profiles;
  for (const ProfileTarget& target : chosen) {
    Profile& profile = profiles.emplace_back(traced.at(key(target)));
    profile.name = target.name;
    profile.unit = target.unit;
    for (double* value : {&profile.estimate, &profile.lower95, &profile.upper95}) {
      *value = target.Told(*value);
    }
    for (ProfilePoint& point : profile.points) point.value = target.Told(point.value);
  }
  return profiles;
}

}  // namespace pushid
