// ident: what a fitted person does after a push, in words. Warnings, report, page and advice take
// their sentences from here, so that they cannot contradict each other.
//
//   const Verdict verdict = VerdictOf(behaviour, options);
//   warning = VerdictName(verdict) + ": " + VerdictSentence(verdict, behaviour, model);
#pragma once

#include <string>

#include "ident/problem/behaviour.h"

namespace pushid {

inline constexpr const char* kSlowToSettleText = "slow to settle";
inline constexpr const char* kSettledText = "settled";
inline constexpr const char* kFellText = "fell";

// The settling simulations end before a slow mode has grown, and a negative drag may be held by
// other forces: a person can settle in all of them and be self-propelling all the same.
enum class Verdict {
  kSettles,
  kSlowToSettle,           // not driven, but not at rest when it is judged
  kSelfPropelling,         // does not settle, and the fitted forces are why
  kUnstableThoughSettled,  // settles in the simulations, yet a free mode at rest grows
  kRodRunsAway,            // the same, with a rod that moves
  kNegativeDrag            // settles and is stable, yet c_x is below zero
};
Verdict VerdictOf(const Behaviour& behaviour, const ModelOptions& options);

// "slow to settle", "self-propelling"; empty where the person settles.
std::string VerdictName(Verdict verdict);

// "the fitted forces drive the person after a push": no capital, no full stop.
std::string VerdictSentence(Verdict verdict, const Behaviour& behaviour, const ModelOptions& model);

// As it begins a sentence.
std::string Capitalized(std::string text);

// The flag that mends it, for a fit with these options; empty where the person settles.
std::string VerdictRemedy(Verdict verdict, const ModelOptions& options);

// The settling simulations and the fastest free mode, on lines of their own.
std::string SettlingText(const Behaviour& behaviour, const ModelOptions& model);
std::string FreeModeText(const Behaviour& behaviour);

// "row_1: 5 people in a line, 80 kg after 20 N s". Where settings differ, those without one stand
// for the shared values and say so.
bool SettingsDiffer(const Behaviour& behaviour);
std::string SettlingSimulationName(const SettlingSimulation& d, bool settings_differ);

// "2 s": when a settling simulation is judged.
std::string WaitText(const ModelOptions& model);

}  // namespace pushid
