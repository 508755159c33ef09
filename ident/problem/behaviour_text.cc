// ident: verdicts on behaviour.
#include "ident/problem/behaviour_text.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "datasets/files/number_text.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

// "4, 25 and 80"
std::string ListText(const std::set<double>& values) {
  std::string text;
  std::size_t left = values.size();
  for (double value : values) {
    text += Rounded(value, 4);
    --left;
    if (left > 0) text += left > 1 ? ", " : " and ";
  }
  return text;
}

struct Simulated {
  std::set<double> masses, impulses;
  int people = 0;
};

// What the simulations of one person are of, or those of a line.
Simulated SimulatedOf(const Behaviour& behaviour, bool lines) {
  Simulated of;
  for (const SettlingSimulation& d : behaviour.simulations) {
    if ((d.people > 1) != lines) continue;
    of.masses.insert(d.mass);
    of.impulses.insert(d.impulse);
    of.people = d.people;
  }
  return of;
}

// One that is unstable at rest does not settle, whatever the simulations show by then.
std::string AllSettleText(const Behaviour& behaviour, const ModelOptions& model) {
  const Simulated alone = SimulatedOf(behaviour, false), line = SimulatedOf(behaviour, true);
  std::string text =
      "after a push of " + ListText(alone.impulses) + " N s, people of " + ListText(alone.masses) +
      " kg " + (behaviour.unstable() ? "stand still after " : "settle within ") + WaitText(model);
  if (line.people > 0) {
    text += "; so do lines of " + std::to_string(line.people) + " after " +
            ListText(line.impulses) + " N s";
  }
  if (behaviour.unstable()) text += ", but not for long: they are unstable at rest";
  return text;
}

bool AnyFell(const Behaviour& behaviour) {
  return std::any_of(behaviour.simulations.begin(), behaviour.simulations.end(),
                     [](const SettlingSimulation& d) { return d.fell; });
}

std::string GrowthText(const Behaviour& behaviour) {
  return Rounded(behaviour.fastest_growth, 2) + " 1/s";
}

}  // namespace

Verdict VerdictOf(const Behaviour& behaviour, const ModelOptions& options) {
  if (!behaviour.settles) {
    return behaviour.self_propelling ? Verdict::kSelfPropelling : Verdict::kSlowToSettle;
  }
  if (!behaviour.self_propelling) return Verdict::kSettles;
  if (!behaviour.unstable()) return Verdict::kNegativeDrag;
  return RodMoves(options) ? Verdict::kRodRunsAway : Verdict::kUnstableThoughSettled;
}

std::string VerdictName(Verdict verdict) {
  if (verdict == Verdict::kSettles) return "";
  return verdict == Verdict::kSlowToSettle ? kSlowToSettleText : "self-propelling";
}

std::string VerdictSentence(Verdict verdict, const Behaviour& behaviour,
                            const ModelOptions& model) {
  const std::string settles = "the fitted person settles within " + WaitText(model);
  const std::string stands = "the fitted person stands still after " + WaitText(model);
  switch (verdict) {
    case Verdict::kSettles:
      return settles + " after every push of the settling simulations";
    case Verdict::kSlowToSettle:
      return "the fitted person settles later than " + WaitText(model) + " after some pushes";
    case Verdict::kSelfPropelling:
      if (!behaviour.unstable() && AnyFell(behaviour)) {
        return "the fitted person falls after some pushes";
      }
      return "the fitted forces drive the person after a push";
    case Verdict::kUnstableThoughSettled:
      return stands + ", but is unstable at rest: the slightest deviation grows at " +
             GrowthText(behaviour);
    case Verdict::kRodRunsAway:
      return stands + ", but the rod, or the person with it, diverges from rest at " +
             GrowthText(behaviour);
    case Verdict::kNegativeDrag:
      return settles +
             ", but c_x is negative: the friction drives the cart, and only other "
             "forces bring it to rest";
  }
  return "";
}

std::string Capitalized(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(text[0]));
  return text;
}

std::string VerdictRemedy(Verdict verdict, const ModelOptions& options) {
  const bool driven = verdict == Verdict::kSelfPropelling ||
                      verdict == Verdict::kUnstableThoughSettled ||
                      verdict == Verdict::kNegativeDrag;
  if (driven && options.push_tail == PushTail::kNone) {
    return "--push_tail=exponential adds the part of the push that was not recorded";
  }
  switch (verdict) {
    case Verdict::kSettles:
      return "";
    case Verdict::kSlowToSettle:
      return "a larger --settling_weight makes it settle sooner";
    case Verdict::kSelfPropelling:
      return "a larger --settling_weight makes it settle";
    case Verdict::kUnstableThoughSettled:
      // The hinge on the modes sees no network; one between people has no part in them.
      return LearnsAlone(options) ? "a smaller --network_prior stabilizes it"
                                  : "--self_force=linear makes the free modes decay, or none does";
    case Verdict::kRodRunsAway:
      return "a smaller --network_prior or --rod=constant stabilizes it";
    case Verdict::kNegativeDrag:
      return "--fix=mu=0 shows how much accuracy is lost without it";
  }
  return "";
}

std::string SettlingText(const Behaviour& behaviour, const ModelOptions& model) {
  if (behaviour.settles) return AllSettleText(behaviour, model) + "\n";
  std::string text = "NOT SETTLING, " + WaitText(model) + " after a push:\n";
  for (const SettlingSimulation& d : behaviour.simulations) {
    if (d.settled) continue;
    text += "  " + SettlingSimulationName(d, SettingsDiffer(behaviour)) + ": " +
            (d.fell ? kFellText
                    : "still at " + Rounded(d.speed, 2) + " m/s, " + Rounded(d.lean, 2) +
                          " rad from rest") +
            "\n";
  }
  return text;
}

std::string FreeModeText(const Behaviour& behaviour) {
  const std::string verdict = behaviour.unstable() ? "UNSTABLE" : "stable";
  return "fastest free mode at rest: " + Rounded(behaviour.fastest_growth, 3) + " 1/s (" + verdict +
         ")\n";
}

bool SettingsDiffer(const Behaviour& behaviour) {
  return std::any_of(behaviour.simulations.begin(), behaviour.simulations.end(),
                     [](const SettlingSimulation& d) { return !d.setting.empty(); });
}

std::string SettlingSimulationName(const SettlingSimulation& d, bool settings_differ) {
  const std::string who = d.people == 1 ? "" : std::to_string(d.people) + " people in a line, ";
  const std::string where = !d.setting.empty() ? d.setting + ": "
                            : settings_differ  ? "shared values: "
                                               : "";
  return where + who + Rounded(d.mass, 4) + " kg after " + Rounded(d.impulse, 4) + " N s";
}

std::string WaitText(const ModelOptions& model) { return Rounded(WaitSeconds(model), 4) + " s"; }

}  // namespace pushid
