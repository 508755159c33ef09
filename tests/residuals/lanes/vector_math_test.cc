// The functions over vectors against the standard library's, at the width that every processor has.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "datasets/files/random.h"

#define PUSHID_VECTOR_DOUBLES 2
#include "residuals/lanes/lane_scalar.h"

namespace pushid {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

// The largest error of `of` within [-most, most], relative to the value.
template <typename Of, typename Expected>
double LargestError(double most, const Of& of, const Expected& expected) {
  Random random(77);
  double largest = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double x = random.Uniform(-most, most), here = expected(x);
    const Vector result = of(Vector{x, -x});
    largest = std::max(largest, std::abs(result[0] - here) / std::abs(here));
  }
  return largest;
}

TEST(VectorMath, SinesAndCosinesAreExactToAnUlp) {
  const auto sine = [](Vector x) { return SinCosOf(x).sine; };
  const auto cosine = [](Vector x) { return SinCosOf(x).cosine; };
  for (double most : {1e-6, 0.1, 1.6, 10.0, 1e5}) {
    SCOPED_TRACE(most);
    EXPECT_LT(LargestError(most, sine, [](double x) { return std::sin(x); }), 1.5 * kUlp);
    EXPECT_LT(LargestError(most, cosine, [](double x) { return std::cos(x); }), 1.5 * kUlp);
  }
  const SineAndCosine zero = SinCosOf(Vector{});
  EXPECT_EQ(zero.sine[0], 0.0);
  EXPECT_EQ(zero.cosine[0], 1.0);
  EXPECT_TRUE(std::isnan(SinCosOf(Vector{} + NAN).sine[0]));
}

TEST(VectorMath, ExponentialsAreExactToAnUlp) {
  for (double most : {1e-6, 1.0, 30.0, 690.0}) {
    SCOPED_TRACE(most);
    EXPECT_LT(LargestError(most, ExpOf, [](double x) { return std::exp(x); }), 1.5 * kUlp);
    EXPECT_LT(LargestError(most, TanhOf, [](double x) { return std::tanh(x); }), 2.5 * kUlp);
  }
  EXPECT_TRUE(std::isnan(ExpOf(Vector{} + NAN)[0]));
  EXPECT_TRUE(std::isnan(TanhOf(Vector{} + NAN)[0]));
  EXPECT_EQ(TanhOf(Vector{} - std::numeric_limits<double>::infinity())[0], -1.0);
}

}  // namespace
}  // namespace pushid
