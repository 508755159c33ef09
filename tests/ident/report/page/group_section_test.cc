// The page's section on groups: how the push travels through them, where there are any.
#include <gtest/gtest.h>

#include "ident/report/page/build_report.h"

namespace pushid {
namespace {

TEST(GroupSectionTest, TellsHowThePushTravels) {
  const FittedModel model;
  ReportSource source = {model, model.fit};
  EXPECT_TRUE(GroupSection(source).tables.empty());
  source.propagation.recordings = 1;
  EXPECT_EQ(GroupSection(source).tables.size(), 1u);
}

}  // namespace
}  // namespace pushid
