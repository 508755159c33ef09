// Profiles against closed forms, against the clustered intervals they are scaled to, and where the
// data say nothing.
#include "ident/uncertainty/profile.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/solver/solver.h"
#include "residuals/cost_functions/prior_residual.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// y = a f(b), f_i = 1 - exp(-b x_i): a follows from b, so the profile of b is known in closed form:
//   2 profile(b) = |y|^2 - (y.f)^2 / (f.f)
// It levels off as b grows: f tends to a step.
struct Saturation {
  std::vector<double> x, y;

  double Profile(double b) const {
    double yy = 0.0, yf = 0.0, ff = 0.0;
    for (size_t i = 0; i < x.size(); ++i) {
      const double f = 1.0 - std::exp(-b * x[i]);
      yy += y[i] * y[i];
      yf += y[i] * f;
      ff += f * f;
    }
    return 0.5 * (yy - yf * yf / ff);
  }

  // The b with profile(b) = cost, between two that enclose it.
  double Solve(double cost, double below, double above) const {
    const bool rising = Profile(above) > Profile(below);
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (below + above);
      ((Profile(middle) < cost) == rising ? below : above) = middle;
    }
    return below;
  }
};

struct SaturationResidual {
  double x, y;
  template <typename T>
  bool operator()(const T* p, T* r) const {
    using std::exp;
    r[0] = y - p[0] * (1.0 - exp(-p[1] * x));
    return true;
  }
};

Saturation NoisyData(std::vector<double> x, double noise) {
  Saturation s;
  s.x = std::move(x);
  Random random(3);
  for (double at : s.x) s.y.push_back(2.0 * (1.0 - std::exp(-1.5 * at)) + noise * random.Normal());
  return s;
}

// hold_sigma 0: free.
HeldFit FitSaturation(const Saturation& s, double wanted, double hold_sigma,
                      const std::vector<double>& from) {
  std::vector<double> p = from;
  ceres::Problem problem;
  for (size_t i = 0; i < s.x.size(); ++i) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<SaturationResidual, 1, 2>(
                                 new SaturationResidual{s.x[i], s.y[i]}),
                             nullptr, p.data());
  }
  if (hold_sigma > 0.0) {
    problem.AddResidualBlock(new PriorResidual(2, 1, wanted, hold_sigma), nullptr, p.data());
  }
  ceres::Solver::Options options = SolverOptions(FitOptions(), problem);
  options.function_tolerance = 1e-15;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const double pull = hold_sigma > 0.0 ? (p[1] - wanted) / hold_sigma : 0.0;
  return {true, p[1], summary.final_cost - 0.5 * pull * pull, p};
}

ProfileSearch SearchAround(const Saturation& s, double threshold) {
  const HeldFit best = FitSaturation(s, 0.0, 0.0, {2.0, 1.5});
  ProfileSearch search;
  search.estimate = best.value;
  search.cost = best.cost;
  search.point = best.point;
  search.direction = {0.0, 1.0};
  search.naive_error = 0.3;
  search.threshold = threshold;
  search.lower = 1e-3;
  search.upper = 1e3;
  return search;
}

HoldFit Holder(const Saturation& s) {
  return [&s](double wanted, const std::vector<double>& from) {
    return FitSaturation(s, wanted, 0.01, from);
  };
}

TEST(ProfileSearch, FollowsTheClosedForm) {
  const Saturation s = NoisyData({0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0}, 0.05);
  const ProfileSearch search = SearchAround(s, 0.5 * 0.05 * 0.05 * 3.84);
  const double level = search.cost + search.threshold;
  for (int sign : {-1, 1}) {
    const ProfileSide side = TraceProfile(search, sign, Holder(s));
    EXPECT_EQ(side.end, "threshold");
    EXPECT_GE(side.points.size(), 3u);
    EXPECT_LE(side.points.size(), 15u);
    for (const HeldFit& fit : side.points) {
      EXPECT_NEAR(fit.cost, s.Profile(fit.value), 1e-9 * fit.cost) << fit.value;
    }
    const double exact = s.Solve(level, search.estimate, sign > 0 ? 10.0 : 0.1);
    EXPECT_NEAR(side.crossing, exact, 2e-3 * std::abs(exact - search.estimate));
  }
}

