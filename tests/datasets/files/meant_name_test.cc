// Names that are nearly right.
#include <gtest/gtest.h>

#include "datasets/files/names.h"

namespace pushid {
namespace {

TEST(MeantNameTest, TheNearestOfThoseThatAreNear) {
  const std::vector<std::string> known = {"LeftFoot", "RightFoot", "Kp_theta", "Kp_phi", "mu"};
  EXPECT_EQ(MeantBy("LeftFot", known), "LeftFoot");
  EXPECT_EQ(MeantBy("leftfoot", known), "LeftFoot") << "capitals alone";
  EXPECT_EQ(MeantBy("kp-teta", known), "Kp_theta");
  EXPECT_EQ(MeantBy("MU", known), "mu");
  EXPECT_EQ(MeantBy("nu", known), "") << "short words are near to too much";
  EXPECT_EQ(MeantBy("Spine", known), "");
  EXPECT_EQ(MeantBy("mu", known), "") << "it is known";
  EXPECT_EQ(MeantText("LeftFot", known), "; is LeftFoot meant?");
  EXPECT_EQ(MeantText("Spine", known), "");
}

}  // namespace
}  // namespace pushid
