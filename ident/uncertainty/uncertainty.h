// ident: standard errors, naive and clustered, what data, priors and settling contribute to each
// number, null directions, correlations.
//
// Covariances and degrees of freedom are those of covariance.h. Naive errors are up to 20 times too
// small here. A null direction of the scaled Jacobian has no finite error: every parameter it
// touches is unidentifiable, but combinations orthogonal to it are reported.
//
// With H = H_data + H_prior + H_settling the Hessian of the cost, H^-1 = H^-1 H H^-1 splits exactly
// into what each of the three says: a parameter's shares are the three parts of its diagonal entry.
// Priors pull a parameter by -H^-1 g of their gradient g, to first order. A demand that binds holds
// a fit on its edge, where its gradient says little: what it moved is the difference to the optimum
// without it, and so are the standard errors, as its information grows with its weight and says
// nothing of errors. All assume that the data weigh as much as they know (covariance.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "ident/parameters/fit_options.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/covariance.h"
#include "models/enum_names.h"
#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

class FitProblem;
struct FitPoint;
struct FittedColumn;  // residual_rows.h

enum class EstimateStatus {
  // The data's share is above 80 %, priors and settling together pull it by less than half a
  // standard error, and the interval is narrow (IsNarrow). Errors are clustered, and where the
  // interval is about people like those recorded, they are four or more.
  kIdentified,
  kModelDependent,  // identified, if the model were right: its checks fail (model_verdict.h)
  kWeak,            // neither of these nor anything below
  kPriorHeld,       // the data's share is below 50 %
  kUnidentifiable,  // a null direction of the data touches it
  kAtBound,
  kFixed
};
constexpr EnumNames<EstimateStatus, 7> Names(EstimateStatus) {
  return {{{"identified", EstimateStatus::kIdentified},
           {"model-dependent", EstimateStatus::kModelDependent},
           {"weak", EstimateStatus::kWeak},
           {"prior-held", EstimateStatus::kPriorHeld},
           {"unidentifiable", EstimateStatus::kUnidentifiable},
           {"at bound", EstimateStatus::kAtBound},
           {"fixed", EstimateStatus::kFixed}}};
}

// Fractions of a number's variance, and what moved it, natural unit.
struct Shares {
  double data = 1.0, prior = 0.0, settling = 0.0;
  double prior_pull = 0.0, settling_pull = 0.0;
};

// One fitted number: a shared parameter, a subject's deviation or an initial velocity.
struct Estimate {
  std::string name;
  std::string unit;
  double value = 0.0;                 // natural unit
  double standard_error = 0.0;        // clustered, natural unit; infinity when unidentifiable
  double standard_error_naive = 0.0;  // natural unit
  double lower95 = 0.0, upper95 = 0.0;
  double freedom = 1.0;   // of what the recordings say
  double quantile = 0.0;  // half-width over standard error, fitted scale
  // About these people alone; none where the interval above is about them, or naive.
  std::optional<Interval> these;
  // With what it owes to what the fit takes as known (model_verdict.h); shared parameters alone.
  std::optional<Interval> total;
  // The one that decides, and that readers are shown.
  Interval interval() const { return total.value_or(Interval{standard_error, lower95, upper95}); }
  Shares shares;
  EstimateStatus status = EstimateStatus::kIdentified;
};

// Whether the data, rather than priors and settling, say what an estimate is.
bool Leads(const Estimate& e);

// Whether an interval is narrow, on a scale that does not depend on the estimate, of which too
// large ones would pass most often: of a parameter that is fitted as a logarithm the half-width is
// below asinh(1/2), half of any value; of others below half the prior's standard deviation, or half
// the typical size where there is no prior (`width`).
bool IsNarrow(Transform transform, double width, double lower95, double upper95);

// About one fitted number, natural unit.
Interval IntervalOf(const FittedColumn& column, const ScatterOf& of);
// A total interval is never less than that of the data alone, which may have fewer degrees of
// freedom.
Interval WidenedTo(const Interval& least, Interval interval);

