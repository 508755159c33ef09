// ident: does the fitted motion look like the recorded one? Where the feet ended, when the hip
// turned back, and how often: what a sum of squares over frames hardly sees.
#pragma once

#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {

// Of pushed people, recorded less predicted, along the push. The mean of a cluster's recordings is
// one number; t has as many degrees of freedom as there are clusters, less one.
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

// Frames at which a path turns: extremes from which it goes back by at least `drop`.
std::vector<int> TurnsOf(const std::vector<double>& path, double drop);

}  // namespace pushid
