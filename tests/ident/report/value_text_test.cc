// Intervals and gains as they are said.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ident/report/report_text.h"
#include "ident/uncertainty/assumptions.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(ValueText, IntervalsSayWhatTheyTell) {
  EXPECT_EQ(IntervalText(31.0, -17.3, 80.3), "[-17.3, 80.3]");
  EXPECT_EQ(IntervalText(31.0, 0.07, 121.0), "[0.07, 121]");
  EXPECT_EQ(IntervalText(2340.0, 1800.0, 8.3e13), "[1800, open]");
  EXPECT_EQ(IntervalText(2340.0, 1e-8, 3000.0), "[open, 3000]");
  EXPECT_EQ(IntervalText(2340.0, 6.6e-8, 8.3e13), "undetermined");
  EXPECT_EQ(IntervalText(-10.0, -3e9, 3e9), "undetermined");
  EXPECT_EQ(IntervalText(-10.0, -20.0, INFINITY), "[-20, open]");
  EXPECT_EQ(IntervalText(0.0, -6.0, 6.0), "[-6, 6]");
  EXPECT_EQ(IntervalText(0.001, -0.5, 0.5), "[-0.5, 0.5]");
}

TEST(ValueText, WhatIsTakenAsKnownHasItsUnit) {
  FitResult result;
  AssumptionTest masses, support, drift;
  masses.name = "masses", masses.stated = 0.03;
  support.name = "support_back", support.stated = std::log(2.0);
  support.wanted = std::log(0.5), support.error = std::log(2.0);
  drift.name = "drift of the cameras", drift.unit = "m", drift.stated = drift.wanted = 0.005;
  drift.error = 0.001;
  result.verdict.assumptions = {masses, support, drift};
  const std::string table = AssumptionTable(result).ToString();
  EXPECT_TRUE(Contains(table, "+- 3 %"));
  EXPECT_TRUE(Contains(table, "factor 2 "));
  EXPECT_TRUE(Contains(table, "factor 0.5 (0.25 to 1)"));
  EXPECT_TRUE(Contains(table, "0.005 +- 0.001 m"));

  result.verdict.assumptions[1].wanted = -33.0;  // a factor of 4.7e-15
  EXPECT_TRUE(Contains(AssumptionTable(result).ToString(), "much smaller"));
}

TEST(ValueText, GainsAreSaidInWords) {
  FitResult result;
  EXPECT_EQ(GainsText(result), "");
  result.derived = {{"c_x", "N s/m", 34.0, 2.0, 30.0, 38.0},
                    {"c_x/M", "1/s", 0.4, 0.02, 0.36, 0.44},
                    {"Kp_theta/(m g l)", "1", 1.6, 0.1, 1.4, 1.8},
                    {"Kp_phi/(m g l)", "1", 2.0, 0.0, 2.0, 2.0},
                    {"Kd_theta/(m l^2)", "1/s", 0.5, 100.0, 1e-9, 1e9}};
  EXPECT_EQ(GainsText(result),
            "Ankle stiffness 1.6 times m g l (1 is just enough to hold a pendulum upright), to the "
            "side 2 times m g l (held), damping of the lean with a time constant of 2 s "
            "(undetermined), friction of the feet with a time constant of 2.5 s.");
}

// A p of 0.04 contradicts nothing, and the sentence says so.
TEST(ModelVerdictText, SaysWhichPContradicts) {
  FitResult result;
  ModelVerdict& verdict = result.verdict;
  verdict.not_checked.clear();
  verdict.motion.tests.resize(1);
  verdict.motion.explained = 0.9;
  verdict.p_motion = 0.04;
  const std::string text = FirstSentences(result);
  EXPECT_TRUE(Contains(text, "1 measure of feet and hips (p = 0.04; ")) << text;
  EXPECT_TRUE(Contains(text, "; less than 0.017 contradicts)")) << text;
}

