// apps: loading what --model names.
#include "apps/flags/model_flags.h"

#include <gflags/gflags.h>

#include <sstream>
#include <utility>

#include "apps/flags/command_line.h"
#include "apps/support/app_support.h"
#include "apps/support/processes.h"
#include "ident/model/model_json.h"

DEFINE_string(model, "",
              "model that pushid-fit --model_out wrote, or pushid:synthetic_group: a group model "
              "of synthetic people, which comes with the programs");
DEFINE_string(set, "",
              "what-if: replace parameters, name=value comma-separated, as in Kp_theta=1500");

namespace pushid {

namespace {

bool IsShipped() { return FLAGS_model.rfind(kShippedPrefix, 0) == 0; }

std::string ModelFile() {
  if (!IsShipped()) return FLAGS_model;
  const std::string name = FLAGS_model.substr(sizeof kShippedPrefix - 1);
  return OwnFolder() + "/../share/pushid/models/" + name + ".json";
}

FittedModel ReadFlaggedModel() {
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

}  // namespace

ModelFlags ModelFlagsFromCommandLine() { return {ModelFile(), FLAGS_set}; }

void RequireModel(const std::string& why) { return Require("model", FLAGS_model, why); }

IdentifiedModel LoadFlaggedModel() {
  RequireModel();
  const FittedModel read = ReadFlaggedModel();
  IdentifiedModel model = ModelOf(read.fit);
  model.source = FLAGS_model;
  OrFail(SetValues(FLAGS_set, &model));
  return model;
}

std::vector<WhatIf> LoadWhatIfs() {
  RequireModel();
  const ModelFlags flags = ModelFlagsFromCommandLine();
  const FittedModel read = ReadFlaggedModel();
  IdentifiedModel fitted = ModelOf(read.fit);
  fitted.source = flags.file;
  std::vector<WhatIf> what_ifs = {{"", fitted}};
  std::stringstream sets(flags.set);
  for (std::string set; std::getline(sets, set, kBetweenSets);) {
    WhatIf one{set, fitted};
    OrFail(SetValues(set, &one.model));
    what_ifs.push_back(std::move(one));
  }
  return what_ifs;
}

}  // namespace pushid
