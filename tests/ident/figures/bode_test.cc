// Bode plots: phases in sequence, and what is drawn.
#include <gtest/gtest.h>

#include "ident/figures/chart.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

BodePlot Falling() {
  BodePlot plot;
  plot.gain_unit = "rad/m";
  plot.hz = {0.1, 0.2, 0.5, 1.0, 2.0};
  plot.gain = {10.0, 8.0, 2.0, 0.5, 0.02};
  plot.phase = {-100.0, -150.0, 170.0, 120.0, 60.0};
  plot.measured.push_back({0.5, 2.1, 1.9, 2.3, 165.0, 10.0, 0.9});
  plot.measured.push_back({1.0, 0.5, 0.4, 0.6, -230.0, 12.0, 0.5});
  return plot;
}

TEST(Bode, PhasesGoOn) {
  BodePlot plot = Falling();
  Unwrap(&plot);
  EXPECT_EQ(plot.phase, (std::vector<double>{-100.0, -150.0, -190.0, -240.0, -300.0}));
  EXPECT_DOUBLE_EQ(plot.measured[0].phase, -195.0);
  EXPECT_DOUBLE_EQ(plot.measured[1].phase, -230.0);
  BodePlot alone = Falling();
  alone.hz.clear(), alone.gain.clear(), alone.phase.clear();
  Unwrap(&alone);
  EXPECT_DOUBLE_EQ(alone.measured[0].phase, 165.0);
  EXPECT_DOUBLE_EQ(alone.measured[1].phase, 130.0);
}

TEST(Bode, DrawsThreePanels) {
  BodePlot plot = Falling();
  Unwrap(&plot);
  const std::string svg = DrawFigure(BodeFigure(plot), 640, "").ToInline();
  for (const char* part : {"gain, rad/m", "phase, degrees", "coherence", "frequency, Hz", "model",
                           ">0.1<", ">1<", ">0.5<"}) {
    EXPECT_TRUE(Contains(svg, part));
  }
  EXPECT_FALSE(Contains(svg, "nan"));
  EXPECT_FALSE(Contains(svg, "inf"));
  const Figure alone = BodeFigure({"1", {plot.measured[0]}, {}, {}, {}});
  EXPECT_FALSE(Contains(DrawFigure(alone, 640, "").ToInline(), "nan"));
}

}  // namespace
}  // namespace pushid
