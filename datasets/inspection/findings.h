// datasets: what no recording of a pushed person should have, though every file of it can be read:
// as data, judged once, and told alike by pushid-inspect, pushid-push, pushid-fit and Python.
//
//   for (const std::string& warning : FindingTexts(FindingsOf(recordings))) ...
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "datasets/loading/warning.h"
#include "datasets/manifest/recording.h"
#include "models/enum_names.h"

namespace pushid {

enum class FindingKind {
  kAgainst,
  kAside,
  kGain,
  kNetGain,
  kLate,
  kEarly,
  kZero,
  kNoEnd,  // of a push and its motion
  kStrong,
  kFirstRow,  // of a push
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
  bool in_fits;  // otherwise pushid-inspect alone tells it
};
const std::vector<FindingRow>& Names(FindingKind);

struct Finding {
  FindingKind kind = FindingKind::kAgainst;
  std::string recording;
  std::string about;   // a person, or of copies the recordings that repeat this one
  double value = 0.0;  // in the row's unit
};

// Motion and pushes of a recording; its first frame's ankles, which a pendulum has no more, are
// looked at by FacingFindings.
std::vector<Finding> FindingsOf(const PendulumRecording& recording);
std::vector<Finding> FacingFindings(const Recording& recording);
std::vector<Finding> FindingsOf(const Recording& recording);

// By recording, the index of an earlier one with the same motion under another id; -1: none. (A
// bootstrap's replica holds a recording several times, under one id.)
std::vector<int> CopyOf(const std::vector<PendulumRecording>& recordings);

// Those of all recordings, copies among them.
std::vector<Finding> FindingsOf(const std::vector<PendulumRecording>& recordings);

// Those that a fit, a prediction and pushid-push tell.
std::vector<Finding> FitFindings(std::vector<Finding> findings);

// One sentence a kind: "the push is above 1 kN in 2 cases (a: 1650 N; b: 1219 N); ...".
std::vector<std::string> FindingTexts(const std::vector<Finding>& findings);
Warnings FindingWarnings(const std::vector<Finding>& findings);

// Whether the first row is more than three times as large as any other, as inverse dynamics makes
// it where the person is faster at the push's begin than was assumed.
bool FirstRowStandsOut(const std::vector<Vector4<double>>& force);

}  // namespace pushid
