// Numbers as messages show them.
#include "datasets/files/number_text.h"

#include <gtest/gtest.h>

namespace pushid {
namespace {

TEST(RoundedTest, PlainUpToAMillion) {
  EXPECT_EQ(Rounded(1049.6, 3), "1050");
  EXPECT_EQ(Rounded(500.0, 1), "500");
  EXPECT_EQ(Rounded(-999499.0, 3), "-999000");
  EXPECT_EQ(Rounded(1234567.0, 3), "1.23e+06");
  EXPECT_EQ(Rounded(0.000012345, 3), "1.23e-05");
  EXPECT_EQ(Rounded(12.345, 3), "12.3");
  EXPECT_EQ(Rounded(0.0, 3), "0");
}

}  // namespace
}  // namespace pushid
