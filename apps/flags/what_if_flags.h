// apps: several what-ifs at once: --set=mu=10 --set=mu=60,a_x=-5.
#pragma once

#include <string>
#include <vector>

#include "ident/results/identified_model.h"

namespace pushid {

// gflags keeps the last value of a flag that is given again: called before it parses, this keeps
// every --set.
void KeepEverySet(int argc, char** argv);

struct WhatIf {
  std::string what;  // as it was given; empty: the model as it was fitted
  IdentifiedModel model;
};

// The model of --model as it was fitted, and then with each --set.
Result<std::vector<WhatIf>> LoadWhatIfs();

}  // namespace pushid
