// The laboratory's people: Newton's law holds between what markers, platforms and load cell see;
// the integrator has converged; its files are read without a warning; no model is behind it.
#include "tests/simulators/laboratory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <regex>
#include <sstream>

#include "datasets/loading/load_recordings.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

LaboratoryPerson APerson() { return DrawLaboratoryPeople({})[0]; }

LaboratoryPush APush(const LaboratoryPerson& person, double speed) {
  LaboratoryPush push;
  push.peak_N = speed * person.mass_kg * M_PI / (2.0 * push.duration_s);
  return push;
}

LaboratoryTrial Trial(double speed, double sway = 0.0, int substeps = 2) {
  const LaboratoryPerson person = APerson();
  return Unwrapped(SimulateLaboratoryTrial(person, APush(person, speed), 3.0, sway, 1, substeps));
}

// Centre of mass of legs and trunk, by Winter's table, m; foot: place of the middle of the ankles.
double CentreOfMass(const LaboratorySample& s) {
  const LaboratoryPerson person = APerson();
  const double h = person.height_m, hip = person.RodLength() * std::sin(s.legs);
  return 0.5 * (s.foot[0] + s.foot[1]) +
         (0.293 * 0.307 * h * std::sin(s.legs) + 0.678 * (hip + 0.18 * h * std::sin(s.trunk))) /
             (0.293 + 0.678);
}

// A person who leans and is left alone presses the platform below the centre of mass.
TEST(Laboratory, AtRestTheCentreOfPressureIsBelowTheCentreOfMass) {
  const LaboratoryTrial trial = Trial(0.0);
  const LaboratorySample& last = trial.samples.back();
  EXPECT_GT(last.legs, 0.001);
  EXPECT_NEAR(last.centre_m, (0.293 + 0.678) * CentreOfMass(last), 1e-4);  // feet rest at 0
  EXPECT_NEAR(last.shear_N, 0.0, 1e-6);
  EXPECT_NEAR(last.vertical_N, APerson().mass_kg * 9.81, 1e-6);
}

// The impulse of platforms and load cell is the momentum of the centre of mass, also in a step.
TEST(Laboratory, PlatformsSeeWhatMovesTheBody) {
  for (double speed : {0.15, 0.75}) {
    SCOPED_TRACE(speed);
    const LaboratoryTrial trial = Trial(speed);
    EXPECT_EQ(trial.steps.empty(), speed < 0.5);
    const double dt = 1.0 / kLaboratoryHz, mass = (0.293 + 0.678) * APerson().mass_kg;
    const auto& s = trial.samples;
    double impulse = 0.0, worst = 0.0, largest = 0.0;
    for (size_t i = 1; i + 1 < s.size(); ++i) {
      impulse += dt * (s[i].shear_N + s[i].push_N);
      const double momentum = mass * (CentreOfMass(s[i + 1]) - CentreOfMass(s[i])) / dt;
      worst = std::max(worst, std::abs(impulse - momentum));  // at i + 1/2, both
      largest = std::max(largest, std::abs(momentum));
    }
    EXPECT_GT(largest, 0.5 * speed * APerson().mass_kg);
    EXPECT_LT(worst, 0.005 * largest);
  }
}

TEST(Laboratory, StepsGoWhereBalanceIsFound) {
  const LaboratoryTrial trial = Trial(0.75);
  ASSERT_FALSE(trial.steps.empty());
  const LaboratoryStep& step = trial.steps[0];
  EXPECT_NEAR(step.landing_s - step.lift_off_s, 0.3, 1e-9);
  EXPECT_GT(step.length_m, 0.1);
  const LaboratorySample& last = trial.samples.back();
  EXPECT_NEAR(last.foot[step.foot], step.length_m, 1e-9);
  EXPECT_LT(std::abs(last.legs), 0.1);
  for (const LaboratorySample& s : trial.samples) {
    EXPECT_LT(s.centre_m, std::max(s.foot[0], s.foot[1]) + 0.25);
    EXPECT_GT(s.centre_m, std::min(s.foot[0], s.foot[1]) - 0.15);
  }
}

TEST(Laboratory, TheIntegratorHasConverged) {
  const LaboratoryTrial coarse = Trial(0.15, 1.0), fine = Trial(0.15, 1.0, 8);
  for (size_t i = 0; i < coarse.samples.size(); ++i) {
    ASSERT_NEAR(coarse.samples[i].legs, fine.samples[i].legs, 1e-6) << i;
  }
}

class LaboratoryFiles : public TempDirTest {};

TEST_F(LaboratoryFiles, AreReadWithoutAWarningAndSayWhatHappened) {
  LaboratoryOptions options;
  options.people = 1;
  ASSERT_FALSE(WriteLaboratoryStudy(folder_.string(), options));
  Warnings warnings;
  const auto loaded = Unwrapped(LoadRecordings(Path("manifest.json"), {}, &warnings));
  for (const Warning& warning : warnings) ADD_FAILURE() << warning.text;
  ASSERT_EQ(loaded.size(), static_cast<size_t>(options.standing + options.stepping));
  const LaboratoryPerson person = APerson();
  for (const Recording& r : loaded) {
    const RecordedPerson& p = r.people[0];
    EXPECT_NEAR((p.hip[0] - 0.5 * (p.left_ankle[0] + p.right_ankle[0])).norm(), person.RodLength(),
                0.005);
    ASSERT_EQ(p.plates.size(), p.hip.size());
    double vertical = 0.0;
    for (const PlateSample& s : p.plates)
      vertical += s.force[2] / static_cast<double>(p.plates.size());
    EXPECT_NEAR(vertical, 9.81 * person.mass_kg, 0.01 * 9.81 * person.mass_kg);
    const double moved = p.left_ankle.back()[0] - p.left_ankle[0][0];
    EXPECT_EQ(moved > 0.1, r.id.find("strong") != std::string::npos) << r.id;
  }
}

// Including one of models/ would make the example less independent than it says.
TEST(Laboratory, NoCodeOfModels) {
  for (const char* file : {"laboratory.h", "laboratory.cc"}) {
    std::ifstream stream(std::string(PUSHID_SOURCE_DIR) + "/tests/simulators/" + file);
    std::stringstream text;
    text << stream.rdbuf();
    ASSERT_GT(text.str().size(), 1000u) << file;
    EXPECT_FALSE(std::regex_search(text.str(),
                                   std::regex("#include \"(models|datasets/synthetic/synthetic)")))
        << file;
  }
}

}  // namespace
}  // namespace pushid
