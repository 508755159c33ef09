// apps: the flags by which an executable takes an identified model.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"

namespace pushid {

// Models that come with the programs, as --model=pushid:NAME: PREFIX/share/pushid/models/NAME.json
// beside PREFIX/bin, where the programs are; in the build folder alike (apps/CMakeLists.txt).
inline constexpr char kShippedPrefix[] = "pushid:";

struct ModelFlags {
  std::string file;  // that pushid-fit --model_out wrote
  std::string set;   // what-if values, name=value comma-separated
};
ModelFlags ModelFlagsFromCommandLine();

// Throws without --model; `why` says what it must name, or what needs it.
void RequireModel(const std::string& why = "give a file that pushid-fit --model_out wrote");

// The model of --model with the values of --set.
IdentifiedModel LoadFlaggedModel();

// Several what-ifs at once: --set=mu=10 --set=mu=60,a_x=-5.
inline constexpr char kBetweenSets = ';';

struct WhatIf {
  std::string what;  // as it was given; empty: the model as it was fitted
  IdentifiedModel model;
};

// The model of --model as it was fitted, and then with each --set; main joins them by ;
// (JoinRepeated).
std::vector<WhatIf> LoadWhatIfs();

}  // namespace pushid
