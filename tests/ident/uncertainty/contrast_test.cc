// Holm's correction and p values.
#include "ident/uncertainty/contrast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ident/problem/statistics.h"

namespace pushid {
namespace {

// Rows with these p values, of which NaN stands for one that is unidentifiable.
std::vector<double> Corrected(const std::vector<double>& p) {
  Contrast contrast;
  for (double one : p) {
    ContrastRow& row = contrast.rows.emplace_back();
    if (std::isnan(one)) row.status = EstimateStatus::kUnidentifiable;
    row.p = one;
  }
  CorrectForRows(&contrast);
  std::vector<double> corrected;
  for (const ContrastRow& row : contrast.rows) corrected.push_back(row.p_holm);
  return corrected;
}

// By hand (Holm 1979): 4 * 0.005 = 0.02, 3 * 0.01 = 0.03, 2 * 0.03 = 0.06, 1 * 0.04 = 0.04 < 0.06.
TEST(CorrectForRows, ByHand) {
  const std::vector<double> corrected = Corrected({0.01, 0.04, 0.03, 0.005});
  ASSERT_EQ(corrected.size(), 4u);
  EXPECT_DOUBLE_EQ(corrected[0], 0.03);
  EXPECT_DOUBLE_EQ(corrected[1], 0.06);
  EXPECT_DOUBLE_EQ(corrected[2], 0.06);
  EXPECT_DOUBLE_EQ(corrected[3], 0.02);
}

TEST(CorrectForRows, NeverExceedsOneAndDoesNotCountTheUnknown) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Corrected({0.6, 0.7, nan}), (std::vector<double>{1.0, 1.0, 1.0}));
  EXPECT_EQ(Corrected({0.2, nan}), (std::vector<double>{0.2, 1.0}));
  EXPECT_TRUE(Corrected({}).empty());
}

// With one part it is Student's own; with none of freedom, the normal one.
TEST(ProbabilityOfZero, IsStudentsWithOnePart) {
  Scatter scatter;
  scatter.Add(Eigen::Matrix<double, 1, 1>(4.0), 7.0);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  for (double value : {0.1, 2.0, -9.0}) {
    EXPECT_NEAR(ProbabilityOfZero(scatter, one, value), StudentTail(std::abs(value) / 2.0, 7.0),
                1e-10);
  }
  Scatter known;
  known.Add(Eigen::Matrix<double, 1, 1>(1.0), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(ProbabilityOfZero(known, one, 1.959963984540054), 0.05, 1e-9);
}

// It is 0.05 just where the 95 % interval ends at zero, whatever the parts are.
TEST(ProbabilityOfZero, AgreesWithTheInterval) {
  Scatter scatter;
  scatter.Add(2.0 * Eigen::MatrixXd::Identity(2, 2), 5.0);
  scatter.Add(0.7 * Eigen::MatrixXd::Identity(2, 2), std::numeric_limits<double>::infinity());
  const Eigen::Vector2d coefficients(1.0, -0.5);
  const double half_width = scatter.Of(coefficients).HalfWidth();
  EXPECT_NEAR(ProbabilityOfZero(scatter, coefficients, half_width), 0.05, 1e-9);
  EXPECT_LT(ProbabilityOfZero(scatter, coefficients, 1.1 * half_width), 0.05);
  EXPECT_EQ(ProbabilityOfZero({}, coefficients, 1.0), 1.0);
}

// Values of scipy.stats.ttest_ind(a, b, equal_var=False) and ttest_rel(a, b).
TEST(JudgeByPeople, IsWelchsTestOrThePairedOne) {
  ContrastRow row;
  ASSERT_TRUE(JudgeByPeople(Transform::kIdentity,
                            {{"A", false, 1.0},
                             {"B", false, 2.0},
                             {"C", false, 3.0},
                             {"D", true, 4.0},
                             {"E", true, 5.0},
                             {"F", true, 9.0}},
                            &row));
  EXPECT_DOUBLE_EQ(row.difference, 4.0);
  EXPECT_NEAR(row.p, 0.1063667160, 1e-6);
  EXPECT_NEAR(row.lower95, -1.740656, 1e-3);
  EXPECT_DOUBLE_EQ(*row.effect, 2.0);

  ASSERT_TRUE(JudgeByPeople(Transform::kIdentity,
                            {{"A", false, 1.0},
                             {"A", true, 2.0},
                             {"B", false, 2.0},
                             {"B", true, 4.0},
                             {"C", false, 3.0},
                             {"C", true, 6.0}},
                            &row));
  EXPECT_DOUBLE_EQ(row.difference, 2.0);
  EXPECT_NEAR(row.p, 0.0741799002, 1e-6);
  EXPECT_FALSE(JudgeByPeople(Transform::kLog, {{"A", false, 1.0}, {"B", true, 2.0}}, &row));
}

}  // namespace
}  // namespace pushid
