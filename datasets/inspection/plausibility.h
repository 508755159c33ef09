// datasets: what no recording of a pushed person should have, though every file of it can be read.
#pragma once

#include <string>
#include <vector>

#include "datasets/manifest/recording.h"

namespace pushid {

// Whether the first row is more than three times as large as any other, as inverse dynamics makes
// it where the person is faster at the push's begin than was assumed.
bool FirstRowStandsOut(const Push& push);

// The kinds of doubt, and which recordings they are of.
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
  void LookAtOnset(const Recording& recording);
  void LookAtSpeed(const Recording& recording, const RecordedPerson& person);

  struct Doubt {
    std::string what, advice;
    std::vector<std::string> cases;
  };
  Doubt strong_{"the push is above 1 kN",
                "people rarely push so hard: is its unit N, and is its window right?",
                {}};
  Doubt first_{"the push's first row stands out",
               "the person already moves when the push begins: see pushid-push --initial_velocity",
               {}};
  Doubt way_{"the person moves in another direction than the push",
             "are `up` and `forward` right, and the push's sign?",
             {}};
  Doubt early_{"the person moves before being pushed",
               "is the push's start right, and the sensor's clock?",
               {}};
  Doubt jump_{
      "the hip is implausibly fast", "does a marker jump there, and are unit and fps right?", {}};
  Doubt facing_{"according to the ankles people do not face forward",
                "are `up` and `forward` right, and the ankles not exchanged?",
                {}};
  Doubt rod_{
      "the distance between hip and ankles is implausible", "are `joints` and the unit right?", {}};
};

}  // namespace pushid
