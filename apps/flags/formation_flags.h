// apps: the flags that describe a formation and the pushes on it.
#pragma once

#include <gflags/gflags.h>

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "models/formation.h"

DECLARE_string(formation);

namespace pushid {

struct FormationPlan {
  std::string title;  // "10 people in a line, 0.45 m apart; 80 N s on person 0 at 0 s"
  Scene scene;
  int frames = 0;
};

// Errors name the flag.
Result<FormationPlan> PlanOfFlags();

// The first given flag that means nothing without --formation; nullptr when there is none.
const char* GivenFormationFlag();

// "--spacing is -1; it must lie between ...". Written so that NaN fails.
MaybeError CheckRange(const char* flag, double value, double lowest, double highest);

}  // namespace pushid