// The other number goes with the square of the held one, and a fit that starts 1 beside it ends in
// another basin: over 12.7 standard errors, those of two people, no step is as long as that.
TEST(ProfileSearch, StaysOnACurvedPath) {
  ProfileSearch search;
  search.point = {0.0, 0.0};
  search.direction = {1.0, 0.0};
  search.naive_error = 1.0;
  search.threshold = 0.5 * 12.7 * 12.7;
  search.lower = -100.0;
  search.upper = 100.0;
  const HoldFit hold = [](double wanted, const std::vector<double>& from) {
    const double path = 0.1 * wanted * wanted;
    const double basin = std::abs(from[1] - path) > 1.0 ? 300.0 : 0.0;
    return HeldFit{true, wanted, 0.5 * wanted * wanted + basin, {wanted, path}};
  };
  for (int sign : {-1, 1}) {
    EXPECT_NEAR(TraceProfile(search, sign, hold).crossing, sign * 12.7, 0.02);
  }
}

TEST(ProfileSearch, NeedNotLocateACrossing) {
  const Saturation s = NoisyData({0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0}, 0.05);
  ProfileSearch search = SearchAround(s, 0.5 * 0.05 * 0.05 * 3.84);
  const ProfileSide located = TraceProfile(search, 1, Holder(s));
  search.locate_crossing = false;
  const ProfileSide crossed = TraceProfile(search, 1, Holder(s));
  EXPECT_EQ(crossed.end, "threshold");
  EXPECT_GE(crossed.crossing, located.crossing);
  EXPECT_LT(crossed.points.size(), located.points.size());
}

// A number is held no harder than by its sigma: every fit ends short of where it is held.
TEST(ProfileSearch, FindsACrossingThoughFitsFallShort) {
  ProfileSearch search;
  search.point = {0.0};
  search.direction = {1.0};
  search.naive_error = 1.0;
  search.threshold = 0.5 * 1.96 * 1.96;
  const HoldFit hold = [](double wanted, const std::vector<double>&) {
    const double value = 0.98 * wanted;
    return HeldFit{true, value, 0.5 * value * value * (1.0 + 0.1 * value), {value}};
  };
  const ProfileSide side = TraceProfile(search, 1, hold);
  const auto beyond = std::find_if(side.points.begin(), side.points.end(), [&](const HeldFit& fit) {
    return fit.cost >= search.threshold;
  });
  ASSERT_NE(beyond, side.points.end());
  EXPECT_LE(side.points.end() - beyond, 3) << "two refinements";
  const double at = side.crossing;
  EXPECT_NEAR(0.5 * at * at * (1.0 + 0.1 * at), search.threshold, 3e-3 * search.threshold);
}

