// apps: several what-ifs at once: --set=mu=10 --set=mu=60,a_x=-5.
#pragma once

#include <string>
#include <vector>

#include "ident/model/identified_model.h"

namespace pushid {

inline constexpr char kBetweenSets = ';';

struct WhatIf {
  std::string what;  // as it was given; empty: the model as it was fitted
  IdentifiedModel model;
};

// The model of --model as it was fitted, and then with each --set; main joins them by ;
// (JoinRepeated).
Result<std::vector<WhatIf>> LoadWhatIfs();

}  // namespace pushid
