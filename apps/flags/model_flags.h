// apps: the flags by which an executable takes an identified model; a program has the flags of the
// headers that it includes.
#pragma once

#include "apps/flags/command_line.h"
#include "apps/support/processes.h"
#include "ident/model/model_json.h"

DEFINE_string(model, "",
              "model that pushid-fit --model_out wrote, or pushid:synthetic_group: a group model "
              "of synthetic people, which comes with the programs");
DEFINE_string(set, "",
              "what-if: replace parameters, name=value comma-separated, as in Kp_theta=1500");

namespace pushid {

// Models that come with the programs, as --model=pushid:NAME: PREFIX/share/pushid/models/NAME.json
// beside PREFIX/bin, where the programs are; in the build folder alike (apps/CMakeLists.txt).
inline constexpr char kShippedPrefix[] = "pushid:";

inline bool IsShipped() { return FLAGS_model.rfind(kShippedPrefix, 0) == 0; }

// The model's file, as pushid-fit --model_out writes it; empty: none is named.
inline std::string ModelFile() {
  if (!IsShipped()) return FLAGS_model;
  const std::string name = FLAGS_model.substr(sizeof kShippedPrefix - 1);
  return OwnFolder() + "/../share/pushid/models/" + name + ".json";
}

inline FittedModel ReadFlaggedModel() {
  Result<FittedModel> read = ReadFittedModel(ModelFile());
  if (!IsShipped()) return OrFail(std::move(read));
  if (!read.ok()) {
    throw Error{"--model=" + FLAGS_model +
                " is no model that comes with the programs; there is pushid:synthetic_group (" +
                read.error().ToString() + ")"};
  }
  LOG(WARNING) << FLAGS_model
               << " was fitted to synthetic people (pushid-simulate), not to recorded ones: it "
                  "shows what the programs do; fit your own recordings for numbers about people";
  return std::move(read).value();
}

// Throws without --model.
inline void RequireModel() {
  Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote");
}

// The model of --model as it was fitted.
inline IdentifiedModel LoadModelAsFitted() {
  RequireModel();
  IdentifiedModel model = ModelOf(ReadFlaggedModel().fit);
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
