// apps: loading what --model names.
#include "apps/flags/model_flags.h"

#include <gflags/gflags.h>

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

}  // namespace pushid
