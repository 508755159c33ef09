// tests: one check for the Jacobian of every cost function.
//
//   ExpectCorrectJacobian(cost, oracle, blocks, tolerance);   // against another cost function
//   ExpectCorrectJacobian(cost, blocks, tolerance);           // against Ridders' differentiation
//   ExpectDirectionalDerivatives(cost, blocks, tolerance);    // the same along a few directions
// An entry is right if |actual - expected| <= relative * (largest |expected| of its column) +
// absolute. The tolerance is relative to the column, because an entry that vanishes by cancellation
// has the rounding of its column. Outputs are filled with NaN first, so that entries that are not
// written are found; requests for the Jacobians of some blocks only must give the same numbers.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <random>
#include <vector>

namespace pushid {

using ParameterBlocks = std::vector<std::vector<double>>;

struct JacobianTolerance {
  double relative = 1e-10;  // to the largest entry of the column
  double absolute = 1e-13;  // for columns that vanish, for example at rest
  double residual = 1e-14;  // between residuals, relative to 1 or to themselves
};

// The outputs of one call of Evaluate; NaN in entries that it did not write.
struct CostEvaluation {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  bool ok = false;
  Eigen::VectorXd residuals;
  std::vector<RowMajor> jacobians;  // one per block; NaN if not requested
};

// wanted: blocks whose Jacobians are requested; empty: a null pointer.
inline CostEvaluation EvaluateCost(const ceres::CostFunction& cost, const ParameterBlocks& blocks,
                                   const std::vector<bool>& wanted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CostEvaluation result;
  result.residuals = Eigen::VectorXd::Constant(cost.num_residuals(), nan);
  std::vector<const double*> parameters;
  std::vector<double*> pointers;
  result.jacobians.reserve(blocks.size());
  for (size_t b = 0; b < blocks.size(); ++b) {
    const Eigen::Index columns = cost.parameter_block_sizes()[b];
    parameters.push_back(blocks[b].data());
    result.jacobians.push_back(
        CostEvaluation::RowMajor::Constant(cost.num_residuals(), columns, nan));
    pointers.push_back(!wanted.empty() && wanted[b] ? result.jacobians[b].data() : nullptr);
  }
  result.ok = cost.Evaluate(parameters.data(), result.residuals.data(),
                            wanted.empty() ? nullptr : pointers.data());
  return result;
}

// Checks that both have the same sizes, which the blocks fit.
inline void ExpectSameShape(const ceres::CostFunction& cost, const ceres::CostFunction& oracle,
                            const ParameterBlocks& blocks) {
  ASSERT_EQ(cost.num_residuals(), oracle.num_residuals());
  ASSERT_EQ(cost.parameter_block_sizes(), oracle.parameter_block_sizes());
  ASSERT_EQ(cost.parameter_block_sizes().size(), blocks.size());
  for (size_t b = 0; b < blocks.size(); ++b) {
    ASSERT_EQ(cost.parameter_block_sizes()[b], static_cast<int>(blocks[b].size())) << "block " << b;
  }
}

inline void ExpectSameResiduals(const Eigen::VectorXd& actual, const Eigen::VectorXd& expected,
                                double tolerance) {
  for (Eigen::Index row = 0; row < expected.size(); ++row) {
    const double allowed = tolerance * std::max(1.0, std::abs(expected[row]));
    if (std::abs(actual[row] - expected[row]) <= allowed) continue;
    ADD_FAILURE() << std::setprecision(17) << "residual " << row << " is " << actual[row]
                  << ", expected " << expected[row];
    return;
  }
}

// Describes the wrong entries.
inline void ExpectSameJacobians(const CostEvaluation& actual, const CostEvaluation& expected,
                                const JacobianTolerance& tolerance) {
  constexpr int kMaxNamed = 8;
  int wrong = 0;
  for (size_t b = 0; b < expected.jacobians.size(); ++b) {
    const CostEvaluation::RowMajor& right = expected.jacobians[b];
    for (Eigen::Index column = 0; column < right.cols(); ++column) {
      const double allowed =
          tolerance.relative * right.col(column).cwiseAbs().maxCoeff() + tolerance.absolute;
      for (Eigen::Index row = 0; row < right.rows(); ++row) {
        const double value = actual.jacobians[b](row, column);
        // Written so that NaN on either side is wrong.
        if (std::abs(value - right(row, column)) <= allowed) continue;
        if (++wrong > kMaxNamed) continue;
        ADD_FAILURE() << std::setprecision(17) << "Jacobian of block " << b << ", row " << row
                      << ", column " << column << " is " << value << ", expected "
                      << right(row, column) << " +- " << allowed;
      }
    }
  }
  if (wrong > kMaxNamed) ADD_FAILURE() << wrong << " wrong Jacobian entries in all";
}

// Evaluates without Jacobians, with each block's alone, and with all but each block's: the numbers
// must be the same, and nothing else may be written.
inline void ExpectPartialJacobians(const ceres::CostFunction& cost, const ParameterBlocks& blocks,
                                   const CostEvaluation& full, double residual_tolerance) {
  const CostEvaluation none = EvaluateCost(cost, blocks, {});
  ASSERT_TRUE(none.ok) << "Evaluate failed without Jacobians";
  ExpectSameResiduals(none.residuals, full.residuals, residual_tolerance);
  for (size_t chosen = 0; chosen < blocks.size(); ++chosen) {
    for (bool alone : {true, false}) {
      std::vector<bool> wanted(blocks.size(), !alone);
      wanted[chosen] = alone;
      const CostEvaluation partial = EvaluateCost(cost, blocks, wanted);
      ASSERT_TRUE(partial.ok);
      EXPECT_EQ(partial.residuals, full.residuals);
      for (size_t b = 0; b < blocks.size(); ++b) {
        if (wanted[b]) {
          // Up to rounding: sums may be in another order if a block is held.
          const double largest = full.jacobians[b].cwiseAbs().maxCoeff();
          EXPECT_LE((partial.jacobians[b] - full.jacobians[b]).cwiseAbs().maxCoeff(),
                    1e-12 * largest)
              << "block " << b << " asked for " << (alone ? "alone" : "among others");
        } else {
          EXPECT_TRUE(partial.jacobians[b].array().isNaN().all())
              << "block " << b << " was written without being asked for";
        }
      }
    }
  }
}

inline void ExpectCorrectJacobian(const ceres::CostFunction& cost,
                                  const ceres::CostFunction& oracle, const ParameterBlocks& blocks,
                                  const JacobianTolerance& tolerance = {}) {
  ExpectSameShape(cost, oracle, blocks);
  if (testing::Test::HasFatalFailure()) return;
  const std::vector<bool> all(blocks.size(), true);
  const CostEvaluation actual = EvaluateCost(cost, blocks, all);
  const CostEvaluation expected = EvaluateCost(oracle, blocks, all);
  ASSERT_TRUE(expected.ok) << "the oracle could not be evaluated: a test of nothing";
  ASSERT_TRUE(actual.ok) << "Evaluate failed where the oracle did not";
  ExpectSameResiduals(actual.residuals, expected.residuals, tolerance.residual);
  ExpectSameJacobians(actual, expected, tolerance);
  ExpectPartialJacobians(cost, blocks, actual, tolerance.residual);
}

// A functor of the residuals of a cost function, for numeric differentiation.
struct ResidualsOf {
  const ceres::CostFunction* cost;
  bool operator()(double const* const* blocks, double* residuals) const {
    return cost->Evaluate(blocks, residuals, nullptr);
  }
};

// relative: the error of Ridders' method is about 1e-8 for residuals of order 1.
inline void ExpectCorrectJacobian(const ceres::CostFunction& cost, const ParameterBlocks& blocks,
                                  const JacobianTolerance& tolerance = {1e-7, 1e-8, 1e-14}) {
  ceres::NumericDiffOptions options;
  // The step is short, because |v| of the quadratic damping has a kink within 1e-3 m/s.
  options.ridders_relative_initial_step_size = 1e-5;
  ceres::DynamicNumericDiffCostFunction<ResidualsOf, ceres::RIDDERS> oracle(
      new ResidualsOf{&cost}, ceres::TAKE_OWNERSHIP, options);
  for (int size : cost.parameter_block_sizes()) oracle.AddParameterBlock(size);
  oracle.SetNumResiduals(cost.num_residuals());
  ExpectCorrectJacobian(cost, oracle, blocks, tolerance);
}

// Compares J u with central differences along random directions u, in which all columns have the
// same weight: a cheap check of all columns, for tests of many models. relative: to the largest
// entry of J u.
inline void ExpectDirectionalDerivatives(const ceres::CostFunction& cost,
                                         const ParameterBlocks& blocks,
                                         const JacobianTolerance& tolerance = {1e-6, 1e-11, 0.0}) {
  constexpr int kDirections = 3;
  const CostEvaluation at = EvaluateCost(cost, blocks, std::vector<bool>(blocks.size(), true));
  ASSERT_TRUE(at.ok);
  ExpectSameResiduals(EvaluateCost(cost, blocks, {}).residuals, at.residuals, 1e-11);
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> size(0.5, 1.0);
  for (int k = 0; k < kDirections; ++k) {
    ParameterBlocks u = blocks;
    Eigen::VectorXd along = Eigen::VectorXd::Zero(at.residuals.size());
    for (size_t b = 0; b < blocks.size(); ++b) {
      for (size_t i = 0; i < blocks[b].size(); ++i) {
        const Eigen::VectorXd column = at.jacobians[b].col(static_cast<Eigen::Index>(i));
        const double most = std::max(1.0, std::abs(blocks[b][i]));
        const double slope = column.cwiseAbs().maxCoeff();
        u[b][i] = (random() % 2 == 0 ? 1.0 : -1.0) * size(random) *
                  (slope * most > 1.0 ? 1.0 / slope : most);
        along += u[b][i] * column;
      }
    }
    const auto difference = [&](double step) {
      ParameterBlocks more = blocks, less = blocks;
      for (size_t b = 0; b < blocks.size(); ++b) {
        for (size_t i = 0; i < blocks[b].size(); ++i) {
          more[b][i] += step * u[b][i];
          less[b][i] -= step * u[b][i];
        }
      }
      const CostEvaluation above = EvaluateCost(cost, more, {});
      const CostEvaluation below = EvaluateCost(cost, less, {});
      EXPECT_TRUE(above.ok && below.ok);
      return ((above.residuals - below.residuals) / (2.0 * step)).eval();
    };
    // A long step may cross a kink of a residual; with a short one, the rounding that a rollout
    // amplifies may dominate.
    Eigen::Index row = 0;
    Eigen::VectorXd expected;
    bool agrees = false;
    for (double step : {1e-5, 1e-4, 1e-6}) {
      if (agrees) break;
      expected = (4.0 * difference(0.5 * step) - difference(step)) / 3.0;
      const double off = (along - expected).cwiseAbs().maxCoeff(&row);
      // Written so that NaN on either side is wrong.
      agrees = off <= tolerance.relative * expected.cwiseAbs().maxCoeff() + tolerance.absolute;
    }
    if (agrees) continue;
    ADD_FAILURE() << std::setprecision(17) << "along direction " << k << ", row " << row << ": "
                  << along[row] << ", expected " << expected[row];
    return;
  }
}

}  // namespace pushid
