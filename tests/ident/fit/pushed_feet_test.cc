// Recorded feet, and the stance that a fit takes from them.
#include <gtest/gtest.h>

#include "ident/fit/fit_setup.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/option_table.h"
#include "ident/parameters/presets.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Six pushed people, of whom so many moved their feet, and so many of these lifted one.
std::vector<PendulumRecording> WhereMoved(int moved, int stepped) {
  std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  for (size_t i = 0; i < recordings.size(); ++i) {
    recordings[i].steps.assign(1, PersonSteps());
    if (static_cast<int>(i) < moved) recordings[i].steps[0].travel = 0.3;
  }
  for (int i = 0; i < stepped; ++i) recordings[i].steps[0].steps.resize(1);
  return recordings;
}
std::vector<PendulumRecording> WhereMoved(int moved) { return WhereMoved(moved, moved); }

TEST(FitSetup, FeetTellTheStance) {
  const auto stance = [](int moved, const GivenOptions& given) {
    const std::vector<PendulumRecording> recordings = WhereMoved(moved);
    return Unwrapped(MakeFitOptions(given, &recordings, given)).model.stance;
  };
  EXPECT_EQ(stance(0, {}), Stance::kFixed);
  EXPECT_EQ(stance(3, {}), Stance::kSteps);
  const auto told = [](int moved, int stepped) {
    return StanceOf(FeetOf(WhereMoved(moved, stepped)), Stance::kSteps);
  };
  EXPECT_EQ(told(3, 0), Stance::kSlide) << "who slides a little";
  EXPECT_EQ(told(6, 2), Stance::kSlide) << "noise lifts some";
  EXPECT_EQ(told(6, 3), Stance::kSteps);
  EXPECT_EQ(stance(6, {{"preset", "group"}}), Stance::kSteps) << "who touch";
  EXPECT_EQ(stance(6, {{"preset", "group"}, {"self_force", "none"}}), Stance::kSteps);
  EXPECT_EQ(stance(6, {{"preset", "group"}, {"free", "mu"}}), Stance::kSlide);
  EXPECT_EQ(stance(6, {{"preset", "ldp"}}), Stance::kSlide);
  EXPECT_EQ(stance(5, {}), Stance::kSlide);
  EXPECT_EQ(stance(6, {}), Stance::kSlide);
  EXPECT_EQ(stance(0, {{"stance", "auto"}}), Stance::kFixed);
  EXPECT_EQ(stance(0, {{"preset", "tail"}}), Stance::kFixed);
  // Asked otherwise, published, or with what only feet that slide can do.
  EXPECT_EQ(stance(0, {{"stance", "slide"}}), Stance::kSlide);
  EXPECT_EQ(stance(6, {{"stance", "fixed"}}), Stance::kFixed);
  EXPECT_EQ(stance(0, {{"preset", "ldp"}}), Stance::kSlide);
  EXPECT_EQ(stance(0, {{"likelihood", "innovation"}}), Stance::kSlide);
  EXPECT_EQ(stance(0, {{"free", "mu"}}), Stance::kSlide);
  EXPECT_EQ(stance(0, {{"rod", "ldp:4"}}), Stance::kSlide);
}

TEST(FitSetup, FeetThatStepHaveNoLinearSelfForcesNorTheirDemand) {
  const FitOptions o = MakeFitOptions({{"preset", "group"}, {"stance", "steps"}}).value();
  EXPECT_EQ(o.self_force, SelfForceKind::kNone);
}

TEST(FitSetup, HeldFeetFreeBothGainsOfBothDirections) {
  const FitOptions o = MakeFitOptions({{"preset", "tail"}, {"stance", "fixed"}}).value();
  for (const ParameterSpec& spec : o.table.specs) {
    const bool free = spec.id == kKpTheta || spec.id == kKpPhi || spec.id == kKdTheta ||
                      spec.id == kKdPhi || spec.id == kComHeight;
    EXPECT_EQ(spec.free, free) << spec.name;
  }
  EXPECT_EQ(o.settling_weight, 0.0);
  EXPECT_EQ(o.model.push_tail, PushTail::kNone);
}

TEST(PushedFeet, InWords) {
  const PushedFeet stand = FeetOf(WhereMoved(0)), some = FeetOf(WhereMoved(2));
  EXPECT_EQ(FeetText(stand, Stance::kFixed),
            "feet hold (--stance=fixed; they moved in 0 of 6 pushes)");
  EXPECT_EQ(FeetText(some, Stance::kSteps),
            "feet hold, then step (--stance=steps; they moved in 2 of 6 pushes)");
  EXPECT_EQ(FeetText(PushedFeet(), Stance::kSlide), "");
  EXPECT_EQ(FeetWarning(stand, Stance::kFixed), "");
  EXPECT_TRUE(Contains(FeetWarning(stand, Stance::kSlide), "--stance=fixed"));
  EXPECT_TRUE(Contains(FeetWarning(some, Stance::kFixed), "2 of 6"));
}

}  // namespace
}  // namespace pushid