// A median of 90 % does not hide a recording in which the person falls.
TEST(ModelVerdictText, WhatStandingStillPredictsBetterComesFirst) {
  FitResult result;
  result.verdict.not_checked.clear();
  result.verdict.motion.explained = 0.9;
  const auto recording = [](const std::string& id, double explained, bool moved) {
    RecordingDiagnostics r;
    r.id = id;
    r.explained = explained;
    r.moved = moved;
    return r;
  };
  result.diagnostics.recordings = {recording("a", 95.0, true), recording("b", -143.0, true),
                                   recording("quiet", -20.0, false)};
  EXPECT_EQ(FirstSentences(result).rfind("Standing still predicts 1 of 3 recordings better (b; "
                                         "the worst is explained to -143 %). The model check "
                                         "found no other contradiction: ",
                                         0),
            0u)
      << FirstSentences(result);
  result.diagnostics.recordings[0].explained = -1.0;
  EXPECT_TRUE(Contains(FirstSentences(result), "This fit loses to standing still, which"));
}

// A step of the integrator that is larger than the one taken is no error of it.
TEST(ModelVerdictText, PeopleWhoReactLateAreNoFaultOfTheIntegrator) {
  FitResult result;
  ModelVerdict& verdict = result.verdict;
  verdict.not_checked.clear();
  verdict.motion.explained = 0.9;
  verdict.p_assumptions = 1e-3;
  AssumptionTest step, delay;
  step.name = kStepName, step.stated = 1.0, step.wanted = 13.0, step.error = 2.0, step.p = 1e-4;
  delay.name = kReactionDelayName, delay.unit = "s", delay.stated = 0.14, delay.error = 0.01;
  verdict.assumptions = {step, delay};
  EXPECT_TRUE(Contains(FirstSentences(result), "try --delay=one")) << FirstSentences(result);
  verdict.assumptions.pop_back();  // of a robot, or of a fit with a delay
  EXPECT_TRUE(Contains(FirstSentences(result), "--resample_fps=240"));
  verdict.assumptions = {step, delay};
  verdict.assumptions[0].wanted = -0.9;
  EXPECT_TRUE(Contains(FirstSentences(result), "--resample_fps=240"));
}

// People's own fits may tell groups apart where the joint fit's slopes do not.
TEST(DifferencesText, TheSurestComeFirst) {
  FitResult result;
  EXPECT_EQ(DifferencesText(result), "");
  result.contrast.emplace();
  Contrast& contrast = *result.contrast;
  contrast.label = "group", contrast.first = "controls", contrast.second = "patients";
  const auto add = [&contrast](const std::string& name, double difference, double p) {
    ContrastRow& row = contrast.rows.emplace_back();
    row.name = name, row.unit = name == "com_height" ? "1" : "N m/rad";
    row.difference = difference;
    row.lower95 = difference - 100.0, row.upper95 = difference + 100.0;
    row.p = p, row.p_holm = std::min(1.0, 4.0 * p);
  };
  add("Kp_phi", 50.0, 0.3);
  add("Kp_theta", -252.0, 1e-6);
  EXPECT_EQ(DifferencesText(result),
            "Patients less controls: Kp_theta -252 [-352, -152] N m/rad (p <0.0001), Kp_phi 50 "
            "[-50, 150] N m/rad (p = 1); Holm's p of 2 parameters.");
  add("com_height", 0.5, 0.01);
  add("Kd_phi", 1.0, 0.9);
  const std::string text = DifferencesText(result);
  EXPECT_TRUE(Contains(text, "com_height 0.5 [-99.5, 100] (p = 0.04), Kp_phi")) << text;
  EXPECT_TRUE(Contains(text, "Holm's p of 4 parameters, the others by --details.")) << text;
  EXPECT_FALSE(Contains(text, "Kd_phi"));

  Estimate gain, slope, by_age;
  gain.name = "Kp_theta", slope.name = "Kp_theta~group", by_age.name = "Kp_theta~age";
  for (Estimate* e : {&gain, &slope, &by_age}) {
    e->status = EstimateStatus::kWeak;
    result.estimates.push_back(*e);
  }
  const std::string table = ShortTable(result).ToString();
  EXPECT_FALSE(Contains(table, "~group")) << table;
  EXPECT_TRUE(Contains(table, "~age")) << table;
}

TEST(ContrastTable, AnEffectOverNoSpreadHasNoSize) {
  Contrast contrast;
  contrast.rows.resize(2);
  contrast.rows[0].effect = -13.0;
  contrast.rows[1].effect = 0.8;
  const std::string text = ContrastTable(contrast).ToString();
  EXPECT_TRUE(Contains(text, "below -5")) << text;
  EXPECT_TRUE(Contains(text, "0.8")) << text;
}

}  // namespace
}  // namespace pushid
