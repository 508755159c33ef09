// A report on a person after a push, in every combination of findings: no sentence may contradict
// another.
#include <gtest/gtest.h>

#include "ident/model/fitted_model.h"
#include "ident/problem/behaviour.h"
#include "ident/report/advice.h"
#include "ident/report/report_text.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

Behaviour Simulated(bool settled, double growth) {
  Behaviour b;
  SettlingSimulation d;
  d.mass = 60.0;
  d.impulse = 4.0;
  d.settled = settled;
  d.speed = settled ? 0.01 : 0.2;
  b.simulations = {d, d};
  b.simulations[1].mass = 80.0;
  b.simulations[1].impulse = 25.0;
  b.settles = settled;
  b.fastest_growth = growth;
  b.self_propelling = b.unstable();
  return b;
}

constexpr double kDecays = -0.5, kGrows = 1.5;  // 1/s

std::string Said(const Behaviour& b, const ModelOptions& options) {
  return VerdictSentence(VerdictOf(b), b, options);
}

std::string Advised(const FitResult& result) {
  std::string text;
  for (const Advice& advice : Advise({result, {}, {}, {}, {}}))
    text += advice.sentence + advice.command + "\n";
  return text;
}

TEST(BehaviourText, EachFindingHasItsVerdict) {
  EXPECT_EQ(VerdictOf(Simulated(true, kDecays)), Verdict::kSettles);
  EXPECT_EQ(VerdictOf(Simulated(false, kDecays)), Verdict::kSlowToSettle);
  EXPECT_EQ(VerdictOf(Simulated(false, kGrows)), Verdict::kSelfPropelling);
  EXPECT_EQ(VerdictOf(Simulated(true, kGrows)), Verdict::kUnstableThoughSettled);
  Behaviour drag = Simulated(true, kDecays);
  drag.self_propelling = true;  // the one reason that is left
  EXPECT_EQ(VerdictOf(drag), Verdict::kNegativeDrag);
}

// A fit without a push tail, held to settle: at rest exactly when it is judged, and unstable. Its
// report once said that people settle and that the forces drive them after a push, and advised
// the weight that had brought it there.
TEST(BehaviourText, SettledAndUnstableIsSaidInOneSentence) {
  FitResult result;
  result.behaviour = Simulated(true, kGrows);
  const ModelOptions& options = result.options.model;
  const std::string sentence = Said(result.behaviour, options);
  EXPECT_TRUE(Contains(sentence, "stands still after 2 s, but is unstable at rest")) << sentence;
  EXPECT_TRUE(Contains(sentence, "1.5 1/s")) << sentence;
  EXPECT_FALSE(Contains(VerdictRemedy(VerdictOf(result.behaviour), options), "settling_weight"));
  const std::string text = BehaviourText(result);
  EXPECT_FALSE(Contains(text, "settle within")) << text;
  EXPECT_TRUE(Contains(text, "stand still after 2 s, but not for long")) << text;
  EXPECT_TRUE(Contains(text, "(UNSTABLE)")) << text;
  EXPECT_TRUE(Contains(Advised(result), "--prior=Kp_theta:2000:300")) << Advised(result);
  EXPECT_FALSE(Contains(Advised(result), "settling_weight")) << Advised(result);
  result.options.model.push_tail = PushTail::kNone;
  EXPECT_TRUE(Contains(Advised(result), "--push_tail=exponential")) << Advised(result);
  EXPECT_TRUE(
      Contains(VerdictRemedy(VerdictOf(result.behaviour), options), "--push_tail=exponential"));
}

TEST(BehaviourText, AFallWithStableModesIsNoDrive) {
  Behaviour b = Simulated(false, kDecays);
  b.simulations[1].fell = b.self_propelling = true;
  EXPECT_TRUE(Contains(Said(b, {}), "falls after some pushes")) << Said(b, {});
  EXPECT_TRUE(Contains(SettlingText(b, {}), "80 kg after 25 N s: fell")) << SettlingText(b, {});
  EXPECT_TRUE(Contains(FreeModeText(b), "(stable)"));
}

TEST(BehaviourText, SettlingNamesWhatWasSimulated) {
  Behaviour b = Simulated(true, kDecays);
  EXPECT_EQ(SettlingText(b, {}),
            "after a push of 4 and 25 N s, people of 60 and 80 kg settle within 2 s\n");
  SettlingSimulation line = b.simulations[0];
  line.people = kLinePeople;
  line.impulse = 20.0;
  b.simulations.push_back(line);
  EXPECT_TRUE(Contains(SettlingText(b, {}), "; so do lines of 5 after 20 N s\n"))
      << SettlingText(b, {});
}

// A person who settles is not told to settle, and a finding never goes without a remedy.
TEST(BehaviourText, NoVerdictContradictsTheSimulations) {
  for (bool settled : {false, true}) {
    for (double growth : {kDecays, kGrows}) {
      for (bool driven : {false, true}) {
        Behaviour b = Simulated(settled, growth);
        b.self_propelling = b.self_propelling || driven;
        const Verdict verdict = VerdictOf(b);
        EXPECT_EQ(Contains(VerdictSentence(verdict, b, {}), "settles within"),
                  settled && !b.unstable());
        EXPECT_EQ(Contains(VerdictRemedy(verdict, {}), "settling_weight"), !settled);
        EXPECT_EQ(VerdictName(verdict) == "self-propelling", b.self_propelling);
        EXPECT_EQ(VerdictName(verdict).empty(), VerdictRemedy(verdict, {}).empty());
      }
    }
  }
}

}  // namespace
}  // namespace pushid