// A sum of parameters, by natural values.
struct Combination {
  std::string name;  // "mu + Kp_x"
  std::string unit;
  double value = 0.0, standard_error = 0.0, lower95 = 0.0, upper95 = 0.0;
  double quantile = 0.0;                           // half-width over standard error
  std::optional<Interval> these = {}, total = {};  // as those of Estimate

  Interval interval() const { return total.value_or(Interval{standard_error, lower95, upper95}); }
};

struct NullDirection {
  std::vector<std::string> parameters;  // those it touches
  std::vector<double> coefficients;     // in units of each parameter's scale, largest 1
  std::vector<Combination> identified;  // combinations that it leaves alone
  std::string sentence;
};

// The effect of the demand to settle on a fit.
struct SettlingDemand {
  bool binds = false;         // the fit without it does not settle in time
  bool contradicted = false;  // by the data: dropped
  bool unmet = false;         // no fit that meets it was found: dropped
  double rise = 0.0;          // of twice the negative log likelihood, by it
  double free_seconds = 0.0;  // in which people settle without it; infinite: they do not

  bool holds() const { return binds && !contradicted && !unmet; }
  bool dropped() const { return contradicted || unmet; }
};

struct Uncertainty {
  int num_residuals = 0;  // of data
  int num_clusters = 0;
  ClusterBy clustered_by = ClusterBy::kRecording;
  bool two_way = false;    // by people and by line-ups
  bool clustered = false;  // false with a single cluster: errors are those of the posterior
  int num_people = 0;
  bool about_people_like_them = false;  // not of these people alone
  double sigma = 0.0;                   // residual standard deviation, in sigmas
  int freedom = 1;                      // of all numbers together: clusters less one
  double condition_number = 0.0;        // of the scaled Jacobian, without null directions
  // Fewer clusters than shared parameters and one: correlations are the naive ones.
  bool too_few_clusters = false;
  bool full_hessian = false;        // whether the covariance knows second derivatives
  std::vector<Estimate> estimates;  // in the order of FitPoint::Flat
  Eigen::MatrixXd covariance;       // clustered (or the posterior's), fitted scale, same order
  Scatter scatter;                  // its parts, of a fresh fit alone
  Scatter these;                    // about these people; empty where `scatter` is
  Scatter total;                    // with what is taken as known; empty until JudgeModel
  Eigen::MatrixXd correlation;      // of that covariance
  // One column for each of the recordings `left_out`: what leaving it out would move.
  Eigen::MatrixXd moves;
  std::vector<int> left_out;
  std::vector<NullDirection> null_directions;
  // Sentences of directions in which priors and demands decide (DirectionTable).
  std::vector<std::string> held_directions;
  SettlingDemand settling;
};

// Fitted scale, in the order of FitPoint::Flat.
Covariance CovarianceAt(const FitProblem& problem, const FitPoint& point);

// free: the optimum without the demand to settle, where that binds; null: one Newton step away,
// (H - H_settling)^-1 g.
Uncertainty ComputeUncertainty(const FitProblem& problem, const FitPoint& point,
                               const FitPoint* free = nullptr);

// Directions that the recordings alone leave undetermined at a point, and the condition of the
// rest; cheaper than all of Uncertainty. score: of the problem there.
struct Conditioning {
  double condition_number = 0.0;
  std::vector<NullDirection> null_directions;
};
Conditioning ComputeConditioning(const FitProblem& problem, const FitPoint& point,
                                 const ResidualRows& score);

// A linear combination of natural values of shared parameters, and its error by the delta method.
struct Term {
  Parameter parameter;
  double coefficient;
};
struct CombinationSpec {
  std::string name, unit;
  std::vector<Term> terms;
};
Combination Combine(const FitProblem& problem, const FitPoint& point,
                    const Uncertainty& uncertainty, const CombinationSpec& spec);

// Reported beside the parameters of every result: c = mu + Kp, and gains per mass of the reference
// person.
std::vector<CombinationSpec> DerivedCombinations(const ModelOptions& model);

}  // namespace pushid
