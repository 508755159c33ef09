// What the report says of people who stand.
#include <gtest/gtest.h>

#include "ident/report/page/sections.h"
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
  source.sway = SwayOfPeople(ModelOf(model.fit), {recording});
  return source;
}

TEST(StandingSections, TheLoopInWords) {
  const FittedModel model = Standing(Delay::kOne);
  const TextTable table = LoopTable(model.fit);
  const auto& rows = table.rows();
  ASSERT_EQ(rows.size(), 2u) << "alike in both planes";
  EXPECT_EQ(rows[1][0], "both directions");
  EXPECT_EQ(rows[1][1], "1.55");
  const ReportSection section = LoopSection({model});
  EXPECT_TRUE(Contains(section.paragraphs[0], "stiffness 1.55 times m g l"));
  EXPECT_TRUE(Contains(section.paragraphs[0], "phase margin"));
  EXPECT_TRUE(Contains(section.paragraphs[0], "delay margin"));
  FittedModel sideways = model;
  sideways.fit.parameters[kKpPhi] = 1100.0;
  EXPECT_EQ(LoopTable(sideways.fit).rows().size(), 3u);
  FittedModel late = model;
  late.fit.parameters[kReactionDelay] = 0.6;
  EXPECT_TRUE(Contains(LoopText(late.fit), "UNSTABLE"));
  FittedModel slides = model;
  slides.fit.options.model.stance = Stance::kSlide;
  EXPECT_TRUE(LoopText(slides.fit).empty());
  EXPECT_TRUE(LoopSection({slides}).tables.empty());
}

TEST(StandingSections, FrequencyResponse) {
  const FittedModel model = Standing(Delay::kOne);
  constexpr int kFrames = 4000;
  Scene scene = StandingScene(0.01);
  scene.ground = OscillatingGround(0, kFrames, 0.01, [](double s) { return 2e-3 * SumOfSines(s); });
  const PendulumRecording recording =
      RecordingOf(scene, model.fit.options.model, model.fit.parameters, kFrames, "A");
  const ReportSection section = FrequencySection(Seen(model, recording));
  ASSERT_EQ(section.figures.size(), 2u);
  EXPECT_EQ(section.figures[0].name, "frequency_angle_theta_by_ground_shift");
  EXPECT_EQ(section.figures[0].numbers.rows().size(), 7u);
  EXPECT_TRUE(Contains(section.figures[0].figure.panels[0].title, "gain, rad/m"));
  EXPECT_TRUE(Contains(section.figures[0].caption, "1 recording of 1 person"));
  EXPECT_TRUE(Contains(section.figures[1].caption, "torque by inverse dynamics"));
  EXPECT_TRUE(FrequencySection({model}).figures.empty());
}

TEST(StandingSections, QuietStance) {
  FittedModel model = Standing(Delay::kNone);
  model.fit.options.model.process_noise = ProcessNoise::kDiagonal;
  for (int i = 0; i < 4; ++i) model.fit.parameters[kSigmaX + i] = 1.0;
  const PendulumRecording recording = RecordingOf(StandingScene(0.02), model.fit.options.model,
                                                  model.fit.parameters, 1000, "A", true);
  const ReportSection section = SwaySection(Seen(model, recording));
  ASSERT_EQ(section.tables.size(), 1u);
  ASSERT_EQ(section.tables[0].table.rows().size(), 3u);
  EXPECT_EQ(section.tables[0].table.rows()[1][1], "pressure");
  EXPECT_TRUE(Contains(section.tables[0].table.rows()[2][3], " +- "));
  EXPECT_EQ(section.figures[0].numbers.rows().size(), 8u);
  EXPECT_TRUE(SwaySection({model}).tables.empty());
}

}  // namespace
}  // namespace pushid
