// apps: loading what --model names.
#include "apps/flags/model_flags.h"

#include <gflags/gflags.h>

#include <sstream>

#include "apps/flags/command_line.h"
#include "ident/model/model_json.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote");
DEFINE_string(set, "", "what-if: replace parameters, name=value comma-separated, as in mu=20");

namespace pushid {

ModelFlags ModelFlagsFromCommandLine() { return {FLAGS_model, FLAGS_set}; }

MaybeError RequireModel(const std::string& why) { return Require("model", FLAGS_model, why); }

Result<IdentifiedModel> LoadFlaggedModel() {
  if (MaybeError missing = RequireModel()) return *missing;
  const Result<FittedModel> read = ReadFittedModel(FLAGS_model);
  if (!read.ok()) return read.error();
  IdentifiedModel model = ModelOf(read.value().fit);
  model.source = FLAGS_model;
  if (MaybeError error = SetValues(FLAGS_set, &model)) return *error;
  return model;
}

Result<std::vector<WhatIf>> LoadWhatIfs() {
  if (MaybeError missing = RequireModel()) return *missing;
  const ModelFlags flags = ModelFlagsFromCommandLine();
  const Result<FittedModel> read = ReadFittedModel(flags.file);
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
