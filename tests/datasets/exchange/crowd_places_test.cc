// Where a crowd's people stand in one frame.
#include <gtest/gtest.h>

#include "datasets/exchange/crowd.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class CrowdPlacesTest : public TempDirTest {
 protected:
  std::string Crowd() {
    return WriteText("crowd.txt",
                     "# framerate: 10\n# id frame x/cm y/cm\n1 5 100 0\n2 5 50 30\n3 5 50 -30\n1 6 "
                     "110 0\n4 7 0 0\n");
  }
};

TEST_F(CrowdPlacesTest, FromTheBackForwardsInMetres) {
  const auto read = Unwrapped(ReadCrowdPlaces(Crowd(), std::nullopt));
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[0].name, "3");
  EXPECT_EQ(read[1].name, "2");
  EXPECT_EQ(read[2].name, "1");
  EXPECT_EQ(read[0].position, Eigen::Vector2d(0.5, -0.3));
  EXPECT_EQ(ReadCrowdPlaces(Crowd(), 6).value().size(), 1u);
}

TEST_F(CrowdPlacesTest, Errors) {
  EXPECT_TRUE(Contains(ReadCrowdPlaces(Crowd(), 3).error().ToString(),
                       "there is no frame 3; the file has those from 5 to 7"));
  EXPECT_TRUE(Contains(ReadCrowdPlaces(Crowd(), -1).error().ToString(), "there is no frame -1"));
  EXPECT_TRUE(Contains(ReadCrowdPlaces("a.csv", 0).error().ToString(), ".txt or .sqlite"));
}

TEST_F(CrowdPlacesTest, OddSpacing) {
  EXPECT_EQ(OddSpacing({{"1", {0, 0}}, {"2", {0.5, 0}}}), "");
  EXPECT_EQ(OddSpacing({{"1", {0, 0}}}), "");
  EXPECT_TRUE(Contains(OddSpacing({{"7", {0, 0}}, {"9", {0.05, 0}}}), "people 7 and 9"));
  EXPECT_TRUE(Contains(OddSpacing({{"1", {0, 0}}, {"2", {45, 0}}}), "45 m away"));
}

}  // namespace
}  // namespace pushid
