// Names that are nearly right.
#include "datasets/files/names.h"

#include <gtest/gtest.h>

namespace pushid {
namespace {

TEST(MeantNameTest, TheNearestOfThoseThatAreNear) {
  const std::vector<std::string> known = {"LeftFoot", "RightFoot", "Kp_theta", "Kp_phi", "mu"};
  EXPECT_EQ(ClosestName("LeftFot", known), "LeftFoot");
  EXPECT_EQ(ClosestName("leftfoot", known), "LeftFoot") << "capitals alone";
  EXPECT_EQ(ClosestName("kp-teta", known), "Kp_theta");
  EXPECT_EQ(ClosestName("MU", known), "mu");
  EXPECT_EQ(ClosestName("nu", known), "") << "short words are near to too much";
  EXPECT_EQ(ClosestName("Spine", known), "");
  EXPECT_EQ(ClosestName("mu", known), "") << "it is known";
  EXPECT_EQ(Suggestion("LeftFot", known), "; did you mean LeftFoot?");
  EXPECT_EQ(Suggestion("Spine", known), "");
}

}  // namespace
}  // namespace pushid
