// tests: the gradient of whole recordings by the adjoint and by jets.
#pragma once

#include <ceres/problem.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <vector>

#include "residuals/adjoint/adjoint_gradient.h"
#include "residuals/jets/autodiff_rollout.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {

struct Gradient {
  double cost = 0.0;
  std::vector<double> shared, weights;
};

// Ceres' own sum over blocks of AutoDiffRollout. What is held: one set for all people of a
// recording.
inline Gradient ByJets(const std::vector<AdjointRecording>& recordings, const ModelOptions& options,
                       const ParameterMap& map, std::vector<double> shared,
                       std::vector<double> weights) {
  ceres::Problem problem;
  for (const AdjointRecording& r : recordings) {
    ParameterMap own = map;
    if (!r.held.empty()) own.values = r.held.front();
    problem.AddResidualBlock(new AutoDiffRollout(MakeRolloutProblem(*r.recording, options, own, {},
                                                                    r.weight, r.horizon)),
                             nullptr, shared.data(), weights.data());
  }
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = {shared.data(), weights.data()};
  std::vector<double> flat;
  Gradient result;
  EXPECT_TRUE(problem.Evaluate(evaluate, &result.cost, nullptr, &flat, nullptr));
  result.shared.assign(flat.begin(), flat.begin() + map.num_shared());
  result.weights.assign(flat.begin() + map.num_shared(), flat.end());
  return result;
}

inline Gradient ByAdjoint(AdjointGradient* adjoint, const std::vector<double>& shared,
                          const std::vector<double>& weights) {
  Gradient result{0.0, std::vector<double>(adjoint->num_shared(), NAN),
                  std::vector<double>(adjoint->num_weights(), NAN)};
  const AdjointCost cost =
      adjoint->Evaluate(shared.data(), weights.data(), result.shared.data(), result.weights.data());
  EXPECT_TRUE(cost.ok());
  result.cost = cost.cost;
  return result;
}

// relative: to the largest entry, as rounding is.
inline void ExpectSameVector(const std::vector<double>& actual, const std::vector<double>& expected,
                             double relative, const char* name) {
  ASSERT_EQ(actual.size(), expected.size());
  double largest = 0.0;
  for (double value : expected) largest = std::max(largest, std::abs(value));
  for (size_t i = 0; i < actual.size(); ++i) {
    // Written so that NaN on either side is wrong.
    if (std::abs(actual[i] - expected[i]) <= relative * largest) continue;
    ADD_FAILURE() << std::setprecision(17) << "by " << name << " " << i << ": " << actual[i]
                  << ", expected " << expected[i] << ", the largest is " << largest;
    return;
  }
}

}  // namespace pushid
