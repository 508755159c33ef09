// apps: the flags by which an executable takes an identified model; a program has the flags of the
// headers that it includes.
#pragma once

#include "apps/flags/command_line.h"
#include "ident/model/model_json.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote");
DEFINE_string(set, "",
              "what-if: replace parameters, name=value comma-separated, as in Kp_theta=1500");

namespace pushid {

// Throws without --model.
inline void RequireModel() {
  Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote");
}

// The model of --model as it was fitted.
inline IdentifiedModel LoadModelAsFitted() {
  RequireModel();
  IdentifiedModel model = ModelOf(OrFail(ReadFittedModel(FLAGS_model)).fit);
  model.source = FLAGS_model;
  return model;
}

// The model of --model with the values of --set.
inline IdentifiedModel LoadFlaggedModel() {
  IdentifiedModel model = LoadModelAsFitted();
  OrFail(SetValues(FLAGS_set, &model));
  return model;
}

// Several what-ifs at once: --set=mu=10 --set=mu=60,a_x=-5.
inline constexpr char kBetweenSets = ';';

struct WhatIf {
  std::string what;  // as it was given; empty: the model as it was fitted
  IdentifiedModel model;
};

// The model of --model as it was fitted, and then with each --set; main joins them by ;
// (JoinRepeated).
inline std::vector<WhatIf> LoadWhatIfs() {
  std::vector<WhatIf> what_ifs = {{"", LoadModelAsFitted()}};
  for (const std::string& set : SplitList(FLAGS_set, kBetweenSets)) {
    WhatIf one{set, what_ifs.front().model};
    OrFail(SetValues(set, &one.model));
    what_ifs.push_back(std::move(one));
  }
  return what_ifs;
}

}  // namespace pushid
