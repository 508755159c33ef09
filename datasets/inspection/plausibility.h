// datasets: what no recording of a pushed person should have, though every file of it can be read.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "datasets/manifest/recording.h"

namespace pushid {

// Whether the first row is more than three times as large as any other, as inverse dynamics makes
// it where the person is faster at the push's begin than was assumed.
bool FirstRowStandsOut(const Push& push);

// Doubts about recordings, by kind.
class PlausibilityCheck {
 public:
  // Pushes above 1 kN, or whose first row stands out; a person who moves before the push, or faster
  // than people do from one frame to the next (a marker that jumps); a person who goes elsewhere
  // than the push (wrong axes, or the wrong sign), or whose ankles say that they face elsewhere
  // than forward; a rod (ankles' midpoint to hip, frame 0) unlike people's.
  void Look(const Recording& recording);

  // The ankles alone: exchanged ones leave everything else plausible.
  void LookAtFacing(const Recording& recording);

  // One sentence a kind: "the push is above 1 kN in 2 recordings (a: 1650 N; b: 1219 N); ...".
  std::vector<std::string> Warnings() const;

 private:
  enum Kind { kStrong, kFirstRow, kWay, kEarly, kJump, kFacing, kRod, kNumKinds };

  void LookAtOnset(const Recording& recording);
  void LookAtSpeed(const Recording& recording, const RecordedPerson& person);
  // who: the recording, or the recording and the person in it.
  void Add(Kind kind, const std::string& who, double value, const char* unit);

  std::array<std::vector<std::string>, kNumKinds> cases_;
};

}  // namespace pushid
