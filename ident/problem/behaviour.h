// ident: people whom a model pushes and leaves alone: do they settle? A fit can score well and
// never stop walking; this tells.
#pragma once

#include <string>
#include <vector>

#include "models/options.h"
#include "models/parameters.h"
#include "models/scene.h"

namespace pushid {

// The settling simulations that a fit is judged by, and (of the single people the lightest, whom a
// push moves most) held to.
inline constexpr double kSettlingMasses[] = {60.0, 80.0, 100.0};  // kg, of one person
inline constexpr double kSettlingMass = 80.0;                     // kg, of everybody in a line
inline constexpr double kSettlingImpulses[] = {4.0, 25.0, 80.0};  // N s, on one person
inline constexpr int kLinePeople = 5;                             // in a line, where people touch
inline constexpr double kLineImpulses[] = {4.0, 20.0, 80.0};      // N s, on the first in a line

// The scenes that people are held to: of one person, and where people touch also of a line. Feet
// that never move are held to the weakest push: nobody knows when they would have stepped.
std::vector<std::vector<Scene>> SettlingScenes(const ModelOptions& options);

inline constexpr double kBehind = 0.05;  // m behind the start that are worth a warning

// The people of the settling simulations so long after the last push (WaitSeconds), which goes
// forwards.
struct SettlingSimulation {
  std::string setting;    // where settings differ: with whose parameters; empty: the shared ones
  int people = 1;         // more than one: in a line, the first one pushed
  double mass = 0.0;      // kg
  double impulse = 0.0;   // N s
  double speed = 0.0;     // m/s, of the fastest cart
  double lean = 0.0;      // rad, largest deviation from the rest posture
  double distance = 0.0;  // m, of the carts from where they stood, on average
  double advance = 0.0;   // m, the same along the push: negative where they end behind
  double pushed_advance = 0.0;  // m, of the pushed person alone
  bool fell = false;            // beyond 1.0 rad at any time
  bool settled = false;         // slower than 0.1 m/s and within 0.05 rad
};

struct Behaviour {
  // One person of 60, 80, 100 kg after 4, 25, 80 N s; where people touch, also five of 80 kg in a
  // line after 4, 20, 80 N s.
  std::vector<SettlingSimulation> simulations;
  // Largest real part of the free modes at rest, 1/s, leaving out the cart's free position;
  // positive: the slightest push grows.
  double fastest_growth = 0.0;  // of the physics alone beside networks that have no rest
  // A rod that nothing pulls back neither grows nor decays, but for rounding.
  bool unstable() const { return fastest_growth > 1e-6; }
  bool settles = false;  // every settling simulation settled
  // Each line moved on farther along the push than the one pushed more weakly.
  bool harder_moves_farther = true;
  // The person is driven by the fitted forces: an unstable free mode, negative damping of the cart,
  // or a fall. One who is merely slow to settle is not.
  bool self_propelling = false;

  // The settling simulation whose pushed person ends farthest behind the start, beyond kBehind;
  // nullptr when there is none.
  const SettlingSimulation* FarthestBehind() const;

  // Adds what people do in one setting.
  void Add(const Behaviour& other, const std::string& setting);
};

// Seconds from a push until the slowest of the simulated people, whom the demand to settle is put
// to, stands still for good; infinite: not within 10 s, or somebody falls.
double SettlingSeconds(const ModelOptions& options, const ParameterSet<double>& parameters);

Behaviour ComputeBehaviour(const ModelOptions& options, const ParameterSet<double>& parameters);

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
  kNegativeDrag            // settles and is stable, yet c_x is below zero
};
Verdict VerdictOf(const Behaviour& behaviour);

// "slow to settle", "self-propelling"; empty where the person settles.
std::string VerdictName(Verdict verdict);

// "the fitted forces drive the person after a push": no capital, no full stop.
std::string VerdictSentence(Verdict verdict, const Behaviour& behaviour, const ModelOptions& model);

// The text with a capital, as it begins a sentence.
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
