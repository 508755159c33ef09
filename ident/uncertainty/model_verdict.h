// ident: may the estimates be called identified? What the recordings say of everything that a fit
// takes as known, and of the model itself; and what that adds to the errors.
//
// With s_g the scores of cluster g by what is free, S_g by an assumption eta (below), H the Hessian
// of the cost, b = d2(cost)/d(free)d(eta) and m = -H^-1 b what eta moves the free ones by:
//   free     the estimates, and the step of the integrator by its stated error, as it errs in every
//            fit. Rejected: everything that is stated. A term that is missing is then found in none
//            of ten studies (seven as it is), pushes 1.2 times too strong in none of twelve
//   wanted   the value the recordings would give eta, one Newton step of it and of the free ones
//            together: -(S + m's) / (H_eta,eta + b'm), with the error of the clusters' scatter and
//            of the priors. Its score test has t = wanted / sqrt(error^2 + sigma^2) with clusters
//            - 1 degrees of freedom, sigma what is stated of eta (Wooldridge 2010, section 12.6)
//   part     a part of the data, the frames up to h or the pushes from the side, must ask for the
//            same estimates as all of them: its score, less the share H_h H^-1 of all, is zero on
//            average whatever the noise, clustered likewise (Hausman 1978; Newey 1985)
//   pushes   most of them agree with the motion they made, in direction, size and time
//            (datasets/inspection/findings.h)
//   motion   feet end, and hips turn, where and when the model has it (below); and it
//            explains most of their way
//   total    errors of a fit in which everything with a sigma is free, with that prior: CR2 as
//            uncertainty.h has it. What that fit would move an estimate by counts as an error of
//            the estimate as well, and so does what priors and settling pull it by:
//            total^2 = joint^2 + move^2 + pull^2
// The smallest p-value of each of the three families is multiplied by the number of its tests
// (Bonferroni); the model fails where one is below kVerdictLevel, which are 5 % in all. The tests
// know what is linear about the optimum and cannot see an error that looks like an estimate: those
// are what the total error is for.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ident/problem/behaviour.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

// Recorded less predicted motion of pushed people along the push. The mean of a cluster's
// recordings is one number; t has as many degrees of freedom as there are clusters, less one.
struct MotionTest {
  std::string quantity, unit;
  double difference = 0.0, error = 0.0, t = 0.0, p = 1.0;
};

struct MotionComparison {
  std::vector<MotionTest> tests;
  // Share of the hip's squared way from its first place, without the markers' white noise, which is
  // told by how errors change from frame to frame; median recording; NaN: nobody saw the motion.
  double explained = 1.0;
};

// Empty where a rollout fails.
MotionComparison CompareMotion(const FitProblem& problem, const FitPoint& point,
                               const Clusters& clusters);

inline constexpr double kVerdictLevel = 0.05 / 3.0;  // of each family
inline constexpr double kLeastExplained = 0.5;       // of the hips' way

struct AssumptionTest {
  std::string name, unit;
  double stated = 0.0;  // sigma; 0: of a term left out
  double wanted = 0.0, error = 0.0, t = 0.0, p = 1.0;
  std::vector<double> moves;  // of the shared estimates by one sigma, natural units; empty without

  // How much of the squared total error of an estimate is due to it, if so much were stated of it.
  double Widens(size_t estimate, double if_stated) const {
    if (estimate >= moves.size() || stated <= 0.0) return 0.0;
    const double by = moves[estimate] * if_stated / stated;
    const double told = error > 0.0 ? 1.0 / (1.0 + std::pow(if_stated / error, 2)) : 1.0;
    return by * by * told;
  }
};

inline constexpr char kFromTheSide[] = "pushes from the side";

struct PartTest {
  std::string parameter, part;  // "the first 16 frames"
  double t = 0.0, p = 1.0;
};

struct ModelVerdict {
  std::string not_checked = "an older version fitted";  // why nothing was; empty where it was
  // Why nothing is identified, whatever the checks say: there is one recording, or the fitted
  // people do not come to rest. Empty: no such reason.
  std::string none_identified;
  std::vector<AssumptionTest> assumptions;
  std::vector<PartTest> parts;
  MotionComparison motion;
  std::vector<std::string> of_pushes;  // what cannot be right of most pushes (findings.h)
  int freedom = 0;                     // of all tests
  // Times the number of tests, at most 1.
  double p_assumptions = 1.0, p_parts = 1.0, p_motion = 1.0;

  // Assumptions that could be tested: others look like estimates, or nothing here tells of them.
  size_t NumTested() const {
    return static_cast<size_t>(
        std::count_if(assumptions.begin(), assumptions.end(),
                      [](const AssumptionTest& test) { return test.error > 0.0; }));
  }
  bool checked() const { return not_checked.empty(); }
  bool fails() const {
    return checked() &&
           (!of_pushes.empty() || p_assumptions < kVerdictLevel || p_parts < kVerdictLevel ||
            p_motion < kVerdictLevel || motion.explained < kLeastExplained);
  }
};

// Adds the total errors to the estimates of `uncertainty`, which is of this point and knows what
// the demand to settle did, and takes "identified" back: weak where the total interval is wide,
// model-dependent where the model fails or its people do not come to rest. behaviour: at this
// point.
ModelVerdict JudgeModel(const FitProblem& problem, const FitPoint& point,
                        const Behaviour& behaviour, Uncertainty* uncertainty);

}  // namespace pushid
