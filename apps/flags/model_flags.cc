// apps: loading what --model names.
#include "apps/flags/model_flags.h"

#include <gflags/gflags.h>

#include <sstream>

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

// That of --model.
Result<FittedModel> ReadFlaggedModel() {
  Result<FittedModel> read = ReadFittedModel(ModelFile());
  if (!IsShipped()) return read;
  if (!read.ok()) {
    return Error{"--model=" + FLAGS_model +
                 " is no model that comes with the programs; there is pushid:synthetic_group (" +
                 read.error().ToString() + ")"};
  }
  Warn(FLAGS_model +
       " was fitted to synthetic people (pushid-simulate), not to recorded ones: it "
       "shows what the programs do; fit your own recordings for numbers about people");
  return read;
}

}  // namespace

ModelFlags ModelFlagsFromCommandLine() { return {ModelFile(), FLAGS_set}; }

MaybeError RequireModel(const std::string& why) { return Require("model", FLAGS_model, why); }

Result<IdentifiedModel> LoadFlaggedModel() {
  if (MaybeError missing = RequireModel()) return *missing;
  const Result<FittedModel> read = ReadFlaggedModel();
  if (!read.ok()) return read.error();
  IdentifiedModel model = ModelOf(read.value().fit);
  model.source = FLAGS_model;
  if (MaybeError error = SetValues(FLAGS_set, &model)) return *error;
  return model;
}

Result<std::vector<WhatIf>> LoadWhatIfs() {
  if (MaybeError missing = RequireModel()) return *missing;
  const ModelFlags flags = ModelFlagsFromCommandLine();
  const Result<FittedModel> read = ReadFlaggedModel();
  if (!read.ok()) return read.error();
  IdentifiedModel fitted = ModelOf(read.value().fit);
  fitted.source = flags.file;
  std::vector<WhatIf> what_ifs = {{"", fitted}};
  std::stringstream sets(flags.set);
  for (std::string set; std::getline(sets, set, kBetweenSets);) {
    WhatIf one{set, fitted};
    if (MaybeError error = SetValues(set, &one.model)) return *error;
    what_ifs.push_back(std::move(one));
  }
  return what_ifs;
}

}  // namespace pushid
