// ident: walking along a profile with adaptive steps.

#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/profile.h"

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

// rise: of the root, over the last step.
double NextStep(const ProfileSearch& search, double step, double rise) {
  const double aim = std::sqrt(2.0 * search.threshold);
  const int steps = search.locate_crossing ? kStepsToThreshold : kStepsToClassify;
  const double wanted = rise > 0.0 ? aim / steps * step / rise : kMaxGrowth * step;
  return std::clamp(wanted, step / kMaxGrowth, kMaxGrowth * step);
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
    step = NextStep(search, std::abs(fit.value - last.value), root - Root(search, last));
    before = last;
    last = fit;
  }
  return side;
}

namespace {

ProfileTarget CombinationTarget(const FitProblem& problem, const CombinationSpec& spec) {
  const ParameterMap& map = problem.map();
  ProfileTarget target{spec.name, spec.unit};
  target.coefficients.assign(map.fitted.size(), 0.0);
  for (const Term& term : spec.terms) {
    const auto at =
        std::find_if(map.fitted.begin(), map.fitted.end(),
                     [&term](const FittedParameter& f) { return f.parameter == term.parameter; });
    if (at == map.fitted.end()) {
      target.constant += term.coefficient * map.values[term.parameter];
    } else {
      target.coefficients[static_cast<size_t>(at - map.fitted.begin())] += term.coefficient;
    }
  }
  return target;
}

}  // namespace

double ProfileTarget::Quantile(const Uncertainty& uncertainty) const {
  const std::vector<Estimate>& estimates = uncertainty.estimates;
  if (index >= 0) return estimates[index].quantile;
  double quantile = 0.0;
  for (size_t i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i] != 0.0) quantile = std::max(quantile, estimates[i].quantile);
  }
  return quantile;
}

ProfilePlan::ProfilePlan(const FitProblem& problem) {
  const auto& fitted = problem.map().fitted;
  for (size_t i = 0; i < fitted.size(); ++i) {
    const ParameterSpec& spec = problem.options().table[fitted[i].parameter];
    targets_.push_back({spec.name, spec.unit, spec.transform, static_cast<int>(i)});
    all_.push_back({spec.name, spec.unit, i});
  }
  for (const CombinationSpec& spec : DerivedCombinations(problem.options().model)) {
    Add(CombinationTarget(problem, spec));
  }
}

MaybeError ProfilePlan::Choose(const std::vector<std::string>& names) {
  std::string known;
  for (const ReportedProfile& r : all_) known += (known.empty() ? "" : ", ") + r.name;
  for (const std::string& name : names) {
    const auto at = std::find_if(all_.begin(), all_.end(),
                                 [&name](const ReportedProfile& r) { return r.name == name; });
    if (at == all_.end()) {
      return Error{"there is no profile of '" + name + "'; free numbers are " + known};
    }
    chosen_.push_back(*at);
  }
  if (names.empty()) chosen_ = all_;
  return std::nullopt;
}

Profile ProfilePlan::Reported(const ReportedProfile& reported, Profile profile) const {
  const Transform transform = targets_[reported.target].transform;
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

void ProfilePlan::Add(const ProfileTarget& combination) {
  const auto& c = combination.coefficients;
  const auto moves = [](double coefficient) { return coefficient != 0.0; };
  const auto first = std::find_if(c.begin(), c.end(), moves);
  if (first == c.end()) return;
  if (std::count_if(c.begin(), c.end(), moves) == 1) {
    all_.push_back({combination.name, combination.unit, static_cast<size_t>(first - c.begin()),
                    *first, combination.constant});
    return;
  }
  all_.push_back({combination.name, combination.unit, targets_.size()});
  targets_.push_back(combination);
}

}  // namespace pushid
