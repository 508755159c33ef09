// ident: profile likelihood: how far a parameter can be moved before the cost rises too far,
// everything else refitted at every step.
//
//   profile(v) = min of the cost C over all fitted numbers with parameter = v,  C = |r|^2 / 2
//   interval   = { v : 2 (profile(v) - C_min) <= threshold }
//
// The textbook threshold, sigma^2 F(1, N - P), takes frames as independent; those of one recording
// err together, and intervals come out up to 20 times too narrow. The cost difference is scaled
// instead so that its curvature at the optimum tells the clustered variance (Chandler & Bate 2007,
// Biometrika 94:167, "vertical" adjustment of an independence likelihood):
//
//   threshold = t(G - 1)^2 V_clustered / (H^-1)  =  t^2 sigma^2 V_clustered / V_naive
//
// With a quadratic cost the interval is the clustered one to the last digit; what a profile adds is
// the cost's true shape away from the optimum. Where a demand to settle moved the fit, V and H are
// those without it, as the errors are, and the profile adds what the demand leaves room for.
// Classes after Raue et al. 2009 (Bioinformatics 25:1923).
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/problem/parallel.h"
#include "ident/uncertainty/uncertainty.h"
#include "models/enum_names.h"

namespace pushid {

enum class ProfileClass {
  kIdentifiable,    // the threshold is crossed on both sides
  kPracticallyNot,  // not crossed on some side: the data are too weak
  kStructurallyNot  // flat: the data say nothing, however many of them
};
constexpr EnumNames<ProfileClass, 3> Names(ProfileClass) {
  return {{{"identifiable", ProfileClass::kIdentifiable},
           {"practically_not", ProfileClass::kPracticallyNot},
           {"structurally_not", ProfileClass::kStructurallyNot}}};
}

struct ProfilePoint {
  double value = 0.0;                    // of the parameter, natural unit
  double cost = 0.0;                     // of the objective, everything else refitted
  std::map<std::string, double> others;  // the other free parameters there, natural units
};

struct Profile {
  std::string name;
  std::string unit;
  double estimate = 0.0;
  ProfileClass classification = ProfileClass::kPracticallyNot;
  // The class without priors and demands, by the recordings alone; empty where there are none of
  // either, and where the recordings alone have no optimum to start from.
  std::optional<ProfileClass> by_data_alone;
  // Infinite on a side where the threshold is not crossed.
  double lower95 = -std::numeric_limits<double>::infinity();
  double upper95 = std::numeric_limits<double>::infinity();
  double cost = 0.0;                 // at the estimate
  double threshold = 0.0;            // of the cost itself: cost + threshold bounds the interval
  std::string lower_end, upper_end;  // why a side ended: threshold, bound, domain, flat or steps
  std::vector<ProfilePoint> points;  // ascending in value
};

// Profiles of the named parameters and derived combinations, or of all that move (empty names).
// Combinations of a single free parameter are that parameter's profile on another scale. Errors:
// names that are neither a free parameter nor a combination of one. classes_alone: nothing but
// names and classes, at less than half of the cost: where exactly a threshold is crossed does not
// matter to them, nor does the second side where the first says enough.
Result<std::vector<Profile>> ComputeProfiles(const FitProblem& problem, const FitPoint& estimate,
                                             const Uncertainty& uncertainty,
                                             const std::vector<std::string>& names, int num_threads,
                                             const JobProgress& progress = nullptr,
                                             bool classes_alone = false);

// Profiles of any number of any least-squares problem.

// The best fit found with the number held near `wanted`.
struct HeldFit {
  bool ok = false;
  double value = 0.0;  // of the number there
  double cost = 0.0;   // without what held it
  std::vector<double> point;
};
using HoldFit = std::function<HeldFit(double wanted, const std::vector<double>& from)>;

struct ProfileSearch {
  double estimate = 0.0, cost = 0.0;  // at the optimum
  std::vector<double> point;          // all fitted numbers there
  std::vector<double> direction;      // how they move with the number, to first order
  double naive_error = 1.0;           // 2 (profile - cost) grows like the square of moves over this
  double threshold = 0.0;             // of the cost
  double lower = -std::numeric_limits<double>::infinity();  // bounds of the number
  double upper = std::numeric_limits<double>::infinity();
  bool locate_crossing = true;  // false: it is known to lie before the last point
};

struct ProfileSide {
  // Where the threshold is crossed, or the last point where that is not located; infinite: nowhere.
  double crossing = 0.0;
  std::string end;  // as in Profile
  std::vector<HeldFit> points;

  bool Crosses() const { return std::isfinite(crossing); }
  bool IsFlat() const { return end == "flat"; }
};

// sign: +1 upwards, -1 downwards.
ProfileSide TraceProfile(const ProfileSearch& search, int sign, const HoldFit& hold);

}  // namespace pushid