// Large x alone show the plateau, not how fast it is reached.
TEST(ProfileSearch, LevelsOffWhereTheDataAreTooWeak) {
  const Saturation s = NoisyData({2.0, 2.5, 3.0, 4.0}, 0.05);
  const ProfileSearch search = SearchAround(s, 0.5 * 0.05 * 0.05 * 12.7 * 12.7);
  ASSERT_LT(s.Profile(search.upper), search.cost + search.threshold);
  const ProfileSide above = TraceProfile(search, 1, Holder(s));
  EXPECT_EQ(above.end, "bound");
  EXPECT_EQ(above.crossing, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(above.points.back().value, search.upper, 1.0);
  EXPECT_EQ(TraceProfile(search, -1, Holder(s)).end, "threshold");
}

TEST(ProfileSearch, SaysWhenNothingHoldsANumber) {
  ProfileSearch search;
  search.point = search.direction = {0.0};
  search.threshold = 1.0;
  const HoldFit flat = [](double wanted, const std::vector<double>&) {
    return HeldFit{true, wanted, 0.0, {wanted}};
  };
  EXPECT_EQ(TraceProfile(search, 1, flat).end, "flat");
  const HoldFit nowhere = [](double, const std::vector<double>&) { return HeldFit(); };
  EXPECT_EQ(TraceProfile(search, 1, nowhere).end, "domain");
}

const Profile* Find(const std::vector<Profile>& profiles, const std::string& name) {
  for (const Profile& profile : profiles) {
    if (profile.name == name) return &profile;
  }
  return nullptr;
}

struct Profiled {
  std::vector<PendulumRecording> recordings;
  FitOptions options;
  FitResult result;

  explicit Profiled(const SyntheticOptions& study, const std::string& freed)
      : recordings(MakePendulums(study)), options(UnbiasedFit(study)) {
    EXPECT_FALSE(EditTable({"", freed, "", "", ""}, &options.table));
    result = Fit(recordings, options);
  }
  Result<std::vector<Profile>> Profiles(const std::vector<std::string>& names, int threads) const {
    return ComputeProfiles(FitProblem(recordings, options), result.starts[result.best_start].to,
                           result.uncertainty, names, threads);
  }
  std::vector<ProfileClass> Classes(const std::vector<std::string>& names) const {
    std::vector<ProfileClass> classes;
    for (const Profile& profile : Unwrapped(
             ComputeProfiles(FitProblem(recordings, options), result.starts[result.best_start].to,
                             result.uncertainty, names, 2, nullptr, true))) {
      classes.push_back(profile.classification);
    }
    return classes;
  }
};

// Little noise: the cost is quadratic over the interval.
TEST(Profiles, AreTheClusteredIntervalsWhereTheCostIsQuadratic) {
  SyntheticOptions study = TinyStudy();
  study.joint_noise_m = 1e-5;
  const Profiled profiled(study, "");
  const std::vector<Profile> profiles = profiled.Profiles({}, 2).value();
  for (const Estimate& e : profiled.result.uncertainty.estimates) {
    const Profile* profile = Find(profiles, e.name);
    ASSERT_NE(profile, nullptr) << e.name;
    EXPECT_EQ(profile->classification, ProfileClass::kIdentifiable) << e.name;
    EXPECT_NEAR(profile->lower95, e.lower95, 0.02 * (e.upper95 - e.lower95)) << e.name;
    EXPECT_NEAR(profile->upper95, e.upper95, 0.02 * (e.upper95 - e.lower95)) << e.name;
    EXPECT_EQ(profile->points.front().others.size(), 7u);
  }
}

// The weight of a demand to settle is no knowledge of how frames err.
TEST(Profiles, ThresholdsDoNotKnowHowHardADemandIsPressed) {
  SyntheticOptions study = SmallStudy();
  study.push_kind = PushKind::kExternal;
  study.parameters[kMu] = 25.0;
  study.parameters[kKpTheta] = 1800.0;
  study.parameters[kAx] = -9.0;
  study.subjects = 3;
  study.recordings_per_subject = 1;
  study.frames = 20;
  study.joint_noise_m = 0.03;
  const auto recordings = MakePendulums(study);
  std::vector<double> thresholds;
  for (double weight : {30.0, 90.0}) {
    FitOptions options = MakePreset("tail").value();
    options.settling_weight = weight;
    ASSERT_FALSE(PrepareFit(recordings, &options));
    const FitResult result = Fit(recordings, options);
    ASSERT_TRUE(result.uncertainty.settling.holds());
    const FitProblem problem(recordings, result.options);
    const auto profiles = ComputeProfiles(problem, result.starts[result.best_start].to,
                                          result.uncertainty, {"mu", "Kp_theta"}, 1);
    for (const Profile& profile : profiles.value()) thresholds.push_back(profile.threshold);
  }
  EXPECT_NEAR(thresholds[2] / thresholds[0], 1.0, 0.05);
  EXPECT_NEAR(thresholds[3] / thresholds[1], 1.0, 0.05);
}

TEST(Profiles, OfSumsAreProfilesOfTheirFreePart) {
  const Profiled profiled(TinyStudy(), "");
  const std::vector<Profile> two = profiled.Profiles({"mu", "c_x"}, 1).value();
  ASSERT_EQ(two.size(), 2u);
  const double held = profiled.result.parameters[kKpX];
  EXPECT_DOUBLE_EQ(two[1].lower95, two[0].lower95 + held);
  EXPECT_DOUBLE_EQ(two[1].estimate, two[0].estimate + held);
  EXPECT_EQ(two[1].points.size(), two[0].points.size());
}

TEST(Profiles, SeparateWhatIsIdentifiedFromWhatIsNot) {
  const Profiled profiled(TinyStudy(), "Kp_x,Kp_y");
  const std::vector<Profile> profiles = profiled.Profiles({"mu", "Kp_x", "c_x"}, 2).value();
  for (const char* name : {"mu", "Kp_x"}) {
    const Profile& profile = *Find(profiles, name);
    EXPECT_EQ(profile.classification, ProfileClass::kStructurallyNot) << name;
    EXPECT_EQ(profile.upper95, std::numeric_limits<double>::infinity()) << name;
  }
  const Profile& sum = *Find(profiles, "c_x");
  EXPECT_EQ(sum.classification, ProfileClass::kIdentifiable);
  EXPECT_LT(sum.lower95, sum.estimate);
  EXPECT_LT(sum.estimate, sum.upper95);
}

TEST(Profiles, ClassesAloneAreThoseOfTheProfiles) {
  for (const char* freed : {"", "Kp_x,Kp_y"}) {
    SCOPED_TRACE(freed);
    const Profiled profiled(TinyStudy(), freed);
    const std::vector<Profile> profiles = profiled.Profiles({}, 2).value();
    const std::vector<ProfileClass> classes = profiled.Classes({});
    ASSERT_EQ(classes.size(), profiles.size());
    for (size_t i = 0; i < classes.size(); ++i) {
      EXPECT_EQ(classes[i], profiles[i].classification) << profiles[i].name;
    }
  }
}

// A few noisy frames under narrow priors: these close the profile, and the data alone do not.
TEST(Profiles, TellWhatTheDataAloneSay) {
  SyntheticOptions study = TinyStudy();
  study.joint_noise_m = 0.01;
  study.frames = 8;
  FittedModel model;
  const auto recordings = MakePendulums(study);
  FitOptions options = DefaultFit(study);
  for (Parameter id : {kAx, kTailGain, kTailTorque, kTailTime}) options.table[id].free = false;
  options.table[kKpTheta].prior = Prior{1800.0, 100.0};
  model.fit = Fit(recordings, options);
  ASSERT_TRUE(model.fit.ok());
  ASSERT_FALSE(AddProfiles(recordings, {"Kp_theta"}, 1, nullptr, &model));
  const Profile& profile = model.profiles.at(0);
  EXPECT_EQ(profile.classification, ProfileClass::kIdentifiable);
  ASSERT_TRUE(profile.by_data_alone.has_value());
  EXPECT_NE(*profile.by_data_alone, ProfileClass::kIdentifiable);

  FittedModel unbiased;
  const SyntheticOptions exact = TinyStudy();
  unbiased.fit = Fit(MakePendulums(exact), UnbiasedFit(exact));
  ASSERT_FALSE(AddProfiles(MakePendulums(exact), {"Kp_theta"}, 1, nullptr, &unbiased));
  EXPECT_FALSE(unbiased.profiles.at(0).by_data_alone.has_value()) << "nothing was put in";
}

TEST(Profiles, NamesThatDoNotMoveAreErrors) {
  const Profiled profiled(TinyStudy(), "");
  const std::string fixed = ProblemOf(profiled.Profiles({"Kp_x"}, 1));
  EXPECT_TRUE(Contains(fixed, "no profile of 'Kp_x'"));
  EXPECT_TRUE(Contains(fixed, "tail_gain"));
}

}  // namespace
}  // namespace pushid
