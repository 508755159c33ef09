// datasets: what no recording of a pushed person should have, though every file of it can be read:
// as data, judged once, and reported in the same words by pushid-inspect, pushid-push, pushid-fit
// and Python.
//
//   for (const std::string& warning : FindingTexts(FindingsOf(recordings))) ...
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/manifest/recording.h"
#include "models/enum_names.h"

namespace pushid {

// A push beside the motion that it made: direction, size, time, zero.
//
// The point p = 0.9 hip + 0.1 midpoint of the ankles carries a person's mass M. Whoever is pushed
// by a force F goes, at first, along F and at no more than
//   v = J / M,   J = int F dt,
// people who stand as well as those who step: they lose speed to the ground (0.3 to 1.1 J / M was
// simulated), and never gain any. So only the first motion is looked at:
//   onset: p is farther from where it rested than noise and sway go (1 cm at least), and as fast as
//   a quarter of the largest speed; its direction then, and the time by which F alone would have
//   brought it there;
//   gain: the largest speed along J over J / M.
// A net push is the beginning of a push; what it gains is counted while it lasts.
//
// Rejected: the best lag of F's double integral, with drag and stiffness as nuisances: on two-link
// people who stand it was off by 0.1 to 0.3 s, and its gain 0.2.
//
// The false alarms of this comparison are counted in ident/push/README.md.

struct PushAndMotion {
  double speed = 0.0;  // m/s: J / M of the push, with those that overlap it
  // Largest speed along the push over that, and its range: three standard errors of the markers'
  // noise either way.
  double gain = 1.0, least_gain = 1.0, largest_gain = 1.0;
  std::optional<double> angle;  // rad, of the first motion from the push; none: nobody moves
  // s by which the motion starts before (the push is late) or behind the time at which it could:
  // beyond what people's different reactions explain; 0: none.
  double push_late = 0.0, push_early = 0.0;
};

// Compares the first push on a person. None: nobody pushes, the force has no horizontal impulse, or
// frames around it were not seen.
std::optional<PushAndMotion> ComparePush(const PendulumRecording& recording, int person);

// Reading of a measured force where nobody pulls, N, horizontal: the mean of its last 0.2 s, where
// that is steady and small beside the peak but no noise about zero. 0: none.
double RestingForce(const ScenePush& push, double dt);

// Whether a measured force, or the recording, stops while the force is large.
bool HasNoEnd(const ScenePush& push, int num_frames);

// Whether a measured force rises steeply, stays at its largest value for three rows or more, though
// not for half of the push, and falls steeply: it left the range of its sensor.
bool IsClipped(const ScenePush& push);

enum class FindingKind {
  kAgainst,
  kAside,
  kGain,
  kNetGain,
  kLate,
  kEarly,
  kZero,
  kNoEnd,
  kClipped,  // of a push and its motion
  kMass,
  kRod,
  kSpeed,
  kRate,
  kFacing,
  kCopy  // of a recording
};

// One kind: its name, what is found, in what the value is, and what to look at.
struct FindingRow {
  const char* name;
  FindingKind value;
  const char *what, *unit, *advice;
};
const std::vector<FindingRow>& Names(FindingKind);

struct Finding {
  FindingKind kind = FindingKind::kAgainst;
  std::string recording;
  std::string about;   // a person, or of copies the recordings that repeat this one
  double value = 0.0;  // in the row's unit
};

// Findings in the motion and the pushes of a recording.
std::vector<Finding> FindingsOf(const PendulumRecording& recording);
// Findings in the ankles of the first frame, before any axes are turned: programs tell them as they
// load recordings.
std::vector<Finding> FacingFindings(const std::vector<Recording>& recordings);

// Indices of earlier recordings with the same motion under another id, one for each; -1: none.
// (A bootstrap's replica holds a recording several times, under one id.)
std::vector<int> CopyOf(const std::vector<PendulumRecording>& recordings);

// Findings of all recordings, copies among them.
std::vector<Finding> FindingsOf(const std::vector<PendulumRecording>& recordings);

// One sentence a kind: "the force does not return to zero in 2 cases (a: 5 N at the end; ...);
// ...".
std::vector<std::string> FindingTexts(const std::vector<Finding>& findings);
Warnings FindingWarnings(const std::vector<Finding>& findings);

// Whether the first row is more than three times as large as any other, as inverse dynamics makes
// it where the person moves faster when the push begins than was assumed.
bool FirstRowStandsOut(const std::vector<Vector4<double>>& force);

}  // namespace pushid
