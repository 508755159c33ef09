// Transitions by hand; Jensen and Shannon's distance against SciPy.
#include <gtest/gtest.h>

#include <cmath>

#include "models/particles.h"

namespace pushid {
namespace {

TEST(TransitionStatisticsTest, CountsByHand) {
  const std::vector<Symbols> people = {{0, 0, 1, 1, 0}, {1, 0}, {1}, {}};
  Eigen::Matrix2d all, changes;
  all << 1, 1, 2, 1;
  changes << 0, 1, 2, 0;
  EXPECT_EQ(CountTransitions(people, 2, Transitions::kAll), all);
  EXPECT_EQ(CountTransitions(people, 2, Transitions::kChanges), changes);
}

TEST(JensenShannonTest, FromNothingToDisjoint) {
  const Eigen::Vector3d p(1, 2, 3), q(0, 0, 0);
  EXPECT_EQ(*JensenShannon(p, 7.0 * p), 0.0);  // counts are normalized
  EXPECT_NEAR(*JensenShannon(Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(0, 0, 4)),
              std::sqrt(std::log(2.0)), 1e-12);
  EXPECT_FALSE(JensenShannon(p, q).has_value());
  EXPECT_FALSE(JensenShannon(q, p).has_value());
}

// By hand: m = (1/2, 1/2) of (3/4, 1/4) and (1/4, 3/4); KL(p | m) = KL(q | m) =
// 3/4 ln(3/2) + 1/4 ln(1/2). The second value is scipy.spatial.distance.jensenshannon's, which
// its documentation gives for [1, 0, 0] and [0.5, 0.5, 0] in base e: sqrt(0.2157615543388356).
TEST(JensenShannonTest, KnownValues) {
  const double kl = 0.75 * std::log(1.5) + 0.25 * std::log(0.5);
  EXPECT_NEAR(*JensenShannon(Eigen::Vector2d(3, 1), Eigen::Vector2d(1, 3)), std::sqrt(kl), 1e-12);
  EXPECT_NEAR(*JensenShannon(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.5, 0.5, 0)),
              0.46450140402245893, 1e-12);
}

}  // namespace
}  // namespace pushid
