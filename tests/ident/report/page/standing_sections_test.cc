// What the report says of people who stand.
#include <gtest/gtest.h>

#include "ident/report/fit_sections.h"
#include "ident/report/page/build_report.h"
#include "ident/report/report_text.h"
#include "tests/ident/laboratory_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

FittedModel Standing(Delay delay) {
  FittedModel model;
  model.fit.options.model = StandingOptions(delay);
  model.fit.parameters = StandingGains(1300.0, 400.0, delay == Delay::kNone ? 0.0 : 0.1);
  return model;
}

ReportSource Seen(const FittedModel& model, const PendulumRecording& recording) {
  ReportSource source{model};
  source.frequency = FrequencyResponses(ModelOf(model.fit), {recording});
  return source;
}

TEST(StandingSections, TheLoopInWords) {
  const FittedModel model = Standing(Delay::kOne);
  const TextTable table = LoopTable(model.fit);
  const auto& rows = table.rows();
  ASSERT_EQ(rows.size(), 2u) << "alike in both planes";
  EXPECT_EQ(rows[1][0], "both directions");
  EXPECT_EQ(rows[1][1], "1.55");
  const ReportSection section = LoopSection(model);
  EXPECT_TRUE(Contains(section.paragraphs[0], "a person of 85 kg"));
  EXPECT_EQ(section.tables[0].table.rows(), rows);
  FittedModel sideways = model;
  sideways.fit.parameters[kKpPhi] = 1100.0;
  EXPECT_EQ(LoopTable(sideways.fit).rows().size(), 3u);
  FittedModel late = model;
  late.fit.parameters[kReactionDelay] = 0.6;
  EXPECT_TRUE(Contains(LoopTable(late.fit).ToString(), "UNSTABLE"));
  FittedModel slides = model;
  slides.fit.options.model.stance = Stance::kSlide;
  EXPECT_TRUE(LoopTable(slides.fit).empty());
  EXPECT_TRUE(LoopSection(slides).tables.empty());
}

TEST(StandingSections, FrequencyResponse) {
  const FittedModel model = Standing(Delay::kOne);
  constexpr int kFrames = 4000;
  Scene scene = StandingScene(0.01);
  scene.ground = OscillatingGround(0, kFrames, 0.01, [](double s) { return 2e-3 * SumOfSines(s); });
  const PendulumRecording recording =
      RecordingOf(scene, model.fit.options.model, model.fit.parameters, kFrames, "A", true);
  const ReportSection section = FrequencySection(Seen(model, recording));
  ASSERT_EQ(section.figures.size(), 2u);
  EXPECT_EQ(section.figures[0].name, "frequency_angle_theta_by_ground_shift");
  EXPECT_EQ(section.figures[0].numbers.rows().size(), 7u);
  EXPECT_TRUE(Contains(section.figures[0].figure.panels[0].title, "gain, rad/m"));
  EXPECT_TRUE(Contains(section.figures[0].caption, "1 recording of 1 person"));
  // Phases go on without jumps of 360 degrees.
  const Chart& phase = section.figures[0].figure.panels[1];
  for (size_t i = 1; i < phase.lines[0].points.size(); ++i) {
    EXPECT_LT(std::abs(phase.lines[0].points[i].second - phase.lines[0].points[i - 1].second), 180);
  }
  EXPECT_FALSE(Contains(DrawFigure(section.figures[0].figure, 640, "").ToInline(), "nan"));
  EXPECT_TRUE(Contains(section.figures[1].caption, "torque by force platforms"));
  EXPECT_TRUE(FrequencySection({model}).figures.empty());
}

}  // namespace
}  // namespace pushid
